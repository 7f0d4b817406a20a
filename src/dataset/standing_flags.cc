#include "dataset/standing_flags.h"

#include <cmath>
#include <cstddef>
#include <variant>

namespace hindsight {

void ShareErrorsOfStances(std::vector<Measurement>* measurements) {
  constexpr double kHalf = 0.5 * kStanceError;
  std::vector<Measurement>& all = *measurements;
  std::size_t first = 0;
  std::size_t end = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    while (all[i].t - all[first].t > kHalf) ++first;
    while (end < all.size() && all[end].t - all[i].t < kHalf) ++end;
    auto* zero = std::get_if<ZeroVelocity>(&all[i].model);
    if (zero != nullptr) {
      zero->ScaleSigma(std::sqrt(static_cast<double>(end - first)));
    }
  }
}

}  // namespace hindsight
