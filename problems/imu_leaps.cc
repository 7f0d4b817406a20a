#include "problems/imu_leaps.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "base/error.h"
#include "imu/imu_stream.h"
#include "problems/rival_data.h"

namespace hindsight {

std::vector<ImuDropOut> LongestDropOuts(const ImuStream& imu, double from,
                                        double to) {
  std::vector<ImuDropOut> all;
  for (const std::size_t k : DropOuts(imu)) {
    const double t = imu.samples[k - 1].t;
    if (t < from || imu.samples[k].t > to) continue;
    all.push_back({k, t, imu.samples[k].t - t - imu.nominal_dt});
  }
  std::stable_sort(
      all.begin(), all.end(),
      [](const ImuDropOut& a, const ImuDropOut& b) { return a.lost > b.lost; });
  if (all.size() > kMostLeaps) all.resize(kMostLeaps);
  return all;
}

Dataset WithoutLeap(const Dataset& dataset, const ImuDropOut& leap) {
  Dataset out = dataset;
  for (std::size_t k = leap.end; k < out.imu.samples.size(); ++k) {
    out.imu.samples[k].t -= leap.lost;
  }
  return out;
}

namespace {

/// Nothing where the data cannot be solved without the leap, or `chosen` is hardly
/// another solution.
std::optional<RivalSolution> RivalWithout(const ImuDropOut& leap,
                                          const ForwardStage& chosen,
                                          RivalComparison* comparison) {
  const Dataset anew = WithoutLeap(chosen.dataset(), leap);
  ForwardStage stage(anew, chosen.options(), chosen.start());
  RivalSolution rival;
  rival.description = fmt::format(
      "the IMU's clock leaps by {:.3g} s at {:.2f} s, and no samples are lost "
      "there",
      leap.lost, leap.t);
  rival.remedy = fmt::format(
      "if so, {:.3g} s less in the stamps of the IMU's later rows", leap.lost);
  rival.differences.push_back({"imu_clock_leap", leap.lost, "s"});
  return comparison->Solve(-std::log(kLostForOneLeap),
                           RivalReadings::kAtOtherTimes, std::move(rival),
                           &stage);
}

}  // namespace

std::vector<RivalSolution> ImuLeaps(ForwardStage* chosen) {
  std::vector<RivalSolution> rivals;
  if (!chosen->start().layout.has_canonical_head()) return rivals;
  const ImuStream& imu = chosen->dataset().imu;
  const std::vector<ImuDropOut> leaps =
      LongestDropOuts(imu, chosen->timeline().node(0).t,
                      std::min(chosen->options().to, imu.t_end()));
  if (leaps.empty()) return rivals;
  RivalComparison comparison(chosen);
  for (const ImuDropOut& leap : leaps) {
    try {
      if (auto rival = RivalWithout(leap, *chosen, &comparison)) {
        rivals.push_back(*std::move(rival));
      }
    } catch (const EstimationError&) {
      // What cannot be solved is no rival.
    }
  }
  return rivals;
}

}  // namespace hindsight
