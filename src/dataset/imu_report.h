#ifndef HINDSIGHT_DATASET_IMU_REPORT_H_
#define HINDSIGHT_DATASET_IMU_REPORT_H_

#include <Eigen/Core>
#include <optional>

#include "dataset/dataset.h"
#include "dataset/rest.h"

namespace hindsight {

/// What the IMU reads, in body axes forward-right-down.
struct ImuReport {
  Rest rest;
  /// Mean over rest.at_rest; absent if the vehicle never stands.
  std::optional<Eigen::Vector3d> rest_force;  ///< [m/s^2]
  std::optional<Eigen::Vector3d> rest_rate;   ///< [rad/s]
  /// Mean over all spans of `rest`; absent if there are none.
  std::optional<Eigen::Vector3d> still_force;  ///< [m/s^2]
  /// Mean over the second in which the specific force varies least.
  Eigen::Vector3d quietest_force = Eigen::Vector3d::Zero();  ///< [m/s^2]
  /// Mean over the record, in body axes: up, of a vehicle that keeps upright.
  Eigen::Vector3d mean_force_b = Eigen::Vector3d::Zero();  ///< [m/s^2]
  double mean_force = 0.0;  ///< mean |f| over the record [m/s^2]
  double max_force = 0.0;   ///< [m/s^2]
  double max_rate = 0.0;    ///< [rad/s]
};

/// Of the recording, which has two samples at least.
ImuReport ReportImu(const Dataset& dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_IMU_REPORT_H_
