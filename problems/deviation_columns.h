#ifndef HINDSIGHT_PROBLEMS_DEVIATION_COLUMNS_H_
#define HINDSIGHT_PROBLEMS_DEVIATION_COLUMNS_H_

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "filters/mean_shift.h"
#include "timeline/problem.h"

namespace hindsight {

/// One way in which a sensor may be other than it is said to be.
struct Deviation {
  enum class Kind {
    kAdditive,   ///< error of a component
    kTurned,     ///< what is measured in navigation axes, about one of them
    kStretched,  ///< the same multiplied, positions from the first one on
    kBlock,  ///< a state that the kind of sensor may have (SensorKind::blocks)
  };
  Kind kind = Kind::kAdditive;
  BlockKind block = BlockKind::kScale;  ///< of kBlock
  int axis = 0;  ///< of kAdditive the component (ComponentOf)
  /// Whether it may begin, or begin to grow, in the middle.
  bool may_begin_late = false;
};

/// One way in which the axes of the IMU may be others than they are said to be.
struct ImuDeviation {
  enum class Kind {
    kScale,      ///< the axis measures too much
    kExchanged,  ///< at size one the two others stand for each other
    kTurned,  ///< all three, about the axis, against those of the other triad
    kLate,    ///< all three, by a second, against the other triad
  };
  Kind kind;
  bool of_gyros;
  int axis;

  /// What a reading, which changes by `rate` a second, has too much, by the size
  /// of one.
  Eigen::Vector3d Of(const Eigen::Vector3d& reading,
                     const Eigen::Vector3d& rate) const;
};

/// In the order of the columns of DeviationColumns::kImu.
std::span<const ImuDeviation> ImuDeviations();

/// Sensitivities to all that may be wrong with the sensors, along a trajectory,
/// a state a node. The groups are the numbers of the sensors, kAllClocks and
/// kImu.
class DeviationColumns {
 public:
  /// One column: all sensors' clocks against the IMU's.
  static constexpr int kAllClocks = -1;
  /// Columns of ImuDeviation, as biases in proportion to the reading of each
  /// interval.
  static constexpr int kImu = -2;

  /// The arguments must outlive the object.
  DeviationColumns(const Problem& problem, const std::vector<State>& states,
                   const LinearTape& tape);

  /// Of the sensor, in the order of its columns.
  const std::vector<Deviation>& Of(int sensor) const {
    return sensors_[static_cast<std::size_t>(sensor)].deviations;
  }
  ShiftColumns Columns() const;
  /// The additive ones of the sensors alone, in their order: they are the same along
  /// any trajectory, and nothing is evaluated for them.
  ShiftColumns Additive() const;
  /// MeanShift::z of the size beyond what nothing tells.
  ///
  /// Of gyros that are late half a sample interval, as a reading may stand for the
  /// instant or for the mean of the interval before it; and what noise of the readings
  /// looks like, which is in the columns and in the innovations, as much again for each
  /// piece of the course, times the share that readings of neighbours have in the mean
  /// square of what those of pieces differ by.
  ///
  /// Of scales, and of axes that hold part of each other, what that noise looks like:
  /// with Q the variance of what an axis adds up to over an interval T between nodes and
  /// y what one more of the size adds to the readings, sum Q over sum |T y|^2 for each
  /// of the axes in y. An axis that hardly turns reads its noise alone.
  double ZOf(const MeanShift& shift) const;

 private:
  /// Between two nodes the rate of turn w less the straight line between those of
  /// the nodes, times the specific force f, over time, in body axes at the first:
  ///   v = int (w - line) x f dt,  p = int v dt.
  struct Bend {
    Eigen::Vector3d v = Eigen::Vector3d::Zero();
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
  };
  /// Of the IMU about an interval that is short against what moves: means of the
  /// readings at both ends, and their rates.
  struct Readings {
    std::pair<Eigen::Vector3d, Eigen::Vector3d> w, f;
    double duration;

    /// What they have too much, by the size of one.
    Eigen::Vector3d MoreBy(const ImuDeviation& one) const;
  };
  /// Over the one that ends at node k.
  Readings ReadingsOver(std::size_t k) const;
  void FollowTurns();
  void FollowNoise();

  struct OfSensor {
    std::vector<Deviation> deviations;
    ErrorLayout layout;          ///< the problem's and the blocks tried
    ParameterVector parameters;  ///< values of the blocks tried
    Eigen::Vector3d origin_e = Eigen::Vector3d::Zero();
    bool has_clock = true;  ///< a shift of it is no shift of a distance's begin
  };
  /// `components` is how many a measurement has at most.
  OfSensor Plan(int sensor, const Measurement& first, int components) const;
  std::vector<ShiftColumns::Columns> Measured(std::size_t k,
                                              const TapeMeasurement& z) const;
  ShiftColumns::Columns Driven(std::size_t k) const;

  const Problem& problem_;
  const std::vector<State>& states_;
  const LinearTape& tape_;
  std::vector<OfSensor> sensors_;
  std::vector<Bend> bends_;  ///< of the interval that ends at a node
  double noise_share_ = 1.0;
  std::vector<double> untold_;  ///< sizes, by column of kImu
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_DEVIATION_COLUMNS_H_
