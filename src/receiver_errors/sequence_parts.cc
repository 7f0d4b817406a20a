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
    SetStep(i, {mode, anew, (*h)[i].velocity_step && !anew}, h);
  }
}

}  // namespace hindsight
