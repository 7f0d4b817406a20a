#include "measurements/standing_flags.h"

#include <cmath>
#include <cstddef>
#include <variant>

namespace hindsight {

void ShareErrorsOfStances(MeasurementSeries* measurements) {
  constexpr double kHalf = 0.5 * kStanceError;
  const MeasurementSeries& all = *measurements;
  std::size_t first = 0;
  std::size_t end = 0;
  for (Measurement& z : measurements->Edited()) {
    while (z.t - all[first].t > kHalf) ++first;
    while (end < all.size() && all[end].t - z.t < kHalf) ++end;
    auto* zero = std::get_if<ZeroVelocity>(&z.model);
    if (zero != nullptr) {
      zero->ScaleSigma(std::sqrt(static_cast<double>(end - first)));
    }
  }
}

}  // namespace hindsight
