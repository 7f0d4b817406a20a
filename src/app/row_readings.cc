#include "app/row_readings.h"

#include <utility>

#include "imu/mean_reading.h"

namespace hindsight {

std::vector<Kinematics> RowReadings::Of(const std::vector<double>& times) {
  constexpr std::size_t kMostRows = 200'000;
  if (times.empty()) return {};
  const auto known = pieces_.find(times.front());
  if (known != pieces_.end() && known->second.times == times) {
    return known->second.means;
  }
  std::vector<Kinematics> means = MeanReadings(imu_, times);
  if (known == pieces_.end() && rows_ + times.size() <= kMostRows) {
    rows_ += times.size();
    pieces_.emplace(times.front(), Piece{times, means});
  }
  return means;
}

}  // namespace hindsight
