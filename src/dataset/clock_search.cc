#include "dataset/clock_search.h"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

#include "base/median.h"
#include "base/parallel.h"
#include "dataset/clock_comparison.h"
#include "dataset/clock_turns.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr double kSameMotion = 0.5;  // misfit
constexpr std::size_t kMostCandidates = 8;
constexpr double kStepsPerWindow = 10.0;

ClockCandidate Refine(const ClockComparison& comparison, double from,
                      double to) {
  constexpr int kBits = 20;
  const auto [offset, least] =
      boost::math::tools::brent_find_minima(comparison.misfit, from, to, kBits);
  const double step = 0.5 * (to - from);
  const double curvature = (comparison.misfit(offset - step) +
                            comparison.misfit(offset + step) - 2.0 * least) /
                           (step * step);
  return {offset, std::sqrt(2.0 * least / (comparison.freedom * curvature)),
          least};
}

/// Whether chance would not fit so well: the correlation 1 - misfit/2, by
/// Fisher's transformation, is five standard deviations from none.
bool IsSignificant(const ClockComparison& comparison, const ImuStream& imu,
                   const ClockCandidate& candidate) {
  constexpr double kFiveSigmas = 5.0;
  const double begin =
      std::max(imu.t_begin(), comparison.first + candidate.offset);
  const double end = std::min(imu.t_end(), comparison.last + candidate.offset);
  const double share = (end - begin) / (comparison.last - comparison.first);
  const double n = share * comparison.freedom;
  return n > 3.0 &&
         std::atanh(1.0 - 0.5 * candidate.misfit) * std::sqrt(n - 3.0) >
             kFiveSigmas;
}

/// At `count` offsets, `step` apart.
std::vector<double> MisfitsFrom(const ClockComparison& comparison, double from,
                                double step, std::size_t count) {
  constexpr std::size_t kGrain = 16;
  std::vector<double> misfit(count);
  ForRanges(count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      misfit[i] = comparison.misfit(from + static_cast<double>(i) * step);
    }
  });
  return misfit;
}

/// The median of the misfit over all offsets; infinite where there is none.
double MisfitOfOthers(const ClockComparison& comparison,
                      const OffsetRange& all) {
  constexpr std::size_t kSteps = 200;
  std::vector<double> misfit = MisfitsFrom(
      comparison, all.from, (all.to - all.from) / static_cast<double>(kSteps),
      kSteps + 1);
  std::erase_if(misfit, [](double m) { return !std::isfinite(m); });
  return misfit.empty() ? std::numeric_limits<double>::infinity()
                        : Median(std::move(misfit));
}

/// Within `range`; candidates have misfits below `same`.
ClockSearch Search(const ClockComparison& comparison, const ImuStream& imu,
                   double same, const OffsetRange& range) {
  ClockSearch out;
  out.compared = comparison.compared;
  out.resolution = comparison.resolution;
  out.freedom = comparison.freedom;
  out.misfit = comparison.misfit;
  const double step = comparison.resolution / kStepsPerWindow;
  const double count = std::ceil((range.to - range.from) / step);
  if (!(count >= 2.0)) return out;
  const std::vector<double> misfit = MisfitsFrom(
      comparison, range.from, step, static_cast<std::size_t>(count) + 1);
  std::vector<ClockCandidate> found;
  for (std::size_t i = 1; i + 1 < misfit.size(); ++i) {
    const bool minimum = misfit[i] <= misfit[i - 1] &&
                         misfit[i] < misfit[i + 1] &&
                         std::isfinite(misfit[i - 1] + misfit[i + 1]);
    if (!minimum || misfit[i] > 2.0 * same) continue;
    const double at = range.from + static_cast<double>(i) * step;
    const ClockCandidate refined = Refine(comparison, at - step, at + step);
    if (refined.misfit < same) found.push_back(refined);
  }
  const bool tells = std::any_of(
      found.begin(), found.end(), [&](const ClockCandidate& candidate) {
        return IsSignificant(comparison, imu, candidate);
      });
  if (!tells) return out;
  std::stable_sort(found.begin(), found.end(),
                   [](const ClockCandidate& a, const ClockCandidate& b) {
                     return a.misfit < b.misfit;
                   });
  for (const ClockCandidate& candidate : found) {
    const bool near = std::any_of(
        out.candidates.begin(), out.candidates.end(),
        [&](const ClockCandidate& better) {
          return std::abs(better.offset - candidate.offset) < out.resolution;
        });
    if (near) continue;
    if (out.candidates.size() < kMostCandidates) {
      out.candidates.push_back(candidate);
    } else {
      ++out.left_out;
    }
  }
  return out;
}

}  // namespace

