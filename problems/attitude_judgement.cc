#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "attitude/accel_bias_fit.h"
#include "base/chi_square.h"
#include "base/error.h"
#include "dataset/bias_sigma.h"
#include "evaluation/given_values.h"
#include "problems/attitude.h"
#include "problems/attitude_evidence.h"
#include "problems/imu_leaps.h"
#include "problems/judged_innovations.h"

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

void AttitudeEstimation::JudgeLeaps() {
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
        LogRatio(innovations_, other) - std::log(kLostForOneLeap);
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

void AttitudeEstimation::JudgeAccelerometers(const Solution& whole) {
  constexpr double kConfidence = 0.9999;
  if (whole.covariances.empty()) return;
  std::vector<Eigen::Quaterniond> q_nb;
  q_nb.reserve(whole.states.size());
  for (const State& x : whole.states) {
    q_nb.push_back(q_en_.conjugate() * x.q_eb);
  }
  const double gravity = filter_options_.place.gravity;
  const Eigen::Vector3d& known = dataset_.initial.accel_bias;
  const AccelBiasFit fit = FitAccelBias(imu_, q_nb, gravity, known);
  const double tilt_sigma =
      std::hypot(UsualTiltSigma(whole),
                 AccelBiasSigma(dataset_.initial).maxCoeff() / gravity);
  const double sigmas = fit.b_a.norm() / gravity / tilt_sigma;
  if (!(fit.significance > ChiSquareQuantile(kConfidence, 3)) ||
      !(sigmas > kUnusableBias)) {
    return;
  }
  const Eigen::Vector3d b = fit.b_a + known;
  evidence_.push_back(
      {.rule = "accelerometer",
       .grade = Grade::kDoubtful,
       .what = fmt::format("the size of the specific force in many attitudes "
                           "shows a bias of the accelerometers that tilts by "
                           "{:.1f} sigma",
                           sigmas),
       .value = sigmas,
       .limit = kUnusableBias,
       .unit = "sigma",
       .causes = {"accelerometers that are not calibrated"},
       .remedies = {fmt::format("initial.accel_bias: [{:.2g} m/s^2, {:.2g} "
                                "m/s^2, {:.2g} m/s^2]",
                                b.x(), b.y(), b.z()),
                    "initial.accel_bias_sigma, as far as it is not known"}});
}

void AttitudeEstimation::JudgeWhole(const Solution& whole) {
  JudgeLeaps();
  JudgeAccelerometers(whole);
}

namespace {

/// Whether the filter is within the errors that it states of what the whole
/// recording tells, which then fits its own readings.
bool Vouches(const Solution& whole,
             const std::vector<NormalisedInnovation>& innovations,
             const Solution& filtered) {
  if (whole.covariances.empty() || filtered.covariances.empty() ||
      whole.states.size() != filtered.states.size() ||
      LargestExcess(TestInnovations(innovations, kFalseAlarms)) >=
          kUnusableError) {
    return false;
  }
  MethodComparison comparison(AttitudeTerms());
  comparison.Compare(whole);
  return !comparison.Compare(filtered);
}

}  // namespace

bool AttitudeEstimation::JudgeFilterByAll(
    const std::optional<StartValues>& start, std::span<const Sensor> sensors,
    const Solution& filtered) {
  std::vector<NormalisedInnovation> own = std::move(innovations_);
  const Solution whole = Smoother();
  JudgeWhole(whole);
  const bool vouched_for = Vouches(whole, innovations_, filtered);
  innovations_ = std::move(own);
  const std::size_t before = evidence_.size();
  FindStrainedValues({.solution = whole, .sensors = sensors, .start = start},
                     &evidence_);
  for (std::size_t i = before; i < evidence_.size(); ++i) {
    evidence_[i].rule = "given_values";
  }
  return vouched_for;
}

}  // namespace hindsight
