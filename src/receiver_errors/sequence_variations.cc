#include "receiver_errors/sequence_variations.h"

#include <algorithm>
#include <cmath>

#include "receiver_errors/sequence_parts.h"

namespace hindsight {
namespace {

/// Fixes of the shortest earlier error that is looked for, and the ratio of the
/// lengths that are.
constexpr std::size_t kShortest = 5;
constexpr double kLengthRatio = 1.25;

/// Fixes at which something changes, and the end.
std::vector<std::size_t> Changes(const ModeSequence& h) {
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < h.size(); ++i) {
    if (h[i].anew || h[i].velocity_step || h[i].mode != ModeBefore(h, i))
      at.push_back(i);
  }
  at.push_back(h.size());
  return at;
}

/// Fills [begin, end) with what goes on in a mode.
void GoOn(ErrorMode mode, std::size_t begin, std::size_t end, ModeSequence* h) {
  for (std::size_t i = begin; i < end; ++i) SetStep(i, {mode}, h);
}

ModeSequence WithSegment(ModeSequence h, std::size_t begin, std::size_t end,
                         ErrorStep step) {
  GoOn(step.mode, begin, end, &h);
  SetStep(begin, step, &h);
  return h;
}

/// A mode goes on over a velocity step in place of what began at a fix, when that did.
ErrorStep Stepping(ErrorMode mode, const ErrorStep& began) {
  return {.mode = mode,
          .velocity_step = true,
          .onset = BeginsAtSomeTime(began) ? began.onset : Onset::kUsual};
}

/// From change c on the receiver is good and the IMU velocity steps instead.
ModeSequence WithVelocitySteps(ModeSequence h,
                               const std::vector<std::size_t>& at,
                               std::size_t c) {
  const bool returns = ModeBefore(h, at[c]) != ErrorMode::kGood;
  const ModeSequence errors = h;
  GoOn(ErrorMode::kGood, at[c], h.size(), &h);
  for (std::size_t i = returns ? c + 1 : c; i + 1 < at.size(); ++i) {
    SetStep(at[i], Stepping(ErrorMode::kGood, errors[at[i]]), &h);
  }
  return h;
}

/// What goes on before part c goes on through it, over a velocity step where the part
/// begins, and, if asked for, one where it ends.
ModeSequence SteppedInPlaceOf(ModeSequence h,
                              const std::vector<std::size_t>& parts,
                              std::size_t c, bool at_end) {
  const std::size_t begin = parts[c];
  const std::size_t end = parts[c + 1];
  const ErrorMode before = ModeBefore(h, begin);
  for (std::size_t i = begin; i < end; ++i) {
    const bool steps = i == begin || h[i].velocity_step;
    SetStep(i, steps ? Stepping(before, h[i]) : ErrorStep{before}, &h);
  }
  if (at_end) h[end].velocity_step = true;
  return h;
}

/// Where an error begins behind a gap the vehicle may as well be elsewhere than dead
/// reckoning has it, also beside errors later on.
void AddSteppedInPlaceOfErrors(const ModeSequence& h,
                               std::vector<ModeSequence>* all) {
  const std::vector<std::size_t> at = Parts(h);
  for (std::size_t c = 0; c + 1 < at.size(); ++c) {
    if (h[at[c]].mode == ErrorMode::kGood) continue;
    all->push_back(SteppedInPlaceOf(h, at, c, false));
    const std::size_t end = at[c + 1];
    if (end < h.size() && !h[end].anew && !h[end].velocity_step) {
      all->push_back(SteppedInPlaceOf(h, at, c, true));
    }
  }
}

/// What begins at change `at` may have begun at another time before that fix, or late
/// before the one before it, which is not before `least`.
void AddOtherOnsets(const ModeSequence& h, std::size_t at, std::size_t least,
                    std::vector<ModeSequence>* all) {
  if (!BeginsAtSomeTime(h[at])) return;
  const auto add = [all](ModeSequence one, std::size_t i, Onset onset) {
    one[i].onset = onset;
    all->push_back(std::move(one));
  };
  for (const Onset onset : {Onset::kUsual, Onset::kFirst, Onset::kSecond,
                            Onset::kThird, Onset::kFourth}) {
    if (onset != h[at].onset) add(h, at, onset);
  }
  if (at < least + 1) return;
  for (const Onset onset : {Onset::kSecond, Onset::kThird, Onset::kFourth}) {
    add(WithChangeMoved(h, at, at - 1), at - 1, onset);
  }
}

std::size_t NextLength(std::size_t length) {
  return static_cast<std::size_t>(
      std::ceil(kLengthRatio * static_cast<double>(length)));
}

/// The other way about at part c: where the receiver erred before and is good
/// after, it was good before and errs after; and the reverse.
ModeSequence Swapped(ModeSequence h, const std::vector<std::size_t>& at,
                     std::size_t c, ErrorMode error) {
  const std::size_t begin = c == 0 ? 0 : at[c - 1];
  const bool erred = ModeBefore(h, at[c]) != ErrorMode::kGood;
  SetError(erred ? ErrorMode::kGood : error, begin, at[c], &h);
  SetError(erred ? error : ErrorMode::kGood, at[c], at[c + 1], &h);
  return h;
}

void AddSwaps(const ModeSequence& h, std::vector<ModeSequence>* all) {
  const std::vector<std::size_t> at = Parts(h);
  for (std::size_t c = 0; c + 1 < at.size(); ++c) {
    const ErrorMode before = ModeBefore(h, at[c]);
    const ErrorMode error = before == ErrorMode::kGood ? h[at[c]].mode : before;
    all->push_back(Swapped(h, at, c, error));
    if (error != ErrorMode::kBiased) {
      all->push_back(Swapped(h, at, c, ErrorMode::kBiased));
    }
  }
}

}  // namespace

