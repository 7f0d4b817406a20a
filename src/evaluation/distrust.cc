#include "evaluation/distrust.h"

#include <fmt/core.h>

#include <algorithm>
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

/// Past the last measurement of the stretch of distrust that begins at `begin`:
/// as many trusted ones in a row as judge it follow it, or the end.
std::size_t EndOf(const std::vector<const ResidualRecord*>& all,
                  std::size_t begin) {
  std::size_t end = begin;
  for (std::size_t i = begin; i < all.size() && i < end + kBeside; ++i) {
    if (!IsTrusted(*all[i])) end = i + 1;
  }
  return end;
}

/// Whether other sensors of position were trusted between two times, and never
/// longer not than a stretch of distrust is borne.
bool IsVouched(const Judged& judged, int sensor, double from, double to) {
  std::vector<double> times = {from, to};
  for (const ResidualRecord& record : judged.solution.residuals) {
    if (record.sensor == sensor || record.withheld || !IsTrusted(record) ||
        record.t < from || record.t > to) {
      continue;
    }
    const auto i = static_cast<std::size_t>(record.sensor);
    if (judged.sensors[i].kind->places) times.push_back(record.t);
  }
  std::sort(times.begin(), times.end());
  return std::adjacent_find(times.begin(), times.end(),
                            [](double before, double after) {
                              return after - before > kLeastDistrustedSpan;
                            }) == times.end();
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
    if (IsTrusted(*all[begin])) {
      ++begin;
      continue;
    }
    const std::size_t end = EndOf(all, begin);
    const auto count = static_cast<std::size_t>(std::count_if(
        all.begin() + static_cast<std::ptrdiff_t>(begin),
        all.begin() + static_cast<std::ptrdiff_t>(end),
        [](const ResidualRecord* one) { return !IsTrusted(*one); }));
    if (count >= kLeastDistrusted && 2 * count >= end - begin &&
        begin >= kBeside && end + kBeside <= all.size()) {
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
    begin = end;
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
    const ErrorLayout& layout = judged.solution.layout;
    if (layout.Has(BlockKind::kColouredNoise, sensor) ||
        layout.Has(BlockKind::kSensorError, sensor)) {
      continue;
    }
    FindOf(judged, sensor, all[i], evidence);
  }
}

}  // namespace hindsight
