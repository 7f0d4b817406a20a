#include "evaluation/given_values.h"

#include <fmt/core.h>

#include <cmath>

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
                const std::string& component, double sigmas) {
  const bool constant = block.evolution.is_constant();
  Evidence e{.grade = Grade::kDoubtful,
             .what = component + (constant ? " is " : " at the start is "),
             .value = sigmas,
             .limit = kStrained,
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

}  // namespace

void FindStrainedValues(const Judged& judged, std::vector<Evidence>* evidence) {
  const Solution& solution = judged.solution;
  // P of an observer weighs nothing against its start.
  if (!judged.start || solution.observer ||
      solution.layout.dim() != judged.start->P.rows()) {
    return;
  }
  const StartValues& start = *judged.start;
  const bool from_start =
      std::abs(solution.states.front().t - start.x.t) <= kAtTheStart;
  const ErrorVector first =
      Local(solution.layout, start.x, solution.states.front());
  const ErrorVector last =
      Local(solution.layout, start.x, solution.states.back());
  for (const Block& block : solution.layout.blocks()) {
    const bool constant = block.evolution.is_constant();
    const bool start_value = block.key.kind <= BlockKind::kAccelBias;
    if (!constant && !(start_value && from_start)) continue;
    int i = block.offset;
    for (int axis = 0; axis < FullDimension(block.key.kind); ++axis) {
      if (!block.active[static_cast<std::size_t>(axis)]) continue;
      const double sigma0 = std::sqrt(start.P(i, i));
      const double sigmas = std::abs(constant ? last(i) : first(i)) / sigma0;
      const double of_given = StrainOfGiven(
          judged, block, axis,
          constant ? solution.states.back() : solution.states.front());
      const std::string name = solution.layout.ComponentName(i);
      if (of_given > kStrained) {
        evidence->push_back(
            Strain(judged, OfBias(true, "gyro_bias", start.given.gyro_bias),
                   block, name, of_given));
      } else if (sigmas > kStrained) {
        evidence->push_back(
            Strain(judged, OriginOf(judged, block, axis), block, name, sigmas));
        // Measured = (1 + scale) true: below -1 it counts backwards.
        if (block.key.kind == BlockKind::kScale && last(i) < -1.0) {
          evidence->back().causes = {"a speed of the wrong sign"};
          evidence->back().remedies = {
              "a leading \"-\" before its column under `columns`"};
        }
      }
      ++i;
    }
  }
}

}  // namespace hindsight
