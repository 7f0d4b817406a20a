#include "problems/coarse_start.h"

#include <algorithm>
#include <utility>

#include "alignment/clock_slack.h"
#include "alignment/coarse_alignment.h"
#include "alignment/velocity_alignment.h"
#include "base/error.h"
#include "base/units.h"

namespace hindsight {
namespace {

bool SaysNothingOfStart(const InitialState& given) {
  return given.alignment == AlignmentKind::kAuto && !given.t && !given.euler &&
         !given.heading;
}

/// An initial state with the attitude that AlignCoarsely finds from the first
/// kAlignmentWindow of motion; none if the data set says something of the
/// start.
std::optional<InitialState> CoarseInitial(
    const Dataset& dataset, const ReconstructionOptions& options) {
  const InitialState& given = dataset.initial;
  if (!SaysNothingOfStart(given)) return std::nullopt;
  const double from = std::max(options.from, dataset.imu.t_begin());
  const double to = std::min(options.to, dataset.imu.t_end());
  AlignmentInput input{.dataset = dataset,
                       .to = to,
                       .fixes = PositionFixes(dataset, from, to),
                       .velocities = GroundVelocities(dataset, from, to),
                       .b_g = given.gyro_bias,
                       .b_a = given.accel_bias,
                       .gyro_sigma = GyroBiasSigma(given).maxCoeff()};
  if (!given.position && input.fixes.empty()) return std::nullopt;
  input.t = given.position ? from : input.fixes.front().t;
  input.p_e = given.position ? EcefFromGeodetic(*given.position)
                             : input.fixes.front().p_e;
  const auto coarse =
      AlignCoarsely(input, std::min(to, FirstMotion(input) + kAlignmentWindow),
                    input.b_g, input.b_a);
  if (!coarse) return std::nullopt;
  InitialState initial = given;
  initial.t = input.t;
  const Eigen::Quaterniond q_nb =
      Eigen::Quaterniond(NedAxes(input.p_e).transpose()) * coarse->q_eb;
  initial.euler = EulerFromQuaternion(q_nb);
  const Eigen::Vector3d turn_n =
      TurnWithin(ClockSigma(dataset), dataset.imu, input.t, q_nb, input.b_g);
  // P is that of white errors. Those of a wrong clock are not white: hence a
  // factor, a floor, and the turn within the clock's uncertainty.
  initial.attitude_sigma = (3.0 * coarse->P.diagonal().cwiseSqrt().array() +
                            kDegree + turn_n.array().abs())
                               .min(kUnknownHeadingSigma);
  return initial;
}

}  // namespace

std::optional<Start> CoarseStart(const ReconstructionOptions& options,
                                 Dataset* dataset) {
  std::optional<InitialState> initial = CoarseInitial(*dataset, options);
  if (!initial) return std::nullopt;
  std::swap(dataset->initial, *initial);
  std::optional<Start> start;
  try {
    start = FindStart(*dataset, options.from, options.to);
  } catch (const EstimationError&) {
    // Coarsely there is no start.
  }
  std::swap(dataset->initial, *initial);
  return start;
}

}  // namespace hindsight
