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
  /// Its mean_force_b points up, of a vehicle that keeps upright.
  ReadingFacts record;
};

/// Of the recording, which has two samples at least.
ImuReport ReportImu(const Dataset& dataset, const RestMemo& rests);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_IMU_REPORT_H_
