#include "evaluation/given_values.h"

#include <cmath>

#include "base/text.h"

namespace hindsight {
namespace {

constexpr double kStrained = 5.0;   // sigma
constexpr double kSameTime = 1e-6;  // [s]

/// Where a component of the start came from.
struct Origin {
  bool given = true;  ///< by the configuration
  std::string key;    ///< that says it, or would
};

Origin OriginOf(const Judged& judged, const Block& block, int axis) {
  const InitialState& given = judged.start->given;
  switch (block.key.kind) {
    case BlockKind::kPosition:
      return {given.position.has_value(), "initial.position"};
    case BlockKind::kVelocity:
      return {given.v_n.has_value(), "initial.velocity"};
    case BlockKind::kAttitude:
      if (given.heading && axis == 2) return {true, "initial.heading"};
      return {given.euler.has_value(), "initial.attitude"};
    case BlockKind::kGyroBias:
      return {given.gyro_bias_sigma && judged.start->x.b_g == given.gyro_bias,
              "initial.gyro_bias"};
    case BlockKind::kAccelBias:
      return {given.accel_bias_sigma.has_value(), "initial.accel_bias"};
    default:
      break;
  }
  if (block.key.sensor == BlockKey::kNoSensor) return {true, "imu"};
  const auto sensor = static_cast<std::size_t>(block.key.sensor);
  return {true, sensor < judged.sensors.size()
                    ? "aiding." + judged.sensors[sensor].name
                    : block.name};
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

Evidence Strain(const Judged& judged, const Block& block, int axis,
                const std::string& component, double sigmas, double pull) {
  const Origin origin = OriginOf(judged, block, axis);
  const bool constant = block.evolution.kind == Evolution::Kind::kConstant;
  Evidence e{
      .grade = pull >= kUnusableBias ? Grade::kUnusable : Grade::kDoubtful,
      .value = sigmas,
      .limit = kStrained,
      .unit = "sigma"};
  const std::string when = constant ? " is " : " at the start is ";
  if (origin.given) {
    e.what =
        component + when + Format("%.1f sigma from its given value", sigmas);
    e.causes = {"a wrong value, sign, unit or clock of " + origin.key,
                "too small a sigma of it"};
    e.remedies = {"the configuration without " + origin.key +
                  " or with a larger sigma of it"};
  } else {
    e.what = component + when +
             Format("%.1f sigma from the program's own start", sigmas) +
             OwnSource(*judged.start, block.key.kind);
    e.causes = {"too small a sigma of that start"};
    e.remedies = {origin.key + " and " + origin.key +
                  "_sigma in the configuration"};
  }
  if (!constant) e.t_begin = e.t_end = judged.start->x.t;
  return e;
}

}  // namespace

void FindStrainedValues(const Judged& judged, std::vector<Evidence>* evidence) {
  const Solution& solution = judged.solution;
  // P of an observer weighs nothing against its start.
  if (!judged.start || solution.observer || solution.covariances.empty() ||
      solution.layout.dim() != judged.start->P.rows()) {
    return;
  }
  const StartValues& start = *judged.start;
  const bool from_start =
      std::abs(solution.states.front().t - start.x.t) <= kSameTime;
  const ErrorVector first =
      Local(solution.layout, start.x, solution.states.front());
  const ErrorVector last =
      Local(solution.layout, start.x, solution.states.back());
  const ErrorMatrix P_first = solution.covariances.Get(0);
  const ErrorMatrix P_last =
      solution.covariances.Get(solution.covariances.size() - 1);
  for (const Block& block : solution.layout.blocks()) {
    const bool constant = block.evolution.kind == Evolution::Kind::kConstant;
    if (!constant && !from_start) continue;
    int i = block.offset;
    for (int axis = 0; axis < FullDimension(block.key.kind); ++axis) {
      if (!block.active[static_cast<std::size_t>(axis)]) continue;
      const double sigma0 = std::sqrt(start.P(i, i));
      const double sigmas = std::abs(constant ? last(i) : first(i)) / sigma0;
      const double r =
          std::sqrt(constant ? P_last(i, i) : P_first(i, i)) / sigma0;
      if (sigmas > kStrained) {
        const double pull = r < 1.0 ? sigmas * r / (1.0 - r * r) : sigmas;
        evidence->push_back(Strain(judged, block, axis,
                                   solution.layout.ComponentName(i), sigmas,
                                   pull));
      }
      ++i;
    }
  }
}

}  // namespace hindsight