std::vector<ModeSequence> Variations(const ModeSequence& h) {
  std::vector<ModeSequence> all;
  const std::vector<std::size_t> at = Changes(h);
  for (std::size_t c = 0; c + 1 < at.size(); ++c) {
    const std::size_t least = c == 0 ? 0 : at[c - 1] + 1;
    for (const std::size_t shift : {1u, 2u, 4u, 8u}) {
      if (at[c] >= least + shift) {
        all.push_back(WithChangeMoved(h, at[c], at[c] - shift));
      }
      if (at[c] + shift < at[c + 1]) {
        all.push_back(WithChangeMoved(h, at[c], at[c] + shift));
      }
    }
    AddOtherOnsets(h, at[c], least, &all);
    for (const ErrorStep step : StepsAfter(ModeBefore(h, at[c]))) {
      all.push_back(WithSegment(h, at[c], at[c + 1], step));
    }
    all.push_back(WithVelocitySteps(h, at, c));
    // An error too small to be found alone may have come before a larger one.
    for (std::size_t length = kShortest; at[c] >= least + length; length *= 2) {
      all.push_back(
          WithSegment(h, at[c] - length, at[c], {ErrorMode::kBiased, true}));
    }
  }
  AddSwaps(h, &all);
  AddSteppedInPlaceOfErrors(h, &all);
  return all;
}

void ForEachVelocityStep(
    const ModeSequence& h,
    const std::function<bool(const ModeSequence&)>& visit) {
  ModeSequence one = h;
  for (std::size_t i = 0; i < h.size(); ++i) {
    if (h[i].anew || h[i].velocity_step || h[i].mode != ModeBefore(h, i))
      continue;
    one[i].velocity_step = true;
    if (!visit(one)) return;
    one[i].velocity_step = false;
  }
}

std::vector<ModeSequence> RolesExchanged(const ModeSequence& h) {
  const auto errs = [](const ErrorStep& s) {
    return s.mode != ErrorMode::kGood;
  };
  const auto biased = [](const ErrorStep& s) { return IsBias(s.mode); };
  const auto at_start = static_cast<std::size_t>(
      std::find_if_not(h.begin(), h.end(), errs) - h.begin());
  const auto at_end = static_cast<std::size_t>(
      std::find_if_not(h.rbegin(), h.rend(), biased) - h.rbegin());
  std::vector<ModeSequence> all;
  if (at_start == h.size()) return all;
  ModeSequence good = h;
  GoOn(ErrorMode::kGood, 0, h.size(), &good);
  if (at_start > 0) {
    all.push_back(good);
    SetError(ErrorMode::kBiased, at_start, h.size(), &all.back());
  }
  if (at_end > 0) {
    all.push_back(good);
    SetError(ErrorMode::kBiased, 0, h.size() - at_end, &all.back());
  }
  return all;
}

std::vector<ModeSequence> DriftsThatEnd(const ModeSequence& h) {
  std::vector<ModeSequence> all;
  const auto add = [&all](ModeSequence good, std::size_t jump) {
    for (ErrorStep& step : good) step = WithoutVelocityStep(step);
    for (std::size_t length = kShortest; length <= jump;
         length = NextLength(length)) {
      all.push_back(good);
      SetError(ErrorMode::kDrifting, jump - length, jump, &all.back());
    }
  };
  const std::vector<std::size_t> at = Parts(h);
  if (at.size() < 2) return all;
  const std::size_t last = at[at.size() - 2];
  if (IsBias(h[last].mode) && h[last].anew && last > 0) {
    ModeSequence good = h;
    SetError(ErrorMode::kGood, last, h.size(), &good);
    add(std::move(good), last);
  }
  if (IsBias(h.front().mode) && at[1] < h.size() &&
      h[at[1]].mode == ErrorMode::kGood) {
    ModeSequence good = h;
    SetError(ErrorMode::kGood, 0, at[1], &good);
    add(std::move(good), at[1]);
  }
  return all;
}

void ForEachEarlierError(
    const ModeSequence& h,
    const std::function<bool(const ModeSequence&, double count)>& visit) {
  const std::vector<std::size_t> at = Parts(h);
  for (std::size_t c = 0; c + 1 < at.size(); ++c) {
    const std::size_t least = c == 0 ? 0 : at[c - 1] + 1;
    std::size_t next = 0;
    for (std::size_t length = kShortest; at[c] >= least + length;
         length = next) {
      next = NextLength(length);
      const auto count = static_cast<double>(next - length);
      for (const ErrorMode mode :
           {ErrorMode::kBiased, ErrorMode::kSlight, ErrorMode::kDrifting}) {
        ModeSequence one = h;
        SetError(mode, at[c] - length, at[c], &one);
        if (!visit(one, count)) return;
        if (mode != ErrorMode::kDrifting) continue;
        SetError(ErrorMode::kGood, at[c], at[c + 1], &one);
        if (!visit(one, count)) return;
      }
    }
  }
}

}  // namespace hindsight
