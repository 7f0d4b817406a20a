#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "base/error.h"
#include "problems/attitude.h"
#include "problems/imu_leaps.h"

namespace hindsight {
namespace {

/// Logarithm of the ratio of the likelihoods of what two runs have in common:
/// above 0 the second fits better.
double LogRatio(const std::vector<NormalisedInnovation>& first,
                const std::vector<NormalisedInnovation>& second) {
  std::map<std::pair<int, std::size_t>, double> known;
  for (const NormalisedInnovation& innovation : first) {
    known[{innovation.sensor, innovation.index}] =
        innovation.rows.squaredNorm();
  }
  double ratio = 0.0;
  for (const NormalisedInnovation& innovation : second) {
    const auto own = known.find({innovation.sensor, innovation.index});
    if (own == known.end()) continue;
    ratio += 0.5 * (own->second - innovation.rows.squaredNorm());
  }
  return ratio;
}

}  // namespace

void AttitudeEstimation::JudgeLeaps(
    const std::vector<NormalisedInnovation>& own) {
  for (const ImuDropOut& leap :
       LongestDropOuts(dataset_.imu, imu_.t_begin(), imu_.t_end())) {
    const Dataset anew = WithoutLeap(dataset_, leap);
    std::vector<NormalisedInnovation> other;
    try {
      AttitudeEstimation estimation(anew, options_);
      estimation.Smoother();
      other = std::move(estimation.innovations_);
    } catch (const EstimationError&) {
      continue;
    } catch (const InputError&) {
      continue;
    }
    const double log_evidence =
        LogRatio(own, other) - std::log(kLostForOneLeap);
    if (!(log_evidence > 0.0)) continue;
    evidence_.push_back(
        {.rule = "rival",
         .grade = Grade::kDoubtful,
         .what = fmt::format("the readings fit better if the IMU's clock leaps "
                             "by {:.3g} s at {:.2f} s, and no samples are lost "
                             "there",
                             leap.lost, leap.t),
         .value = log_evidence,
         .limit = 0.0,
         .unit = "1",
         .remedies = {fmt::format(
             "if so, {:.3g} s less in the stamps of the IMU's later rows",
             leap.lost)}});
  }
}

}  // namespace hindsight
