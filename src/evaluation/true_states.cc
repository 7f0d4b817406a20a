#include "evaluation/true_states.h"

#include <string>

#include "base/error.h"

namespace hindsight {
namespace {

constexpr double kTimeTolerance = 1e-6;

/// The known parameters of the state, constants of simulated data.
void TakeTrueConstants(const Dataset& dataset, const ErrorLayout& layout,
                       State* y) {
  for (const Block& block : layout.blocks()) {
    if (block.parameter_offset < 0) continue;
    for (int i = 0; i < block.dim; ++i) {
      const auto constant =
          dataset.true_constants.find(layout.ComponentName(block.offset + i));
      if (constant == dataset.true_constants.end()) continue;
      y->parameters(block.parameter_offset + i) = constant->second;
    }
  }
}

}  // namespace

std::vector<State> TrueStates(const Dataset& dataset, const ErrorLayout& layout,
                              const std::vector<State>& states) {
  std::vector<State> truth;
  truth.reserve(states.size());
  std::size_t i = 0;
  for (const State& x : states) {
    while (i < dataset.truth.size() &&
           dataset.truth[i].t < x.t - kTimeTolerance) {
      ++i;
    }
    if (i == dataset.truth.size() ||
        dataset.truth[i].t > x.t + kTimeTolerance) {
      throw InputError("data set '" + dataset.name + "' has no truth at " +
                       std::to_string(x.t) + " s, where a node stands");
    }
    const TruthPoint point = dataset.truth[i];
    // What is not estimated may be unknown.
    const auto known =
        [&](BlockKind kind, const auto& value,
            const Eigen::Vector3d& otherwise) -> Eigen::Vector3d {
      return layout.Has(kind) ? value.value() : value.value_or(otherwise);
    };
    State& y = truth.emplace_back(x);
    y.p_e = known(BlockKind::kPosition, point.p_e, x.p_e);
    const Eigen::Matrix3d C_en = NedAxes(y.p_e);
    y.v_e = C_en * known(BlockKind::kVelocity, point.v_n, x.v_n());
    y.q_eb = Eigen::Quaterniond(C_en) * point.q_nb.value();
    y.b_g = known(BlockKind::kGyroBias, point.b_g, x.b_g);
    y.b_a = known(BlockKind::kAccelBias, point.b_a, x.b_a);
    TakeTrueConstants(dataset, layout, &y);
  }
  return truth;
}

std::vector<int> ComponentsWithTruth(const Dataset& dataset,
                                     const ErrorLayout& layout) {
  std::vector<int> components;
  for (const Block& block : layout.blocks()) {
    for (int i = block.offset; i < block.offset + block.dim; ++i) {
      if (block.parameter_offset < 0 ||
          dataset.true_constants.contains(layout.ComponentName(i))) {
        components.push_back(i);
      }
    }
  }
  return components;
}

}  // namespace hindsight
