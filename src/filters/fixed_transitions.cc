#include "filters/fixed_transitions.h"

#include <algorithm>

#include "base/parallel.h"

namespace hindsight {
namespace {

constexpr std::size_t kTransitionsAtOnce = 64;

}  // namespace

void FixedTransitions::Linearize(std::size_t first, std::vector<Step>* steps) {
  steps->resize(std::min(kTransitionsAtOnce, nominal_.size() - first));
  for (std::size_t i = 0; i < steps->size(); ++i) {
    const std::size_t k = first + i;
    const State& from = nominal_[k - 1];
    const NodeInterval interval =
        IntervalAfter(k - 1, layout_, from, &timeline_);
    Step& step = (*steps)[i];
    step.dt = interval.summary.dt();
    LinearizeAdvance(layout_, interval, from, nominal_[k], &step.transition);
  }
}

const FixedTransitions::Step& FixedTransitions::To(std::size_t k) {
  if (k >= first_ + steps_.size()) {
    first_ = k;
    if (ahead_.valid()) {
      ahead_.get();
    } else {
      Linearize(k, &next_);
    }
    steps_.swap(next_);
    const std::size_t behind = first_ + steps_.size();
    if (behind < nominal_.size()) {
      ahead_ = InBackground([this, behind] { Linearize(behind, &next_); });
    }
  }
  return steps_[k - first_];
}

}  // namespace hindsight
