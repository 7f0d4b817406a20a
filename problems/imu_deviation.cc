#include "problems/deviation_columns.h"

namespace hindsight {

Eigen::Vector3d ImuDeviation::Of(const Eigen::Vector3d& reading,
                                 const Eigen::Vector3d& rate) const {
  Eigen::Vector3d more = Eigen::Vector3d::Zero();
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  switch (kind) {
    case Kind::kScale:
      more(axis) = reading(axis);
      break;
    case Kind::kExchanged:
      more(next) = reading(next) - reading(last);
      more(last) = -more(next);
      break;
    case Kind::kTurned:
      more = Eigen::Vector3d::Unit(axis).cross(reading);
      break;
    case Kind::kLate:
      more = -rate;
      break;
  }
  return more;
}

std::span<const ImuDeviation> ImuDeviations() {
  using enum ImuDeviation::Kind;
  static constexpr ImuDeviation kAll[] = {
      {kScale, true, 0},      {kScale, true, 1},      {kScale, true, 2},
      {kScale, false, 0},     {kScale, false, 1},     {kScale, false, 2},
      {kExchanged, true, 0},  {kExchanged, true, 1},  {kExchanged, true, 2},
      {kExchanged, false, 0}, {kExchanged, false, 1}, {kExchanged, false, 2},
      {kTurned, false, 0},    {kTurned, false, 1},    {kTurned, false, 2},
      {kLate, true, 0},
  };
  return kAll;
}

}  // namespace hindsight
