#ifndef HINDSIGHT_EVALUATION_STATE_ERRORS_H_
#define HINDSIGHT_EVALUATION_STATE_ERRORS_H_

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "dataset/dataset.h"
#include "state/solution.h"

namespace hindsight {

/// Closed span of time [s].
struct TimeRange {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();

  bool Contains(double t) const { return t >= from && t <= to; }
};

/// Errors of three components along a trajectory, truth less estimate, and what
/// was stated of them; of two the third is zero.
struct PartErrors {
  std::vector<Eigen::Vector3d> e;
  std::vector<Eigen::Vector3d> sigma;
  std::vector<double> nees;  ///< e' P^-1 e; right is the number of components

  std::vector<double> Norms() const;
  std::vector<double> Component(int axis) const;
  std::vector<double> Level() const;  ///< norms of the first two components
  std::vector<double> Down() const { return Component(2); }
  /// Share of all three components within so many sigmas.
  double ShareInside(double sigmas) const;
};

/// Root mean squares of the norms, of Level and of Down; mean of nees.
double TotalRms(const PartErrors& part);
double LevelRms(const PartErrors& part);
double DownRms(const PartErrors& part);
double MeanNees(const PartErrors& part);

/// The tangent of all estimators (state/state.h) at each of some states.
struct StateErrors {
  std::vector<double> t;  ///< [s]
  /// NED [m], [rad], body axes [rad/s], NED [m], [m/s]; empty of what the layout
  /// has not, or not in all components.
  PartErrors position, attitude, gyro_bias;
  PartErrors horizontal, horizontal_velocity;  ///< north and east alone
  std::vector<double> yaw;   ///< difference of the Euler angles [rad]
  std::vector<double> nees;  ///< of all components with truth
  int states = 0;            ///< how many those are

  /// Share of the states of which a component of position or attitude is more
  /// than so many sigmas off.
  double ShareBeyond(double sigmas) const;
  /// A part at the times within the range.
  PartErrors Within(PartErrors StateErrors::*part,
                    const TimeRange& range) const;
};

/// Of the states of those numbers. Throws InputError for one without truth.
StateErrors ErrorsOf(const Dataset& dataset, const Solution& solution,
                     const std::vector<std::size_t>& numbers);
/// Of one state in `every`, the first being one of them.
StateErrors ErrorsOf(const Dataset& dataset, const Solution& solution,
                     std::size_t every = 1);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_STATE_ERRORS_H_
