#include "receiver_errors/sequence_parts.h"

namespace hindsight {

bool IsBias(ErrorMode mode) {
  return mode == ErrorMode::kBiased || mode == ErrorMode::kSlight;
}

ErrorMode ModeBefore(const ModeSequence& h, std::size_t i) {
  return i == 0 ? ErrorMode::kGood : h[i - 1].mode;
}

std::vector<std::size_t> Parts(const ModeSequence& h) {
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < h.size(); ++i) {
    if (h[i].anew || h[i].mode != ModeBefore(h, i)) at.push_back(i);
  }
  at.push_back(h.size());
  return at;
}

void SetStep(std::size_t i, ErrorStep step, ModeSequence* h) {
  step.outlier = (*h)[i].outlier;
  (*h)[i] = step;
}

void SetError(ErrorMode mode, std::size_t begin, std::size_t end,
              ModeSequence* h) {
  const bool is_good = mode == ErrorMode::kGood;
  for (std::size_t i = begin; i < end; ++i) {
    const bool anew = i == begin && !is_good;
    ErrorStep step = (*h)[i];
    step.mode = mode;
    step.anew = anew;
    if (anew || !step.velocity_step) step = {mode, anew};
    SetStep(i, step, h);
  }
}

ModeSequence WithChangeMoved(ModeSequence h, std::size_t from, std::size_t to) {
  ErrorStep step = h[from];
  step.onset = Onset::kUsual;
  const ErrorMode before = ModeBefore(h, from);
  const auto go_on = [&h, from](std::size_t i, ErrorMode mode) {
    const bool steps = i != from && h[i].velocity_step;
    SetStep(i,
            {.mode = mode,
             .velocity_step = steps,
             .onset = steps ? h[i].onset : Onset::kUsual},
            &h);
  };
  for (std::size_t i = from; i < to; ++i) go_on(i, before);
  for (std::size_t i = to + 1; i <= from; ++i) go_on(i, step.mode);
  SetStep(to, step, &h);
  return h;
}

}  // namespace hindsight
