#include "app/draft_places.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "dataset/clock_search.h"

namespace hindsight {
namespace {

bool Fits(const Dataset* dataset, const std::string& name) {
  if (dataset == nullptr) return false;
  const auto stream = std::find_if(
      dataset->streams.begin(), dataset->streams.end(),
      [&](const AidingStream& s) { return s.sensor.name == name; });
  return stream != dataset->streams.end() &&
         !SearchClock(dataset->imu, dataset->initial, *stream)
              .candidates.empty();
}

/// The two lines read in another way; as they are where that is none.
std::vector<KeyLine> Otherwise(std::vector<KeyLine> lines, bool swapped,
                               bool radians) {
  KeyLine lat = *FindLine(lines, "  lat");
  KeyLine lon = *FindLine(lines, "  lon");
  if (swapped) std::swap(lat.value, lon.value);
  for (KeyLine* line : {&lat, &lon}) {
    const std::string unit = "[deg]";
    const std::size_t at = line->value.find(unit);
    if (radians && at != std::string::npos) {
      line->value.replace(at, unit.size(), "[rad]");
    }
    line->comment =
        "otherwise the motion does not fit that of the IMU (likely)";
    SetLine(*line, &lines);
  }
  return lines;
}

}  // namespace

void TellPlaces(const std::function<const Dataset*()>& load,
                RecordingDraft* draft) {
  for (StreamDraft& stream : draft->aiding) {
    const std::vector<KeyLine> lines = stream.found.lines;
    const bool told =
        stream.found.place_unit_told && stream.found.place_order_told;
    if (told || FindLine(lines, "  lat") == nullptr ||
        Fits(load(), stream.name)) {
      continue;
    }
    bool found = false;
    for (const auto& [swapped, radians] :
         {std::pair(false, true), {true, false}, {true, true}}) {
      if ((swapped && stream.found.place_order_told) ||
          (radians && stream.found.place_unit_told)) {
        continue;
      }
      stream.found.lines = Otherwise(lines, swapped, radians);
      found = Fits(load(), stream.name);
      if (found && swapped) {
        draft->Assume(stream.name +
                      ": the longitude is taken to stand before the latitude, "
                      "as it fits the gyros; with the other sign of these the "
                      "other order would");
      }
      if (found) break;
    }
    if (!found) stream.found.lines = lines;
  }
}

}  // namespace hindsight
