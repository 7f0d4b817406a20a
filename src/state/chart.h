#ifndef HINDSIGHT_STATE_CHART_H_
#define HINDSIGHT_STATE_CHART_H_

#include "state/state.h"

namespace hindsight {

/// Which coordinates a full-state estimator counts a state in.
enum class ChartKind {
  /// Metres north, east, down from an origin and velocity, all in the NED axes
  /// at the reference; small angles of rotation from the reference; biases and
  /// parameters as they are.
  kAdditive,
  /// Latitude, longitude [rad], height [m]; NED velocity at the state's own
  /// position [m/s]; roll, pitch, heading [rad]; biases and parameters as they
  /// are. Singular at the poles and at pitch = +-90 deg.
  kEuler,
};

/// Coordinates xi of states near a reference, over the components of a layout.
/// Linear in the reference's tangent only for kAdditive.
class Chart {
 public:
  /// `layout` must outlive the chart; `origin_e` is the zero of the additive
  /// chart's positions. Throws
  /// std::logic_error if the layout's head is not the five complete navigation
  /// blocks.
  Chart(const ErrorLayout& layout, ChartKind kind, const State& reference,
        const Eigen::Vector3d& origin_e);

  /// Angles are continued from the reference, not folded.
  ErrorVector Coordinates(const State& x) const;
  /// d Coordinates(x [+] d) / d d at d = 0.
  ErrorMatrix Jacobian(const State& x) const;
  /// The state that has these coordinates.
  State ToState(const ErrorVector& xi) const;

 private:
  ErrorVector EulerCoordinates(const State& x) const;
  ErrorMatrix EulerJacobian(const State& x) const;

  const ErrorLayout* layout_;
  ChartKind kind_;
  State reference_;
  ErrorVector xi_reference_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_CHART_H_
