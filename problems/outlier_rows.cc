#include "problems/outlier_rows.h"

#include <fmt/core.h>

#include <cstddef>
#include <string>
#include <vector>

#include "base/gap.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

Evidence DoubtOfLast(const std::string& name, double t) {
  return {.grade = Grade::kDoubtful,
          .what = fmt::format(
              "the last fix of {}, at {:.1f} s, is taken for an "
              "outlier: no other sensor still tells positions or velocities "
              "there, but for what is an outlier as well, and nothing behind "
              "it whether it is the fixes before that have drifted away",
              name, t),
          .t_begin = t,
          .t_end = t,
          .causes = {"an outlier, or an error that grows more slowly than the "
                     "IMU shows, and ends"},
          .remedies = {"a position that is known at the end"}};
}

std::vector<double> SpacingsOf(std::span<const TakenFix> fixes) {
  std::vector<double> spacings;
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    spacings.push_back(fixes[i].t - fixes[i - 1].t);
  }
  return spacings;
}

/// Whether measurements tell at the time t, to which their last is near and no outlier.
bool StillTell(std::span<const TakenFix> fixes, double t) {
  return !fixes.empty() && !fixes.back().outlier &&
         fixes.back().t >= t - LongestSpacingWithoutGap(SpacingsOf(fixes));
}

}  // namespace

RowAtGap LongestRowAtGap(std::span<const TakenFix> fixes) {
  const std::vector<double> spacings = SpacingsOf(fixes);
  const double gap = LongestSpacingWithoutGap(spacings);
  RowAtGap longest;
  for (std::size_t begin = 0; begin < fixes.size();) {
    std::size_t end = begin + 1;
    while (end < fixes.size() && fixes[end].outlier == fixes[begin].outlier &&
           spacings[end - 1] <= gap) {
      ++end;
    }
    const bool at_gap = begin == 0 || end == fixes.size() ||
                        spacings[begin - 1] > gap || spacings[end - 1] > gap;
    const auto count = static_cast<int>(end - begin);
    if (fixes[begin].outlier && at_gap && count > longest.count) {
      longest = {fixes[begin].t, fixes[end - 1].t, count};
    }
    begin = end;
  }
  return longest;
}

void DoubtOutliersAtGaps(const Timeline& timeline,
                         const std::vector<ResidualRecord>& residuals,
                         std::vector<Evidence>* doubts) {
  constexpr double kOutlier = 0.5;  // weight
  constexpr int kLeast = 2;
  std::vector<std::vector<TakenFix>> fixes(timeline.sensors().size());
  for (const ResidualRecord& r : residuals) {
    if (r.withheld || !r.accepted) continue;
    fixes[static_cast<std::size_t>(r.sensor)].push_back(
        {r.t, r.weight < kOutlier});
  }
  const auto still_tells = [&](std::size_t i, double t) {
    const SensorKind& kind = *timeline.sensors()[i].kind;
    return (kind.is_position || kind.moves) && StillTell(fixes[i], t);
  };
  const auto any_still_tells = [&](double t) {
    for (std::size_t i = 0; i < fixes.size(); ++i) {
      if (still_tells(i, t)) return true;
    }
    return false;
  };
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const Sensor& sensor = timeline.sensors()[i];
    if (!sensor.kind->is_position || fixes[i].empty()) continue;
    const TakenFix& last = fixes[i].back();
    if (last.outlier && !any_still_tells(last.t)) {
      doubts->push_back(DoubtOfLast(sensor.name, last.t));
    }
    const RowAtGap row = LongestRowAtGap(fixes[i]);
    if (row.count < kLeast) continue;
    doubts->push_back(
        {.grade = Grade::kDoubtful,
         .what = fmt::format("{} fixes of {} in a row, from {:.1f} to {:.1f} s "
                             "next to a gap, are taken for outliers",
                             row.count, sensor.name, row.begin, row.end),
         .value = static_cast<double>(row.count),
         .limit = static_cast<double>(kLeast),
         .unit = "fixes",
         .causes = {"outliers at the edge of an outage, or fixes that were off "
                    "before it"},
         .remedies = {"a position that is known there"}});
  }
}

}  // namespace hindsight