OffsetRange OverlappingOffsets(double a_begin, double a_end, double b_begin,
                               double b_end) {
  const double least = 0.5 * std::min(a_end - a_begin, b_end - b_begin);
  return {a_begin + least - b_end, a_end - least - b_begin};
}

ClockSearch SearchClock(const ImuStream& imu, const InitialState& initial,
                        const AidingStream& stream, OffsetRange range) {
  const auto comparison = CompareStream(imu, initial, stream);
  if (!comparison) return {};
  const OffsetRange all = OverlappingOffsets(
      imu.t_begin(), imu.t_end(), comparison->first, comparison->last);
  // What is free in each piece of the others may fit any smooth motion.
  const SensorKind& kind = *stream.sensor.kind;
  const double same =
      kind.is_position || kind.is_velocity
          ? kSameMotion
          : kSameMotion * std::min(1.0, MisfitOfOthers(*comparison, all));
  return Search(*comparison, imu, same,
                {std::max(all.from, range.from), std::min(all.to, range.to)});
}

ClockSearch SearchClock(const ImuStream& imu, const TruthSeries& truth) {
  constexpr double kKnownClock =
      0.02;  // an offset known worse is not known [s]
  const auto comparison = CompareTurns(imu, truth);
  if (!comparison) return {};
  const OffsetRange all = OverlappingOffsets(
      imu.t_begin(), imu.t_end(), comparison->first, comparison->last);
  ClockSearch found = Search(*comparison, imu, kSameMotion, all);
  std::erase_if(found.candidates, [](const ClockCandidate& candidate) {
    return !(candidate.sigma < kKnownClock);
  });
  return found;
}

bool IsPlausible(const ClockSearch& found, double misfit) {
  constexpr double kFiveSigmas = 5.0;
  return std::log(misfit / found.candidates.front().misfit) <
         kFiveSigmas * 2.0 / std::sqrt(found.freedom);
}

void DropImplausible(ClockSearch* found) {
  const std::size_t before = found->candidates.size();
  const ClockSearch& all = *found;
  std::vector<ClockCandidate> plausible;
  for (const ClockCandidate& candidate : all.candidates) {
    if (IsPlausible(all, candidate.misfit)) plausible.push_back(candidate);
  }
  found->candidates = std::move(plausible);
  // What was left out fits no better.
  if (found->candidates.size() < before) found->left_out = 0;
}

std::vector<std::string> FindAmbiguousClocks(const Dataset& dataset) {
  std::vector<std::string> words;
  for (const AidingStream& stream : dataset.streams) {
    if (!stream.clock_unknown) continue;
    ClockSearch found = SearchClock(dataset.imu, dataset.initial, stream);
    DropImplausible(&found);
    if (found.candidates.size() < 2) continue;
    const auto [first, last] = std::minmax_element(
        found.candidates.begin(), found.candidates.end(),
        [](const ClockCandidate& a, const ClockCandidate& b) {
          return a.offset < b.offset;
        });
    words.push_back(fmt::format(
        "{}: {} time offsets from {:.2f} to {:.2f} s{} fit about as well: "
        "`run` "
        "decides between them, unless time_offset is given",
        stream.sensor.name, found.candidates.size(), first->offset,
        last->offset, found.left_out > 0 ? " and further ones" : ""));
  }
  return words;
}

bool TakeClock(const ClockSearch& found, AidingStream* stream) {
  if (found.candidates.empty()) return false;
  stream->sensor.time_offset = found.candidates.front().offset;
  stream->sensor.time_offset_sigma = found.resolution;
  return true;
}

std::string Describe(const ClockSearch& search) {
  std::string words;
  for (const ClockCandidate& candidate : search.candidates) {
    const std::string sigma =
        std::isfinite(candidate.sigma)
            ? fmt::format("sigma {:.2g} ms", 1e3 * candidate.sigma)
            : "sigma unknown";
    words += fmt::format("{}{:.4f} s, {}, misfit {:.2g}",
                         words.empty() ? "" : "; or ", candidate.offset, sigma,
                         candidate.misfit);
  }
  if (search.left_out > 0) {
    words += "; and " + std::to_string(search.left_out) + " more";
  }
  return words + "; from " + search.compared;
}

}  // namespace hindsight
