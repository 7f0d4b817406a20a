#include "evaluation/refusals.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr std::size_t kLongRun = 10;  // measurements
constexpr double kLongSpan = 10.0;    // [s]
constexpr double kVanished = 0.25;
constexpr double kLittleWeight = 0.1;

bool GivesPosition(const Sensor& sensor) { return sensor.kind->places; }

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

bool IsWeightless(const ResidualRecord& record, bool weighs_by_modes) {
  return !weighs_by_modes && record.weight < kLittleWeight;
}

void Count(const ResidualRecord& record, bool weightless, Tally* tally) {
  ++tally->all;
  if (!record.accepted) ++tally->rejected;
  if (record.accepted && weightless) ++tally->weightless;
  if (!record.accepted || weightless) {
    if (tally->run.nis.empty()) tally->run.t_begin = record.t;
    tally->run.t_end = record.t;
    tally->run.nis.push_back(record.nis);
    return;
  }
  if (tally->run.nis.empty()) return;
  if (record.nis < kVanished * tally->run.MeanOfLast()) tally->run = {};
  EndRun(tally);
}

Evidence ShutOut(const std::string& what, const std::string& name) {
  return {.grade = Grade::kUnusable,
          .what = what,
          .causes = {"a sign, unit, clock or lever arm of " + name,
                     "a solution that had gone astray before"},
          .remedies = {"a larger sigma of " + name +
                       ", or its loss or gate taken off"}};
}

std::optional<Evidence> Refusal(const Sensor& sensor, const Tally& tally) {
  const char* name = sensor.name.c_str();
  const auto share = [&tally](int part) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(tally.all);
  };
  if (2 * tally.rejected > tally.all) {
    Evidence e =
        ShutOut(fmt::format("the gate refused {} of {} measurements of {}",
                            tally.rejected, tally.all, name),
                sensor.name);
    e.value = share(tally.rejected);
    e.limit = 50.0;
    e.unit = "%";
    return e;
  }
  if (2 * tally.weightless > tally.all) {
    Evidence e = ShutOut(
        fmt::format(
            "the loss left {} of {} measurements of {} less than a tenth of "
            "their weight",
            tally.weightless, tally.all, name),
        sensor.name);
    e.value = share(tally.weightless);
    e.limit = 50.0;
    e.unit = "%";
    return e;
  }
  if (!tally.worst.nis.empty()) {
    const Refused& run = tally.worst;
    Evidence e = ShutOut(
        fmt::format(
            "{} {} measurements of {} in a row{}, from {:.1f} s to {:.1f} s",
            tally.rejected > 0 ? "the gate refused" : "the loss left",
            run.nis.size(), name,
            tally.rejected > 0 ? "" : " less than a tenth of their weight",
            run.t_begin, run.t_end),
        sensor.name);
    e.value = run.t_end - run.t_begin;
    e.limit = kLongSpan;
    e.unit = "s";
    e.t_begin = run.t_begin;
    e.t_end = run.t_end;
    return e;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Evidence> FindRefusal(std::span<const Sensor> sensors,
                                    const Solution& solution) {
  std::vector<Tally> tallies(sensors.size());
  for (const ResidualRecord& record : solution.residuals) {
    if (record.withheld) continue;
    const auto i = static_cast<std::size_t>(record.sensor);
    const bool weightless = IsWeightless(record, solution.modes.has_value());
    Count(record, weightless, &tallies[i]);
    if (!record.accepted || weightless || !GivesPosition(sensors[i])) continue;
    for (std::size_t j = 0; j < sensors.size(); ++j) {
      if (j != i && !tallies[j].run.nis.empty()) {
        tallies[j].run.vouched = true;
      }
    }
  }
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (std::ranges::count(solution.left_out, static_cast<int>(i)) > 0)
      continue;
    EndRun(&tallies[i]);
    auto found = Refusal(sensors[i], tallies[i]);
    if (found) return found;
  }
  return std::nullopt;
}

}  // namespace hindsight
