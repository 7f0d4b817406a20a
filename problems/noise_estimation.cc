#include "problems/noise_estimation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "problems/noise_likelihood.h"

namespace hindsight {
namespace {

constexpr int kSweeps = 12;
constexpr double kSettled = 0.02;       // change of ln(factor) in a sweep
constexpr double kSettledSigmas = 0.1;  // the same, in its standard deviations
constexpr double kFirstStep = 0.7;      // a factor of two
constexpr double kLeastStep = 0.1;
constexpr double kLargestMove = 2.0;  // in steps
constexpr double kFarthest = 7.0;     // a factor of a thousand
/// A smaller gain of the log-likelihood is none.
constexpr double kLeastGain = 1e-3;

struct Coordinate {
  double step = kFirstStep;
  double moved = 0.0;
  double sigma = std::numeric_limits<double>::infinity();

  bool IsSettled() const {
    return std::abs(moved) < std::max(kSettled, std::isfinite(sigma)
                                                    ? kSettledSigmas * sigma
                                                    : kSettled);
  }
};

/// Moves along one coordinate to the vertex of the parabola through three
/// points a step apart, or to the best point tried. Returns its likelihood.
double Climb(NoiseLikelihood* likelihood, std::size_t i, double value,
             std::vector<double>* logs, Coordinate* coordinate) {
  const double centre = (*logs)[i];
  double best = centre;
  double best_value = value;
  const auto at = [&](double move) {
    std::vector<double> moved = *logs;
    moved[i] = std::clamp(centre + move, -kFarthest, kFarthest);
    const double tried = (*likelihood)(moved);
    if (tried > best_value + kLeastGain) {
      best_value = tried;
      best = moved[i];
    }
    return tried;
  };
  const double step = coordinate->step;
  const double plus = at(step);
  const double minus = at(-step);
  const double curvature = (2.0 * value - plus - minus) / (step * step);
  const double limit = kLargestMove * step;
  if (std::isfinite(curvature) && curvature > 0.0) {
    const double vertex = (plus - minus) / (2.0 * step) / curvature;
    at(std::clamp(vertex, -limit, limit));
  }
  coordinate->sigma = curvature > 1.0 / (kFarthest * kFarthest)
                          ? 1.0 / std::sqrt(curvature)
                          : std::numeric_limits<double>::infinity();
  coordinate->moved = best - centre;
  const double distance = std::abs(best - centre);
  coordinate->step = std::clamp(distance < limit ? distance : 2.0 * step,
                                kLeastStep, kFarthest);
  (*logs)[i] = best;
  return best_value;
}

/// The sum of a sweep's moves once more, as long as it gains: coordinates that
/// make up for each other would take many sweeps.
double Extrapolate(NoiseLikelihood* likelihood,
                   const std::vector<Coordinate>& coordinates, double value,
                   std::vector<double>* logs) {
  for (;;) {
    std::vector<double> moved = *logs;
    for (std::size_t i = 0; i < moved.size(); ++i) {
      moved[i] =
          std::clamp(moved[i] + coordinates[i].moved, -kFarthest, kFarthest);
    }
    const double tried = (*likelihood)(moved);
    if (!(tried > value + kLeastGain)) return value;
    value = tried;
    *logs = moved;
  }
}

/// Curvature of -likelihood at `logs` over the coordinates `which`, in units of
/// `steps`.
Eigen::MatrixXd Curvature(NoiseLikelihood* likelihood,
                          const std::vector<std::size_t>& which,
                          const std::vector<double>& steps, double value,
                          const std::vector<double>& logs) {
  const auto moved_to = [&](std::size_t i, std::size_t j, double direction) {
    std::vector<double> moved = logs;
    moved[which[i]] += direction * steps[i];
    if (j != i) moved[which[j]] += direction * steps[j];
    return (*likelihood)(moved);
  };
  const auto n = static_cast<Eigen::Index>(which.size());
  Eigen::MatrixXd C(n, n);
  for (std::size_t i = 0; i < which.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const auto a = static_cast<Eigen::Index>(i);
      const auto b = static_cast<Eigen::Index>(j);
      // Both ways, so that third derivatives fall out.
      C(a, b) = 2.0 * value - moved_to(i, j, 1.0) - moved_to(i, j, -1.0);
    }
  }
  // Along two coordinates at once the curvature is C_ii + C_jj + 2 C_ij.
  const Eigen::VectorXd own = C.diagonal();
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < a; ++b) {
      C(a, b) = 0.5 * (C(a, b) - own(a) - own(b));
    }
  }
  return C.selfadjointView<Eigen::Lower>();
}

