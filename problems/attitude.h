#ifndef HINDSIGHT_PROBLEMS_ATTITUDE_H_
#define HINDSIGHT_PROBLEMS_ATTITUDE_H_

#include <atomic>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "alignment/attitude_start.h"
#include "dataset/dataset.h"
#include "filters/attitude_run.h"
#include "problems/attitude_batch.h"
#include "problems/attitude_samples.h"
#include "problems/field_survey.h"
#include "state/solution.h"

namespace hindsight {

struct AttitudeOptions {
  double from = -std::numeric_limits<double>::infinity();  ///< [s]
  double to = std::numeric_limits<double>::infinity();     ///< [s]
  std::function<void(const std::string& stage, double fraction)> progress;
  const std::atomic<bool>* stop = nullptr;  ///< polled; throws Interrupted
};

/// One recording, its attitude alone estimated from an IMU and, if there is
/// one, a magnetometer; no position is needed. Solutions have the layout
/// {attitude, gyro bias}, one state an IMU sample, and are given at the stamps
/// of the file (ImuStream::stamp_offset).
///   Smoother and batch know the field of the whole recording, and a magnet
///   that
/// travels along, from a survey about gyros and accelerometers alone
/// (field_survey.h), and take the field as a vector, a reading with the weight
/// that the survey gave it.
///   Batch: the inertial navigation problem of the same samples
///   (Reconstruction)
/// with only the knowledge that the body stays in a room,
///   p = 0 +- room, v = 0 +- room_speed once a correlation time,
/// which makes the linear acceleration an unknown that must integrate to
/// little, where a tilt filter has to call it noise.
///   Tilt batch: attitude and gyro bias alone, as in the smoother
/// (tilt_batch.h).
class AttitudeEstimation {
 public:
  /// `dataset` must outlive the object.
  AttitudeEstimation(const Dataset& dataset, AttitudeOptions options);

  /// By a method of Methods() for attitude alone; throws InputError for another
  /// name, EstimationError, Interrupted.
  Solution Run(const std::string& name);

  /// The methods themselves, without verdict and name.
  Solution Filter();
  Solution Smoother();
  Solution RoomBatch();
  Solution TiltBatch();

 private:
  /// At every sample, from the nodes of the filter's updates.
  Solution Smooth(const ImuStream& imu,
                  std::span<const MagneticSample> magnetic,
                  const AttitudeFilterOptions& options,
                  const std::string& stage) const;
  Solution WithReadings(Solution solution) const;
  RoomProblem SurveyedProblem();
  void Level();
  void Survey();
  ImuStream WithAveragedForce() const;
  void Poll(const std::string& stage, double fraction) const;

  const Dataset& dataset_;
  AttitudeOptions options_;
  ImuStream imu_;  ///< of the asked interval, rates
  std::vector<MagneticSample> magnetic_;
  AttitudeFilterOptions filter_options_;
  AttitudeState start_;
  /// Gyros and accelerometers alone, turned to the surveyed field.
  std::optional<Solution> level_;
  std::vector<SurveyedField> readings_;
  FieldSurvey survey_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ATTITUDE_H_
