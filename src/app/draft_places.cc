#include "app/draft_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "dataset/clock_search.h"
#include "dataset/gyro_unit.h"

namespace hindsight {
namespace {

/// How well positions fit the IMU's motion.
struct PlaceFit {
  /// As of ClockCandidate: where their clock stands if that shows, else wherever it
  /// is best near where the stamps say.
  double misfit = std::numeric_limits<double>::infinity();
  double freedom = 0.0;
  bool turns_with_gyros = false;  ///< CourseOverGyros
};

PlaceFit FitOf(const Dataset* dataset, const std::string& name) {
  constexpr double kFarthest = 1.0;  // s
  constexpr int kSteps = 10;
  if (dataset == nullptr) return {};
  const auto stream = std::find_if(
      dataset->streams.begin(), dataset->streams.end(),
      [&](const AidingStream& s) { return s.sensor.name == name; });
  if (stream == dataset->streams.end()) return {};
  const ClockSearch search =
      SearchClock(dataset->imu, dataset->initial, *stream);
  PlaceFit fit;
  fit.freedom = search.freedom;
  fit.turns_with_gyros = CourseOverGyros(*dataset).value_or(0.0) > 0.0;
  if (!search.candidates.empty()) {
    fit.misfit = search.candidates.front().misfit;
  }
  for (int i = -kSteps; search.misfit && i <= kSteps; ++i) {
    fit.misfit = std::min(fit.misfit, search.misfit(kFarthest * i / kSteps));
  }
  return fit;
}

/// Whether one misfit is below another by more than chance: the logarithm of their
/// ratio has the variance 4/n at most (IsPlausible); or at all, where the course
/// turns with the gyros in that reading alone.
bool IsBetter(const PlaceFit& a, const PlaceFit& b) {
  constexpr double kSigmas = 5.0;
  if (!std::isfinite(a.misfit) || a.freedom <= 0.0) return false;
  const double gain = std::log(b.misfit / a.misfit);
  return gain > kSigmas * 2.0 / std::sqrt(a.freedom) ||
         (gain > 0.0 && a.turns_with_gyros && !b.turns_with_gyros);
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
    if (told || FindLine(lines, "  lat") == nullptr) continue;
    PlaceFit best = FitOf(load(), stream.name);
    std::vector<KeyLine> chosen = lines;
    bool turned = false;
    for (const auto& [swapped, radians] :
         {std::pair(false, true), {true, false}, {true, true}}) {
      if ((swapped && stream.found.place_order_told) ||
          (radians && stream.found.place_unit_told)) {
        continue;
      }
      stream.found.lines = Otherwise(lines, swapped, radians);
      const PlaceFit fit = FitOf(load(), stream.name);
      if (!IsBetter(fit, best)) continue;
      best = fit;
      chosen = stream.found.lines;
      turned = swapped;
    }
    stream.found.lines = chosen;
    if (turned) {
      draft->Assume(stream.name +
                    ": the longitude is taken to stand before the latitude, "
                    "as it fits the gyros; with the other sign of these the "
                    "other order would");
    }
  }
}

}  // namespace hindsight
