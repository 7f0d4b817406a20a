#include "receiver_errors/hidden_changes.h"

#include <algorithm>
#include <initializer_list>

#include "receiver_errors/sequence_parts.h"

namespace hindsight {
namespace {

ErrorMode AsBias(ErrorMode mode) {
  return IsBias(mode) ? mode : ErrorMode::kBiased;
}

/// Fixes from `begin` to before `end`, with an error of their own or none.
struct ErrorStretch {
  ErrorMode mode;
  std::size_t begin;
  std::size_t end;
};

/// Of fixes behind gaps, in order, so many next to fix i that are within (begin, end).
std::vector<std::size_t> Nearest(const std::vector<std::size_t>& behind_gaps,
                                 std::size_t i, std::size_t begin,
                                 std::size_t end) {
  constexpr std::ptrdiff_t kMost = 4;
  const auto first = std::ranges::upper_bound(behind_gaps, begin);
  const auto past = std::ranges::lower_bound(behind_gaps, end);
  if (first >= past) return {};
  return i <= begin
             ? std::vector(
                   first, std::min(past, first + std::min(kMost, past - first)))
             : std::vector(past - std::min(kMost, past - first), past);
}

/// The sequence with the change of the receiver's error at fix `from` at fix `to` instead.
/// Velocity steps are the IMU's, and stay where nothing of the receiver begins.
ModeSequence ErrorChangeMoved(const ModeSequence& h, std::size_t from,
                              std::size_t to) {
  ModeSequence moved = WithChangeMoved(h, from, to);
  for (const std::size_t i : {from, to}) {
    moved[i] = WithoutVelocityStep(moved[i]);
    if (!h[i].velocity_step || moved[i].anew) continue;
    moved[i].velocity_step = true;
    moved[i].onset = h[i].onset;
  }
  return moved;
}

}  // namespace

std::vector<ModeSequence> HiddenChanges(
    const ModeSequence& h, const std::vector<std::size_t>& behind_gaps) {
  constexpr ErrorMode kGood = ErrorMode::kGood;
  std::vector<ModeSequence> all;
  const auto add = [&](std::initializer_list<ErrorStretch> stretches) {
    ModeSequence& one = all.emplace_back(h);
    for (const ErrorStretch& s : stretches)
      SetError(s.mode, s.begin, s.end, &one);
  };
  const std::vector<std::size_t> at = Parts(h);
  for (std::size_t c = 0; c + 1 < at.size(); ++c) {
    const std::size_t before = c == 0 ? 0 : at[c - 1];
    const std::size_t change = at[c];
    const std::size_t after = at[c + 1];
    const ErrorMode was = ModeBefore(h, change);
    const ErrorMode is = h[change].mode;
    for (const std::size_t gap : Nearest(behind_gaps, change, change, after)) {
      all.push_back(ErrorChangeMoved(h, change, gap));
      if (is != kGood) add({{kGood, gap, after}});
      if (was == kGood) continue;
      const ErrorStretch good = {kGood, before, change};
      const ErrorStretch error = {AsBias(was), change, gap};
      add({good, error, {kGood, gap, after}});
      if (is != kGood) add({good, error, {is, gap, after}});
    }
    for (const std::size_t gap : Nearest(behind_gaps, change, before, change)) {
      all.push_back(ErrorChangeMoved(h, change, gap));
      if (was != kGood) add({{kGood, before, gap}, {was, gap, change}});
      if (is == kGood) continue;
      const ErrorStretch error = {AsBias(is), gap, change};
      const ErrorStretch good = {kGood, change, after};
      add({{kGood, before, gap}, error, good});
      if (was != kGood) add({error, good});
    }
  }
  return all;
}

}  // namespace hindsight
