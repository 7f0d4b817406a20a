#ifndef HINDSIGHT_IO_READ_IMU_PAIR_H_
#define HINDSIGHT_IO_READ_IMU_PAIR_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "io/read/reader.h"

namespace hindsight {

/// Readings of accelerometers that have a file and stamps of their own.
class AccelerometerFile {
 public:
  /// Reads it. Throws InputError as ReadImu does.
  AccelerometerFile(const StreamSource& source,
                    std::vector<PolicyCount>* policies);

  /// On the straight line between the readings on both sides, in the sensor's
  /// axes [m/s^2]; nothing outside the record or in a drop-out. `t` is since
  /// `clock.first` [s]. Throws InputError if one has dates and the other has not.
  std::optional<Eigen::Vector3d> At(double t, const StreamClock& clock);

 private:
  struct Reading {
    double t;  ///< since clock_.first [s]
    Eigen::Vector3d f;
  };
  StreamSource source_;
  StreamClock clock_;
  std::vector<Reading> readings_;
  double longest_ = 0.0;  ///< interval that is no drop-out [s]
  std::size_t next_ = 0;  ///< times ascend
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_IMU_PAIR_H_
