#include "receiver_errors/other_tellings.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "receiver_errors/sensor_tape.h"
#include "receiver_errors/sequence_smoother.h"
#include "receiver_errors/sequence_variations.h"

namespace hindsight {
namespace {

constexpr double kLasting = 1e8;  // correlation time of a bias that stays [s]

double LogPosterior(const RegimeProblem& problem,
                    const ErrorParameters& parameters,
                    const ModeSequence& sequence) {
  return ScoreSequence(problem.tape, parameters, sequence).log_posterior();
}

/// The largest of the sensor's errors along an axis, smoothed.
double SizeOf(const RegimeProblem& problem, const Hypothesis& one) {
  const int n = problem.tape.dim();
  const ErrorTrajectory smoothed =
      SmoothSequence(problem.tape, one.parameters, one.sequence);
  Eigen::Vector3d largest = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < smoothed.size(); ++k) {
    largest = largest.cwiseMax(smoothed[k].segment<3>(n).cwiseAbs());
  }
  return largest.maxCoeff();
}

/// A fix as noise has it.
struct JudgedFix {
  double off = 0.0;  ///< root mean square of what is left of it, an axis
  bool outlier = false;
};

/// Of all fixes of the sensor.
std::vector<JudgedFix> JudgeFixes(const RegimeProblem& problem,
                                  const Hypothesis& noise) {
  constexpr double kOutlier = 5.0;  // sigma
  const SensorTape& tape = problem.tape;
  const ErrorTrajectory smoothed =
      SmoothSequence(tape, noise.parameters, noise.sequence);
  std::vector<JudgedFix> fixes;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.linear().measurements(k)) {
      if (z.sensor != tape.sensor() || !z.accepted || z.withheld) continue;
      const Eigen::VectorXd left =
          z.residual - z.H * smoothed[k].head(tape.dim());
      const Eigen::VectorXd sigmas = left.cwiseAbs().cwiseQuotient(
          z.R.diagonal().cwiseSqrt() * noise.parameters.scale);
      fixes.push_back(
          {left.norm() / std::sqrt(static_cast<double>(left.size())),
           sigmas.maxCoeff() > kOutlier});
      break;
    }
  }
  return fixes;
}

/// Of so many fixes the first ones behind gaps, the first of all included, and past the
/// last.
std::vector<std::size_t> BeginsOfStretches(const SensorTape& tape,
                                           std::size_t fixes) {
  std::vector<std::size_t> begins = FixesBehindGaps(tape);
  begins.insert(begins.begin(), 0);
  begins.push_back(fixes);
  return begins;
}

/// Mean time between fixes [s].
double Spacing(const RegimeProblem& problem, std::size_t fixes) {
  const double duration =
      problem.tape.t(problem.tape.size() - 1) - problem.tape.t(0);
  return duration / static_cast<double>(std::max<std::size_t>(1, fixes));
}

}  // namespace

std::vector<Attempt> ExchangedRoles(const RegimeProblem& problem,
                                    const Hypothesis& jumping) {
  std::vector<Attempt> all;
  for (ModeSequence& other : RolesExchanged(jumping.sequence)) {
    ErrorParameters p = jumping.parameters;
    p.sigma = SizeOf(problem, jumping);
    p.tau = kLasting;
    all.push_back({p, std::move(other)});
  }
  return all;
}

Attempt BestOutlierThatIsRight(const RegimeProblem& problem,
                               const Hypothesis& noise) {
  Attempt best;
  const std::vector<JudgedFix> fixes = JudgeFixes(problem, noise);
  if (fixes.size() < 2 || fixes.size() != noise.sequence.size()) return best;
  const std::vector<std::size_t> begins =
      BeginsOfStretches(problem.tape, fixes.size());
  for (std::size_t s = 0; s + 1 < begins.size(); ++s) {
    const std::size_t begin = begins[s];
    const std::size_t past = begins[s + 1];
    if (past - begin < 2) continue;
    for (const std::size_t right : {begin, past - 1}) {
      const bool hidden = right == begin ? past < fixes.size() : begin > 0;
      if (!fixes[right].outlier || !hidden) continue;
      ModeSequence sequence(fixes.size());
      for (std::size_t i = begin; i < past; ++i) {
        if (i != right) sequence[i].mode = ErrorMode::kBiased;
      }
      sequence[right == begin ? begin + 1 : begin].anew = true;
      ErrorParameters p;
      p.scale = noise.parameters.scale;
      p.sigma = fixes[right].off;
      p.tau = kLasting;
      problem.effort->Spend(problem.tape.size());
      const double log_posterior = LogPosterior(problem, p, sequence);
      if (best.sequence.empty() || log_posterior > best.log_posterior) {
        best = {p, std::move(sequence), log_posterior};
      }
    }
  }
  return best;
}

Attempt BestDriftThatEnds(const RegimeProblem& problem,
                          const Hypothesis& jumping) {
  Attempt best;
  const double size = SizeOf(problem, jumping);
  const double dt = Spacing(problem, jumping.sequence.size());
  for (ModeSequence& one : DriftsThatEnd(jumping.sequence)) {
    const auto drifts = std::count_if(one.begin(), one.end(), [](auto& s) {
      return s.mode == ErrorMode::kDrifting;
    });
    ErrorParameters p = jumping.parameters;
    p.rate_sigma = size / (static_cast<double>(drifts) * dt);
    p.imu_scale = std::min(1.0, p.imu_scale);
    problem.effort->Spend(problem.tape.size());
    const double log_posterior = LogPosterior(problem, p, one);
    if (best.sequence.empty() || log_posterior > best.log_posterior) {
      best = {p, std::move(one), log_posterior};
    }
  }
  return best;
}

}  // namespace hindsight