/// Standard deviations of the coordinates, all being unknown together: from the
/// inverse of the curvature over those along which the likelihood is curved at
/// all; infinite for the others.
std::vector<double> MarginalSigmas(NoiseLikelihood* likelihood,
                                   const std::vector<Coordinate>& coordinates,
                                   double value,
                                   const std::vector<double>& logs) {
  std::vector<double> sigmas(logs.size(),
                             std::numeric_limits<double>::infinity());
  std::vector<std::size_t> shown;
  std::vector<double> steps;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    if (!std::isfinite(coordinates[i].sigma)) continue;
    shown.push_back(i);
    steps.push_back(std::clamp(coordinates[i].sigma, kSettled, kFirstStep));
  }
  const Eigen::MatrixXd C = Curvature(likelihood, shown, steps, value, logs);
  const Eigen::LLT<Eigen::MatrixXd> llt(C);
  if (llt.info() != Eigen::Success) return sigmas;
  const Eigen::MatrixXd P =
      llt.solve(Eigen::MatrixXd::Identity(C.rows(), C.cols()));
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto a = static_cast<Eigen::Index>(i);
    sigmas[shown[i]] = steps[i] * std::sqrt(P(a, a));
  }
  return sigmas;
}

/// The end of a climb.
struct Maximum {
  double value = 0.0;
  std::vector<Coordinate> coordinates;
  bool converged = false;
};

Maximum Maximise(NoiseLikelihood* likelihood, std::vector<double>* logs,
                 const std::function<void(double)>& progress) {
  const std::size_t count = logs->size();
  Maximum maximum;
  maximum.coordinates.resize(count);
  maximum.value = (*likelihood)(*logs);
  for (int sweep = 0; sweep < kSweeps && !maximum.converged; ++sweep) {
    for (std::size_t i = 0; i < count; ++i) {
      maximum.value =
          Climb(likelihood, i, maximum.value, logs, &maximum.coordinates[i]);
      progress(
          (sweep + static_cast<double>(i + 1) / static_cast<double>(count)) /
          kSweeps);
    }
    // The steps of the first sweep are too wide for its parabolas to tell that
    // a coordinate has settled.
    maximum.converged =
        sweep > 0 &&
        std::all_of(maximum.coordinates.begin(), maximum.coordinates.end(),
                    [](const Coordinate& c) { return c.IsSettled(); });
    if (!maximum.converged) {
      maximum.value =
          Extrapolate(likelihood, maximum.coordinates, maximum.value, logs);
    }
  }
  return maximum;
}

}  // namespace

NoiseEstimate EstimateNoise(const Dataset& dataset,
                            const std::function<void(double)>& progress) {
  constexpr int kMaxClimbs = 4;
  NoiseLikelihood likelihood(dataset);
  NoiseEstimate estimate;
  std::vector<double> logs(likelihood.size(), 0.0);
  estimate.log_likelihood_before = likelihood(logs);
  Maximum maximum;
  for (int i = 0; i < kMaxClimbs && !estimate.converged; ++i) {
    maximum = Maximise(&likelihood, &logs, [&](double fraction) {
      if (progress) progress((i + fraction) / kMaxClimbs);
    });
    // With the noise found, time offsets may be estimated elsewhere: then the
    // likelihood is another one and is climbed again.
    estimate.converged = maximum.converged && !likelihood.PlaceNodes(logs);
    if (!maximum.converged) break;
  }
  estimate.log_likelihood_after = maximum.value;
  const std::vector<double> sigmas =
      MarginalSigmas(&likelihood, maximum.coordinates, likelihood(logs), logs);
  for (std::size_t i = 0; i < logs.size(); ++i) {
    estimate.factors.push_back(
        {likelihood.name(i), std::exp(logs[i]), sigmas[i]});
  }
  return estimate;
}

}  // namespace hindsight
