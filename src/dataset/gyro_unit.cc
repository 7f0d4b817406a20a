#include "dataset/gyro_unit.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <tuple>
#include <vector>

#include "base/units.h"
#include "dataset/row_rate.h"

namespace hindsight {

std::string WarnAboutGyroUnit(const ImuStream& stream) {
  const bool rates = stream.kind == ImuStream::Kind::kRates;
  const double span = stream.t_end() - stream.t_begin();
  if (!rates || span <= 0.0) return "";
  std::vector<Eigen::Vector3d> f;
  std::vector<Eigen::Vector3d> w;
  constexpr std::size_t kMost = 20'000;
  const std::size_t rows = std::min(stream.samples.size(), kMost);
  for (std::size_t k = 0; k < rows; ++k) {
    f.emplace_back(stream.samples[k].accel / kStandardGravity);
    w.emplace_back(stream.samples[k].gyro);
  }
  const GravityBalance balance(f, w);
  if (balance.spans().size() < kFewestBalanced) return "";
  const double rate = static_cast<double>(stream.samples.size() - 1) / span;
  const double never = balance.Squares(std::numeric_limits<double>::infinity());
  const double least = kMostUnbalanced * std::min(never, balance.Squares(rate));
  for (const auto& [factor, said, meant] :
       {std::tuple(kDegree, "rad/s", "deg/s"),
        std::tuple(1.0 / kDegree, "deg/s", "rad/s")}) {
    if (balance.Squares(rate / factor) > least) continue;
    return fmt::format(
        "imu: gravity turns {:.3g} times as far as the gyros say: they look "
        "like {}, declared as {}; correct the unit of gyro_x, gyro_y, gyro_z "
        "under `columns`",
        factor, meant, said);
  }
  return "";
}

}  // namespace hindsight
