#include "evaluation/distrust.h"

#include <fmt/core.h>

#include <cstddef>

#include "base/chi_square.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr std::size_t kLeastDistrusted = 11;   // measurements
constexpr double kLeastDistrustedSpan = 10.0;  // [s]
constexpr double kDistrustedWeight = 0.1;
constexpr std::size_t kBeside = 5;

bool IsTrusted(const ResidualRecord& record) {
  return record.accepted && record.weight >= kDistrustedWeight;
}

/// Whether the measurements first to past the last agree with the solution.
bool Agree(const std::vector<const ResidualRecord*>& all, std::size_t begin,
           std::size_t end) {
  constexpr double kQuantile = 0.999;
  if (end - begin < kBeside) return false;
  double nis = 0.0;
  int rows = 0;
  for (std::size_t i = begin; i < end; ++i) {
    if (!IsTrusted(*all[i])) return false;
    nis += all[i]->nis;
    rows += static_cast<int>(all[i]->residual.size());
  }
  return nis < ChiSquareQuantile(kQuantile, rows);
}

/// Whether another sensor of position was trusted between two times.
bool IsVouched(const Judged& judged, int sensor, double from, double to) {
  for (const ResidualRecord& record : judged.solution.residuals) {
    if (record.sensor == sensor || record.withheld || !IsTrusted(record) ||
        record.t < from || record.t > to) {
      continue;
    }
    const auto i = static_cast<std::size_t>(record.sensor);
    if (judged.sensors[i].kind->places) return true;
  }
  return false;
}

Evidence Distrust(const std::string& name, std::size_t count, double from,
                  double to) {
  return {
      .grade = Grade::kDoubtful,
      .what = fmt::format(
          "{} measurements of {} were distrusted from {:.1f} s to {:.1f} s, "
          "which agreed with everything else before and after",
          count, name, from, to),
      .value = to - from,
      .limit = kLeastDistrustedSpan,
      .unit = "s",
      .t_begin = from,
      .t_end = to,
      .causes = {"an error of " + name + " meanwhile",
                 "an error of what else the solution rests on, as a "
                 "disturbed field"},
      .remedies = {"'--without' each of the other sensors in turn"},
      .better_methods = {"robust_batch"}};
}

void FindOf(const Judged& judged, int sensor,
            const std::vector<const ResidualRecord*>& all,
            std::vector<Evidence>* evidence) {
  for (std::size_t begin = 0; begin < all.size();) {
    std::size_t end = begin;
    while (end < all.size() && !IsTrusted(*all[end])) ++end;
    const std::size_t count = end - begin;
    if (count >= kLeastDistrusted && begin >= kBeside &&
        end + kBeside <= all.size()) {
      const double from = all[begin]->t;
      const double to = all[end - 1]->t;
      if (to - from > kLeastDistrustedSpan &&
          Agree(all, begin - kBeside, begin) &&
          Agree(all, end, end + kBeside) &&
          !IsVouched(judged, sensor, from, to)) {
        evidence->push_back(
            Distrust(judged.sensors[static_cast<std::size_t>(sensor)].name,
                     count, from, to));
        return;
      }
    }
    begin = end + 1;
  }
}

}  // namespace

void FindDistrusted(const Judged& judged, std::vector<Evidence>* evidence) {
  std::vector<std::vector<const ResidualRecord*>> all(judged.sensors.size());
  for (const ResidualRecord& record : judged.solution.residuals) {
    if (record.withheld) continue;
    if (static_cast<std::size_t>(record.sensor) >= all.size()) return;
    all[static_cast<std::size_t>(record.sensor)].push_back(&record);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int sensor = static_cast<int>(i);
    if (judged.solution.layout.Has(BlockKind::kColouredNoise, sensor)) continue;
    FindOf(judged, sensor, all[i], evidence);
  }
}

}  // namespace hindsight
