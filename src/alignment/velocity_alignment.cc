#include "alignment/velocity_alignment.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "alignment/alignment_window.h"
#include "alignment/levelling.h"

namespace hindsight {
namespace {

constexpr double kWellKnown = 0.5 * kDegree;
constexpr double kFirstWindow = 10.0;  // [s]
constexpr double kLongestWindow = 320.0;

}  // namespace

double FirstMotion(const AlignmentInput& input) {
  double t = input.to;
  const bool has_velocity =
      std::any_of(input.dataset.streams.begin(), input.dataset.streams.end(),
                  [](const AidingStream& stream) {
                    return !stream.measurements.empty() &&
                           std::holds_alternative<VelocityFix>(
                               stream.measurements.front().model);
                  });
  for (const TimedVelocity& v : input.velocities) {
    if (has_velocity && v.t >= input.t) t = std::min(t, v.t);
  }
  for (const TimedFix& fix : input.fixes) {
    if (!has_velocity && fix.t >= input.t) t = std::min(t, fix.t);
  }
  return t;
}

namespace {

/// The same from the end of the rest at input.t on: while it does not turn, its
/// attitude is that at input.t, and the gyro bias is what the gyros read.
AlignmentInput AfterRest(const AlignmentInput& input) {
  constexpr double kMargin = 1.0;  // [s]
  AlignmentInput out = input;
  if (!input.rest || input.rest->length() < 2.0 * kMargin) return out;
  out.t = input.rest->end - kMargin;
  const TimeInterval rest{input.t, out.t};
  out.b_g_before = GyroBiasAfterRest(input.dataset, rest);
  out.b_g = out.b_g_before->b_g;
  if (DriftAtRest(input.dataset.imu, rest) > 0.0) {
    out.least_gyro_walk = WarmUpWalk(input);
  }
  return out;
}

struct WindowSearch {
  std::optional<VelocityAlignment> best;
  /// Gyro bias walk that the last window shows beyond the stated one; else 0.
  double walk = 0.0;
  /// A window shows it by itself; else two that contradict each other do, and
  /// what else may be wrong with either.
  bool drifts = false;
};

/// Ends at the first sign of a drift that `least_walk` does not know. `windows`
/// are those of an earlier search, shortest first, and come to be those of this
/// one.
WindowSearch SearchWindows(const AlignmentInput& input, double least_walk,
                           std::deque<AlignmentWindow>* windows) {
  const double first = FirstMotion(input);
  WindowSearch search;
  std::optional<VelocityAlignment>& best = search.best;
  bool done = false;
  std::size_t i = 0;
  for (double window = kFirstWindow; window <= kLongestWindow; window *= 2.0) {
    const double t_end = std::min(first + window, input.to);
    if (i == windows->size()) windows->emplace_back(input, t_end);
    auto found = (*windows)[i++].Align(least_walk, best ? &*best : nullptr);
    const bool contradicts = found && best && best->refined && found->refined &&
                             Contradict(found->attitude, best->attitude);
    if (found && found->drifts) {
      search.walk = found->refined->gyro_bias_walk;
      search.drifts = true;
    }
    if (contradicts) search.walk = std::max(search.walk, WarmUpWalk(input));
    const bool explained = least_walk > 0.0 || search.walk == 0.0;
    if (contradicts || !explained) break;
    if (found && (!best || (found->refined && found->attitude.P.trace() <
                                                  best->attitude.P.trace()))) {
      best = std::move(found);
    }
    if (done || t_end >= input.to) break;
    done = best &&
           best->attitude.P.diagonal().maxCoeff() < kWellKnown * kWellKnown;
  }
  return search;
}

}  // namespace

AlignmentOutcome AlignByVelocity(const AlignmentInput& input) {
  const AlignmentInput from = AfterRest(input);
  std::deque<AlignmentWindow> windows;
  WindowSearch search = SearchWindows(from, from.least_gyro_walk, &windows);
  const bool drifts = from.least_gyro_walk > 0.0 || search.drifts;
  if (from.least_gyro_walk == 0.0 && search.walk > 0.0) {
    search = SearchWindows(from, search.walk, &windows);
  }
  if (!search.best) return {std::nullopt, "too few velocities or positions"};
  AlignedAttitude attitude = search.best->attitude;
  if (!drifts) attitude.gyro_bias_walk = 0.0;
  return {attitude, ""};
}

}  // namespace hindsight
