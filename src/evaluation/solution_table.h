#ifndef HINDSIGHT_EVALUATION_SOLUTION_TABLE_H_
#define HINDSIGHT_EVALUATION_SOLUTION_TABLE_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "state/solution.h"

namespace hindsight {

/// A trajectory by columns, as evaluation and the writers use it and as a
/// solution file gives it back. A column is as long as `t`, or empty if the
/// quantity does not exist. Frames as in State; without positions there is no
/// place, and e stands for the local north-east-down axes.
struct SolutionTable {
  std::string method;
  std::vector<double> t;             ///< [s], strictly increasing
  std::vector<Eigen::Vector3d> p_e;  ///< [m]
  std::vector<Eigen::Vector3d> v_e;  ///< [m/s]
  std::vector<Eigen::Quaterniond> q_eb;
  std::vector<Eigen::Matrix3d> P_position;  ///< of dr, NED [m^2]
  std::vector<Eigen::Matrix3d> P_velocity;  ///< of dv, NED [m^2/s^2]
  std::vector<Eigen::Matrix3d> P_attitude;  ///< of psi, NED [rad^2]
  /// Of roll, pitch and heading, see EulerSigma [rad].
  std::vector<Eigen::Vector3d> sigma_euler;
  std::vector<Eigen::Vector3d> b_g;           ///< [rad/s]
  std::vector<Eigen::Vector3d> b_a;           ///< [m/s^2]
  std::vector<Eigen::Vector3d> sigma_b_g;     ///< [rad/s]
  std::vector<Eigen::Vector3d> sigma_b_a;     ///< [m/s^2]
  std::vector<double> separation;             ///< see TwoFilterPart
  std::vector<FilterSeparation> separations;  ///< its components
  std::vector<double> accel_sigma;            ///< see AttitudePart
  std::vector<signed char> magnetic;          ///< see AttitudePart

  std::size_t size() const { return t.size(); }
  /// NED axes at row k; identity without positions.
  Eigen::Matrix3d C_en(std::size_t k) const;
  /// Body to NED at row k. Requires attitudes.
  Eigen::Quaterniond q_nb(std::size_t k) const;
};

/// The columns of a solution: those whose block the layout estimates, and
/// their covariances where no axis of the block is masked.
SolutionTable TableFromSolution(const Solution& solution);
/// The same of its states from `begin` to before `end`.
SolutionTable TableFromSolution(const Solution& solution, std::size_t begin,
                                std::size_t end);

/// Some rows of a table, by their numbers.
SolutionTable RowsOf(const SolutionTable& table,
                     const std::vector<std::size_t>& rows);

/// Adds the rows of `piece`, which has the columns of `table` and is later.
void AppendTable(const SolutionTable& piece, SolutionTable* table);

/// A table as a reference trajectory.
TruthSeries TruthFromTable(const SolutionTable& table);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_SOLUTION_TABLE_H_
