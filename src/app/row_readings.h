#ifndef HINDSIGHT_APP_ROW_READINGS_H_
#define HINDSIGHT_APP_ROW_READINGS_H_

#include <cstddef>
#include <map>
#include <vector>

#include "imu/imu_stream.h"
#include "imu/kinematics.h"

namespace hindsight {

/// MeanReadings about the rows of several methods' output, which mostly have the same
/// times: those of the first are kept, up to some hundred thousand.
class RowReadings {
 public:
  /// `imu` must outlive the object.
  explicit RowReadings(const ImuStream& imu) : imu_(imu) {}

  std::vector<Kinematics> Of(const std::vector<double>& times);

 private:
  struct Piece {
    std::vector<double> times;
    std::vector<Kinematics> means;
  };

  const ImuStream& imu_;
  std::map<double, Piece> pieces_;  ///< by their first time
  std::size_t rows_ = 0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_APP_ROW_READINGS_H_
