#include "evaluation/accuracy_rule.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/chi_square.h"
#include "base/units.h"
#include "evaluation/observability.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// Standard deviations of one quantity over time.
struct Spread {
  double squares = 0.0;
  double worst = 0.0;

  void Add(double variance) {
    squares += variance;
    worst = std::max(worst, variance);
  }
};

void AddSpread(const char* name, const char* unit, double scale, double limit,
               const Spread& spread, double count,
               std::vector<Evidence>* evidence) {
  const double rms = std::sqrt(spread.squares / count) / scale;
  const double worst = std::sqrt(spread.worst) / scale;
  Evidence e{.what = fmt::format("{} to {:.2g} {}", name, rms, unit),
             .value = rms,
             .limit = limit / scale,
             .unit = unit};
  if (worst > 2.0 * rms) e.what += fmt::format(" ({:.2g} at worst)", worst);
  evidence->push_back(std::move(e));
}

/// The sensor that alone tells where the vehicle is and is taken to have no error
/// that lasts; null: none, or several.
const Sensor* OnlyWhitePlacer(std::span<const Sensor> sensors) {
  const Sensor* only = nullptr;
  for (const Sensor& sensor : sensors) {
    if (!sensor.kind->places) continue;
    if (only != nullptr) return nullptr;
    only = &sensor;
  }
  return only == nullptr || only->noise.correlated() ? nullptr : only;
}

/// Where the innovations of what tells the place are kUnusableError times as
/// small as stated, beyond chance, nothing of that size contradicts them.
void DescribeHiddenErrors(const Judged& judged,
                          std::vector<Evidence>* evidence) {
  std::vector<double> squares(judged.sensors.size(), 0.0);
  std::vector<double> count(judged.sensors.size(), 0.0);
  for (const InnovationFigure& figure : judged.innovations) {
    const auto i = static_cast<std::size_t>(figure.sensor);
    const auto n = static_cast<double>(figure.count);
    squares[i] += figure.rms * figure.rms * n;
    count[i] += n;
  }
  for (std::size_t i = 0; i < judged.sensors.size(); ++i) {
    const double ratio = std::sqrt(count[i] / squares[i]);
    if (!judged.sensors[i].kind->places || !(ratio >= kUnusableError) ||
        ChiSquareCdf(squares[i], count[i]) > kFalseAlarms) {
      continue;
    }
    evidence->push_back(
        {.what = fmt::format("but what is odd in {} is hard to see, whose "
                             "sigmas are {:.2g} times what its innovations say",
                             judged.sensors[i].name, ratio),
         .value = ratio,
         .limit = kUnusableError,
         .unit = "1"});
  }
}

}  // namespace

void DescribeAccuracy(const Judged& judged, std::vector<Evidence>* evidence) {
  const Solution& solution = judged.solution;
  if (solution.observer) {
    evidence->push_back({.what = "by P, which is no covariance"});
    return;
  }
  if (solution.covariances.empty()) return;
  const Block* position = solution.layout.Find(BlockKind::kPosition);
  const Block* velocity = solution.layout.Find(BlockKind::kVelocity);
  const Block* attitude = solution.layout.Find(BlockKind::kAttitude);
  // About axes that are level, as those of vehicles are on average.
  const Eigen::Vector3d mounting = judged.mounting_sigma.cwiseAbs2();
  const bool over_ground =
      std::any_of(solution.unobserved.begin(), solution.unobserved.end(),
                  [&solution](const UnobservedSpan& span) {
                    return span.component == kHeightComponent &&
                           IsMostOfTheTime(span, solution);
                  });
  Spread p, v, tilt, heading;
  for (std::size_t k = 0; k < solution.covariances.size(); ++k) {
    const ErrorVector P = solution.covariances.Variances(k);
    if (position != nullptr) {
      p.Add(P.segment(position->offset, over_ground ? 2 : position->dim).sum());
    }
    if (velocity != nullptr) {
      v.Add(P.segment(velocity->offset, velocity->dim).sum());
    }
    if (attitude != nullptr && attitude->dim == 3) {
      tilt.Add(P.segment(attitude->offset, 2).sum() + mounting.head<2>().sum());
      heading.Add(P(attitude->offset + 2) + mounting.z());
    }
  }
  const auto count = static_cast<double>(solution.covariances.size());
  if (position != nullptr) {
    AddSpread(over_ground ? "position over the ground" : "position", "m", 1.0,
              kLargestPositionSigma, p, count, evidence);
    if (const Sensor* only = OnlyWhitePlacer(judged.sensors)) {
      evidence->back().what += " if no error of " + only->name + " lasts";
    }
  }
  if (velocity != nullptr) {
    AddSpread("velocity", "m/s", 1.0, kLargestVelocitySigma, v, count,
              evidence);
  }
  if (attitude == nullptr || attitude->dim != 3) return;
  AddSpread("tilt", "deg", kDegree, kLargestTiltSigma, tilt, count, evidence);
  if (judged.relative_heading) {
    evidence->push_back(
        {.what = fmt::format("but the heading counts from the start and is "
                             "uncertain by {:.2g} deg at worst: nothing "
                             "measures it",
                             std::sqrt(heading.worst) / kDegree)});
  } else {
    AddSpread("heading", "deg", kDegree, kLargestHeadingSigma, heading, count,
              evidence);
  }
  if (position != nullptr) DescribeHiddenErrors(judged, evidence);
}

}  // namespace hindsight
