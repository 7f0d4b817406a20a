#include "problems/refusals.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <numeric>

namespace hindsight {
namespace {

constexpr std::size_t kLongRun = 10;  // measurements
constexpr double kLongSpan = 10.0;    // [s]
constexpr double kVanished = 0.25;
constexpr double kLittleWeight = 0.1;

bool GivesPosition(const Sensor& sensor) {
  return sensor.type == SensorType::kPosition ||
         sensor.type == SensorType::kAcousticFix;
}

/// Refusals of one sensor in a row.
struct Refused {
  double t_begin = 0.0;
  double t_end = 0.0;
  std::vector<double> nis;
  bool vouched = false;  ///< by another sensor of position

  bool IsLong() const {
    return nis.size() > kLongRun && t_end - t_begin > kLongSpan && !vouched;
  }
  double MeanOfLast() const {
    const std::size_t count = std::min(nis.size(), kLongRun);
    return std::accumulate(nis.end() - static_cast<std::ptrdiff_t>(count),
                           nis.end(), 0.0) /
           static_cast<double>(count);
  }
};

struct Tally {
  int all = 0;
  int rejected = 0;
  int weightless = 0;
  Refused run;
  Refused worst;  ///< the longest that speaks against the solution
};

void EndRun(Tally* tally) {
  if (tally->run.IsLong() && tally->run.nis.size() > tally->worst.nis.size()) {
    tally->worst = tally->run;
  }
  tally->run = {};
}

void Count(const ResidualRecord& record, Tally* tally) {
  ++tally->all;
  if (!record.accepted) {
    ++tally->rejected;
    if (tally->run.nis.empty()) tally->run.t_begin = record.t;
    tally->run.t_end = record.t;
    tally->run.nis.push_back(record.nis);
    return;
  }
  if (record.weight < kLittleWeight) ++tally->weightless;
  if (tally->run.nis.empty()) return;
  if (record.nis < kVanished * tally->run.MeanOfLast()) tally->run = {};
  EndRun(tally);
}

std::string MostOf(const char* format, int part, int all,
                   const std::string& name) {
  char text[240];
  std::snprintf(text, sizeof(text), format, part, all, name.c_str());
  return text;
}

std::string Refusal(const Sensor& sensor, const Tally& tally,
                    bool weighs_by_modes) {
  if (2 * tally.rejected > tally.all) {
    return MostOf("the gate refused %d of %d measurements of %.120s",
                  tally.rejected, tally.all, sensor.name);
  }
  if (!tally.worst.nis.empty()) {
    char text[240];
    std::snprintf(text, sizeof(text),
                  "the gate refused %zu measurements of %.120s in a row, from "
                  "%.1f s to %.1f s",
                  tally.worst.nis.size(), sensor.name.c_str(),
                  tally.worst.t_begin, tally.worst.t_end);
    return text;
  }
  if (!weighs_by_modes && 2 * tally.weightless > tally.all) {
    return MostOf(
        "the loss left %d of %d measurements of %.120s less than a tenth of "
        "their weight",
        tally.weightless, tally.all, sensor.name);
  }
  return "";
}

}  // namespace

std::string FindRefusal(const std::vector<Sensor>& sensors,
                        const Solution& solution) {
  std::vector<Tally> tallies(sensors.size());
  for (const ResidualRecord& record : solution.residuals) {
    if (record.withheld) continue;
    const auto i = static_cast<std::size_t>(record.sensor);
    Count(record, &tallies[i]);
    if (!record.accepted || !GivesPosition(sensors[i])) continue;
    for (std::size_t j = 0; j < sensors.size(); ++j) {
      if (j != i && !tallies[j].run.nis.empty()) {
        tallies[j].run.vouched = true;
      }
    }
  }
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    EndRun(&tallies[i]);
    const std::string why =
        Refusal(sensors[i], tallies[i], !solution.mode_names.empty());
    if (!why.empty()) return why;
  }
  return "";
}

}  // namespace hindsight
