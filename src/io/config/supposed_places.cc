#include "io/config/supposed_places.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

bool IsPosition(const FoundStream& found) {
  return !found.truth && !found.kinds.empty() &&
         found.kinds.front()->is_position;
}

/// Of formats whose places are not read beforehand, all are far from what only
/// seems a place.
bool AreFarApart(const FoundStream& a, const FoundStream& b) {
  constexpr double kFar = 0.05;  // rad, 300 km
  if (!a.place) return false;
  if (!b.place) return true;
  const double east = std::remainder(a.place->lon - b.place->lon, 2.0 * kPi) *
                      std::cos(b.place->lat);
  return std::hypot(a.place->lat - b.place->lat, east) > kFar;
}

/// The stream that speaks against `found`; nullptr if there is none.
const FoundStream* Against(const FoundStream& found, bool of_imu,
                           const std::vector<FoundStream>& others) {
  if (!IsPosition(found) || found.place_order_told) return nullptr;
  const auto at =
      std::find_if(others.begin(), others.end(), [&](const FoundStream& other) {
        return other.file != found.file && IsPosition(other) &&
               (other.place_order_told || of_imu) && AreFarApart(found, other);
      });
  return at == others.end() ? nullptr : &*at;
}

}  // namespace

std::vector<FoundStream> TakeSupposedPlaces(const std::string& imu_file,
                                            std::vector<FoundStream>* others) {
  std::vector<FoundStream> kept;
  std::vector<FoundStream> taken;
  for (const FoundStream& found : *others) {
    const FoundStream* other = Against(found, found.file == imu_file, *others);
    (other == nullptr ? kept : taken).push_back(found);
    if (other == nullptr) continue;
    taken.back().remarks.push_back(
        "its numbers are within the ranges of places, but not where " +
        other->file + " was recorded");
  }
  *others = std::move(kept);
  return taken;
}

}  // namespace hindsight
