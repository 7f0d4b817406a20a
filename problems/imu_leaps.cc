#include "problems/imu_leaps.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "base/error.h"
#include "evaluation/explanation.h"
#include "imu/imu_stream.h"
#include "problems/clock_evidence.h"
#include "problems/linearisation.h"

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

/// The largest root mean square, over the nodes of both, of a component's
/// difference in standard deviations of `chosen`; infinite where no node is of
/// both, as then nothing says that they are the same.
double DistanceBetween(const ErrorLayout& layout, const Relinearised& chosen,
                       const std::vector<State>& rival) {
  constexpr double kSameTime = 1e-6;
  NavigationVariances sum = NavigationVariances::Zero();
  int count = 0;
  std::size_t j = 0;
  for (std::size_t k = 0; k < chosen.states.size(); ++k) {
    const State& x = chosen.states[k];
    while (j < rival.size() && rival[j].t < x.t - kSameTime) ++j;
    if (j == rival.size() || rival[j].t > x.t + kSameTime) continue;
    const ErrorVector d = Local(layout, x, rival[j]);
    sum += d.head<9>().cwiseAbs2().cwiseQuotient(chosen.variances[k]);
    ++count;
  }
  return count > 0 ? std::sqrt(sum.maxCoeff() / count)
                   : std::numeric_limits<double>::infinity();
}

/// Nothing where the data cannot be solved without the leap, or `chosen` is hardly
/// another solution.
std::optional<RivalSolution> RivalWithout(const ImuDropOut& leap,
                                          ForwardStage* chosen) {
  constexpr double kMostEvidence = 30.0;
  constexpr double kHopeless = 200.0;
  const Dataset anew = WithoutLeap(chosen->dataset(), leap);
  ForwardStage stage(anew, chosen->options(), chosen->start());
  stage.Run();
  const Relinearised& own = chosen->relinearised();
  if (own.states.empty()) return std::nullopt;
  const auto is_near = [&](const std::vector<State>& states) {
    return DistanceBetween(chosen->start().layout, own, states) <
           kDoubtfulShift;
  };
  const std::vector<State>& first = stage.smoothed().states;
  const auto log_evidence = [&](const std::vector<State>& states) {
    return LogEvidenceRatio(chosen->dataset(), {stage, states},
                            {*chosen, own.states}) -
           std::log(kLostForOneLeap);
  };
  // Linearising anew costs more than the stage and seldom moves so far.
  if (is_near(first) || log_evidence(first) < -kHopeless) return std::nullopt;
  const Relinearised& other = stage.relinearised();
  if (other.states.empty() || is_near(other.states)) return std::nullopt;
  RivalSolution rival;
  rival.description = fmt::format(
      "the IMU's clock leaps by {:.3g} s at {:.2f} s, and no samples are lost "
      "there",
      leap.lost, leap.t);
  rival.remedy = fmt::format(
      "if so, {:.3g} s less in the stamps of the IMU's later rows", leap.lost);
  rival.differences.push_back({"imu_clock_leap", leap.lost, "s"});
  rival.log_evidence = std::min(kMostEvidence, log_evidence(other.states));
  rival.final_state = other.states.back();
  return rival;
}

}  // namespace

std::vector<RivalSolution> ImuLeaps(ForwardStage* chosen) {
  std::vector<RivalSolution> rivals;
  if (!chosen->start().layout.has_canonical_head()) return rivals;
  const ImuStream& imu = chosen->dataset().imu;
  for (const ImuDropOut& leap :
       LongestDropOuts(imu, chosen->timeline().node(0).t,
                       std::min(chosen->options().to, imu.t_end()))) {
    try {
      if (auto rival = RivalWithout(leap, chosen)) {
        rivals.push_back(*std::move(rival));
      }
    } catch (const EstimationError&) {
      // What cannot be solved is no rival.
    }
  }
  return rivals;
}

}  // namespace hindsight
