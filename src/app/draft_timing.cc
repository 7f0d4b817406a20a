#include "app/draft_timing.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dataset/clock_drift.h"
#include "dataset/clock_search.h"
#include "io/config/key_line_edit.h"

namespace hindsight {
namespace {

/// Whether its stamps are taken as they are, and not to begin somewhere.
bool KeepsItsStamps(const std::vector<KeyLine>& lines) {
  const KeyLine* time = FindLine(lines, "time");
  return time == nullptr || time->value.find("start") == std::string::npos;
}

/// Stamps that are taken as they are agree with the IMU's unless the motion
/// speaks against it: where no offset fits as well but for chance, and none is
/// near.
bool MayAgree(const ClockSearch& found) {
  return IsPlausible(found, found.misfit(0.0)) &&
         std::none_of(found.candidates.begin(), found.candidates.end(),
                      [&](const ClockCandidate& candidate) {
                        return std::abs(candidate.offset) < found.resolution;
                      });
}

void TakeClockInto(const ClockSearch& found, StreamDraft* stream,
                   RecordingDraft* draft) {
  std::vector<KeyLine>& lines = stream->found.lines;
  const bool as_they_are =
      KeepsItsStamps(lines) && KeepsItsStamps(draft->imu->lines);
  if (found.candidates.empty() || (as_they_are && MayAgree(found))) {
    draft->Assume(
        stream->name +
        ": the motion does not show where its clock stands against the "
        "IMU's");
    return;
  }
  if (found.candidates.size() > 1) {
    DropClockSigma(&lines);
    SetLine({"time_offset", "unknown",
             "several fit, each is tried: " + Describe(found)},
            &lines);
    return;
  }
  const ClockCandidate& best = found.candidates.front();
  if (!std::isfinite(best.sigma)) {
    draft->Assume(stream->name +
                  ": the motion hardly shows where its clock stands against "
                  "the IMU's");
    return;
  }
  SetLine({"time_offset", fmt::format("{:.3f} s", best.offset),
           fmt::format("by {}, +- {:.2g} s; refined (likely)", found.compared,
                       best.sigma)},
          &lines);
}

}  // namespace

void TellClocks(const Dataset& dataset, RecordingDraft* draft) {
  for (const AidingStream& stream : dataset.streams) {
    StreamDraft* drafted = draft->Find(stream.sensor.name);
    if (drafted == nullptr || !stream.sensor.kind->has_clock ||
        stream.sensor.kind->magnetic || stream.sensor.kind->standing) {
      continue;
    }
    if (drafted->found.spin_axis) continue;
    const ClockSearch found = SearchClock(dataset.imu, dataset.initial, stream);
    TakeClockInto(found, drafted, draft);
  }
}

void TellFieldClock(const Dataset& dataset, RecordingDraft* draft) {
  constexpr double kKnown = 0.02;  // s
  for (const AidingStream& stream : dataset.streams) {
    StreamDraft* drafted = draft->Find(stream.sensor.name);
    if (drafted == nullptr || !stream.sensor.kind->magnetic) continue;
    ClockSearch found = SearchClock(dataset.imu, dataset.initial, stream);
    DropImplausible(&found);
    if (found.candidates.size() != 1) continue;
    const ClockCandidate& best = found.candidates.front();
    if (!(best.sigma < kKnown)) continue;
    SetLine({"time_offset", fmt::format("{:.4f} s", best.offset),
             fmt::format("by {}, +- {:.2g} s (likely)", found.compared,
                         best.sigma)},
            &drafted->found.lines);
  }
}

void TellStretch(const Dataset& dataset, RecordingDraft* draft) {
  constexpr double kLong = 200.0;  // s
  constexpr double kMostDrift = 1e-3;
  constexpr double kSure = 5.0;    // sigmas
  constexpr double kShown = 0.03;  // s
  const KeyLine* time = FindLine(draft->imu->lines, "time");
  const bool fixed =
      time != nullptr && time->value.find("duration") != std::string::npos;
  if (fixed) return;
  for (const AidingStream& stream : dataset.streams) {
    const StreamDraft* drafted = draft->Find(stream.sensor.name);
    const auto& z = stream.measurements;
    if (drafted == nullptr || z.size() < 100 ||
        z.back().t - z.front().t < kLong ||
        !(stream.sensor.kind->is_position || stream.sensor.kind->is_velocity)) {
      continue;
    }
    const auto drift = FindClockDrift(dataset, stream);
    if (!drift) continue;
    if (std::abs(drift->change) < kSure * drift->sigma + kShown ||
        std::abs(drift->rate) > kMostDrift) {
      return;
    }
    AddToMap("time", fmt::format("stretch: {:.7f}", 1.0 / (1.0 + drift->rate)),
             fmt::format("its offset to {} changes by {:.3f} +- {:.3f} s "
                         "(likely)",
                         drafted->name, drift->change, drift->sigma),
             &draft->imu->lines);
    return;
  }
}

void TellTruthClock(const Dataset& dataset, RecordingDraft* draft) {
  constexpr double kShown = 0.02;  // s
  if (!draft->truth || dataset.truth.empty() || !dataset.truth[0].q_nb) {
    return;
  }
  const ClockSearch found = SearchClock(dataset.imu, dataset.truth);
  if (found.candidates.empty() ||
      std::abs(found.candidates.front().offset) < kShown) {
    return;
  }
  SetLine({"time_offset", "unknown", "its turns show it: " + Describe(found)},
          &draft->truth->lines);
}

}  // namespace hindsight
