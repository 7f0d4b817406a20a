#ifndef HINDSIGHT_TIMELINE_DISTANCE_LINK_H_
#define HINDSIGHT_TIMELINE_DISTANCE_LINK_H_

#include "imu/imu_link.h"
#include "timeline/timeline.h"

namespace hindsight {

/// The transition of an odometer's travelled distance D (block kDistance) from
/// node k to k + 1. With P = p_e + C_eb l the axle's position,
///   phi = Log(C_i' C_j),   s = Jl(phi)^-1 C_i' (P_j - P_i),
///   D_j = D0 + (1 + k) e_x' C_ob s:
/// s is the integral of the axle's velocity in body axes, exact where turn rate
/// and that velocity are constant, in error by some 1e-2 |phi|^2 |s| where a
/// turn begins. D0 = D_i; where an increment begins at node i, D0 is minus the
/// count's error (kOffset) and the distance travelled before the count, and D_i
/// is forgotten: a slipped increment says nothing of those after it. The times
/// i and j may also lie between the nodes, and i is then no begin.
/// No noise but kDistanceFloor: positions at both ends are states.
struct DistanceLink {
  double distance = 0.0;  ///< D_j [m]
  /// Derivatives with respect to the errors at i (with all constants) and j.
  Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, kMaxErrorDim>
      J_i, J_j;
};

/// Keeps covariances regular [m].
inline constexpr double kDistanceFloor = 1e-5;

/// The link of `sensor`, whose kDistance block the layout must have.
DistanceLink EvaluateDistanceLink(const ErrorLayout& layout,
                                  const Timeline& timeline, std::size_t k,
                                  const State& x_i, const State& x_j,
                                  int sensor);

/// Sets the distances of x_j, elsewhere predicted. Does nothing to layouts
/// without distances, as the next.
void PredictDistances(const ErrorLayout& layout, const Timeline& timeline,
                      std::size_t k, const State& x_i, State* x_j);

/// Completes the rows of distances in a transition whose other rows are
/// linearised at x_i and x_j.
void LinearizeDistances(const ErrorLayout& layout, const Timeline& timeline,
                        std::size_t k, const State& x_i, const State& x_j,
                        Transition* transition);

}  // namespace hindsight

#endif  // HINDSIGHT_TIMELINE_DISTANCE_LINK_H_
