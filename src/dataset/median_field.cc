#include "dataset/median_field.h"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "base/median.h"

namespace hindsight {

std::optional<MedianField> FindMedianField(const ImuStream& imu,
                                           const AidingStream& stream) {
  const PagedVector<ImuSample>& samples = imu.samples;
  std::vector<double> down;
  std::vector<double> horizontal;
  std::size_t next = 0;
  for (const Measurement& z : stream.measurements) {
    const auto* field = std::get_if<MagneticField>(&z.model);
    while (next + 1 < samples.size() && samples[next].t < z.t) ++next;
    if (field == nullptr) continue;
    const Eigen::Vector3d& m = field->field_b;
    const double up = m.dot(samples[next].accel.normalized());
    down.push_back(-up);
    horizontal.push_back(std::sqrt(std::max(0.0, m.squaredNorm() - up * up)));
  }
  if (down.empty()) return std::nullopt;
  return MedianField{Median(std::move(horizontal)), Median(std::move(down))};
}

}  // namespace hindsight
