#include "evaluation/given_values.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/chi_square.h"

namespace hindsight {
namespace {

constexpr double kAtTheStart = 1e-6;  // [s]

/// Where a component of the start came from.
struct Origin {
  bool given = true;      ///< by the configuration
  std::string key;        ///< that says the value, or would
  std::string sigma_key;  ///< that says how well it is known
  /// What the component is away from, where that is no value that was given.
  std::string instead;
};

Origin OfStart(bool given, const std::string& key) {
  return {given, "initial." + key, "initial." + key + "_sigma", ""};
}

/// A bias whose sigma alone is given begins at zero.
Origin OfBias(bool given, const std::string& key, const Eigen::Vector3d& bias) {
  Origin origin = OfStart(given, key);
  if (bias.isZero()) {
    origin.instead = "zero, as no " + origin.key + " is given";
  }
  return origin;
}

/// The word of a configuration for a constant of a sensor.
const char* WordOf(BlockKind kind) {
  switch (kind) {
    case BlockKind::kScale:
      return "scale";
    case BlockKind::kMounting:
      return "mounting";
    case BlockKind::kLeverArm:
      return "lever_arm";
    case BlockKind::kTimeOffset:
      return "time_offset";
    case BlockKind::kOffset:
      return "offset";
    case BlockKind::kHardIron:
      return "hard_iron";
    case BlockKind::kDeclination:
      return "declination";
    default:
      return nullptr;
  }
}

Origin OfSensor(const Judged& judged, const Block& block) {
  const auto i = static_cast<std::size_t>(block.key.sensor);
  if (i >= judged.sensors.size()) return {true, block.name, block.name, ""};
  const Sensor& sensor = judged.sensors[i];
  const std::string stream = "aiding." + sensor.name;
  const char* word = WordOf(block.key.kind);
  if (block.key.kind == BlockKind::kBias ||
      block.key.kind == BlockKind::kGroundBias) {
    const std::string key =
        stream +
        (block.key.kind == BlockKind::kBias ? ".bias" : ".ground_bias") +
        ".sigma";
    return {true, key, key, ""};
  }
  if (word == nullptr) return {true, stream, stream, ""};
  // A mounting that the direction of travel has turned is the program's own.
  const bool found =
      block.key.kind == BlockKind::kMounting &&
      !judged.start->x.parameters.segment<3>(block.parameter_offset).isZero();
  return {!found, stream + "." + word, stream + ".estimate." + word, ""};
}

Origin OriginOf(const Judged& judged, const Block& block, int axis) {
  const InitialState& given = judged.start->given;
  switch (block.key.kind) {
    case BlockKind::kPosition:
      return OfStart(given.position.has_value(), "position");
    case BlockKind::kVelocity:
      return OfStart(given.v_n.has_value(), "velocity");
    case BlockKind::kAttitude:
      if (given.heading && axis == 2) {
        return {true, "initial.heading", "initial.attitude_sigma", ""};
      }
      return OfStart(given.euler.has_value(), "attitude");
    case BlockKind::kGyroBias:
      return OfBias(given.gyro_bias_sigma.has_value() &&
                        judged.start->x.b_g == given.gyro_bias,
                    "gyro_bias", given.gyro_bias);
    case BlockKind::kAccelBias:
      return OfBias(given.accel_bias_sigma.has_value(), "accel_bias",
                    given.accel_bias);
    case BlockKind::kGyroScale:
    case BlockKind::kAccelScale:
      return {true, "imu.estimate." + block.name, "imu.estimate." + block.name,
              ""};
    default:
      return OfSensor(judged, block);
  }
}

/// How the program came by a start value of its own.
std::string OwnSource(const StartValues& start, BlockKind kind) {
  switch (kind) {
    case BlockKind::kPosition:
      return " (" + start.position + ")";
    case BlockKind::kAttitude:
      return " (alignment " + start.alignment + ")";
    default:
      return "";
  }
}

Evidence Strain(const Judged& judged, const Origin& origin, const Block& block,
                const std::string& component, double sigmas, double limit) {
  const bool constant = block.evolution.is_constant();
  Evidence e{.grade = Grade::kDoubtful,
             .what = component + (constant ? " is " : " at the start is "),
             .value = sigmas,
             .limit = limit,
             .unit = "sigma"};
  // What else does not fit may well come from a start that is not so.
  e.is_cause = origin.given && !constant;
  if (origin.given) {
    e.what += fmt::format(
        "{:.1f} sigma from {}", sigmas,
        origin.instead.empty() ? "its given value" : origin.instead);
    e.causes = {"a wrong value, sign, unit or clock of " + origin.key,
                "too small a sigma of it",
                "an error that is not modelled and ends up there"};
    e.remedies = {"another " + origin.key, "a larger " + origin.sigma_key};
  } else {
    e.what += fmt::format("{:.1f} sigma from the program's own start", sigmas) +
              OwnSource(*judged.start, block.key.kind);
    e.causes = {"too small a sigma of that start",
                "an error that is not modelled and ends up there"};
    e.remedies = {origin.key + " and " + origin.sigma_key +
                  " in the configuration"};
  }
  // Both are the same key where the value is zero by definition.
  if (origin.given && origin.key == origin.sigma_key) {
    e.remedies.erase(e.remedies.begin());
  }
  if (!constant) e.t_begin = e.t_end = judged.start->x.t;
  return e;
}

/// Of a gyro bias that was given with its sigma, which the start may have
/// combined with what the data say: how far the solution is from what was
/// given, in the given sigma. Zero of all else.
double StrainOfGiven(const Judged& judged, const Block& block, int axis,
                     const State& x) {
  const InitialState& given = judged.start->given;
  if (block.key.kind != BlockKind::kGyroBias || !given.gyro_bias_sigma) {
    return 0.0;
  }
  return std::abs(x.b_g(axis) - given.gyro_bias(axis)) /
         (*given.gyro_bias_sigma)(axis);
}

/// A value that is held against what it started from.
struct Strained {
  const Block& block;
  Origin origin;
  std::string component;
  double sigmas = 0.0;
  double value = 0.0;  ///< away from the start
};

std::vector<Strained> AllStrained(const Judged& judged) {
  const Solution& solution = judged.solution;
  const StartValues& start = *judged.start;
  const bool from_start =
      std::abs(solution.states.front().t - start.x.t) <= kAtTheStart;
  const ErrorVector first =
      Local(solution.layout, start.x, solution.states.front());
  const ErrorVector last =
      Local(solution.layout, start.x, solution.states.back());
  std::vector<Strained> all;
  for (const Block& block : solution.layout.blocks()) {
    const bool constant = block.evolution.is_constant();
    const bool start_value = block.key.kind <= BlockKind::kAccelBias;
    if (!constant && !(start_value && from_start)) continue;
    int i = block.offset;
    for (int axis = 0; axis < FullDimension(block.key.kind); ++axis) {
      if (!block.active[static_cast<std::size_t>(axis)]) continue;
      const double off = constant ? last(i) : first(i);
      const std::string name = solution.layout.ComponentName(i);
      all.push_back({block, OriginOf(judged, block, axis), name,
                     std::abs(off) / std::sqrt(start.P(i, i)), off});
      const double of_given = StrainOfGiven(
          judged, block, axis,
          constant ? solution.states.back() : solution.states.front());
      if (of_given > 0.0 && !all.back().origin.given) {
        all.push_back({block, OfBias(true, "gyro_bias", start.given.gyro_bias),
                       name, of_given, off});
      }
      ++i;
    }
  }
  return all;
}

}  // namespace

double StrainLimit(int count) {
  return std::sqrt(
      ChiSquareQuantile(1.0 - kFalseAlarms / std::max(count, 1), 1.0));
}

void FindStrainedValues(const Judged& judged, std::vector<Evidence>* evidence) {
  const Solution& solution = judged.solution;
  // P of an observer weighs nothing against its start.
  if (!judged.start || solution.observer ||
      solution.layout.dim() != judged.start->P.rows()) {
    return;
  }
  const std::vector<Strained> all = AllStrained(judged);
  const double of_given = StrainLimit(static_cast<int>(std::ranges::count_if(
      all, [](const Strained& one) { return one.origin.given; })));
  for (const Strained& one : all) {
    const double limit = one.origin.given ? of_given : kStrained;
    if (!(one.sigmas > limit)) continue;
    evidence->push_back(Strain(judged, one.origin, one.block, one.component,
                               one.sigmas, limit));
    // Measured = (1 + scale) true: below -1 it counts backwards.
    if (one.block.key.kind == BlockKind::kScale && one.value < -1.0) {
      evidence->back().causes = {"a speed of the wrong sign"};
      evidence->back().remedies = {
          "a leading \"-\" before its column under `columns`"};
    }
  }
}

}  // namespace hindsight
