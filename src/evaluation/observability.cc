#include "evaluation/observability.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/units.h"

namespace hindsight {
namespace {

constexpr double kObservedRatio = 1.0 / 3.0;
constexpr double kUnobservedRatio = 0.9;

double LimitOf(BlockKind kind, int axis) {
  switch (kind) {
    case BlockKind::kPosition:
      return kLargestPositionSigma;
    case BlockKind::kVelocity:
      return kLargestVelocitySigma;
    default:
      return axis == 2 ? kLargestHeadingSigma : kLargestTiltSigma;
  }
}

constexpr std::string_view kUsualAdvice =
    "more motion, or a second sensor of the same quantity";

/// By what the sigma of a constant is too small.
double Widening(const ConstantEstimate& constant,
                std::span<const ConstantExcess> excess) {
  for (const ConstantExcess& one : excess) {
    if (one.name != constant.name || !(one.factor > 1.0)) continue;
    const double ratio = constant.sigma / constant.prior_sigma;
    const double share = std::max(0.0, 1.0 - ratio * ratio);
    return std::sqrt(1.0 + (one.factor * one.factor - 1.0) * share);
  }
  return 1.0;
}

double ValueOf(const Block& block, int axis, const State& x) {
  switch (block.key.kind) {
    case BlockKind::kGyroBias:
      return x.b_g(axis);
    case BlockKind::kAccelBias:
      return x.b_a(axis);
    default:
      return x.parameters(block.parameter_offset + axis);
  }
}

}  // namespace

ConstantEstimate::Verdict VerdictOfSigma(double sigma, double prior_sigma) {
  const double ratio = sigma / prior_sigma;
  return ratio < kObservedRatio     ? ConstantEstimate::Verdict::kObserved
         : ratio < kUnobservedRatio ? ConstantEstimate::Verdict::kWeak
                                    : ConstantEstimate::Verdict::kUnobserved;
}

std::vector<ConstantEstimate> EstimateConstants(
    const Solution& solution, std::span<const ConstantExcess> excess,
    const State* start) {
  std::vector<ConstantEstimate> constants;
  if (solution.states.empty() || solution.covariances.empty()) return constants;
  const State& x = solution.states.back();
  const ErrorMatrix P = solution.covariances.Get(solution.states.size() - 1);
  for (const Block& block : solution.layout.blocks()) {
    if (!block.evolution.is_constant()) continue;
    int component = block.offset;
    for (int axis = 0; axis < FullDimension(block.key.kind); ++axis) {
      if (!block.active[static_cast<std::size_t>(axis)]) continue;
      ConstantEstimate constant;
      constant.name = solution.layout.ComponentName(component);
      constant.unit = block.unit;
      constant.value = ValueOf(block, axis, x);
      if (start != nullptr) {
        constant.prior_value = ValueOf(block, axis, *start);
      }
      constant.sigma = std::sqrt(P(component, component));
      constant.prior_sigma = block.sigma0(axis);
      const auto stated = VerdictOfSigma(constant.sigma, constant.prior_sigma);
      constant.widened = Widening(constant, excess);
      constant.sigma *= constant.widened;
      constant.verdict = VerdictOfSigma(constant.sigma, constant.prior_sigma);
      // It did move from its prior, if only by errors of the data.
      if (stated != constant.verdict &&
          constant.verdict == ConstantEstimate::Verdict::kUnobserved) {
        constant.verdict = ConstantEstimate::Verdict::kWeak;
      }
      if (constant.verdict != ConstantEstimate::Verdict::kObserved) {
        constant.advice = block.advice.empty() ? kUsualAdvice : block.advice;
      }
      constants.push_back(std::move(constant));
      ++component;
    }
  }
  return constants;
}

Eigen::MatrixXd CovarianceOfConstants(const Solution& solution) {
  if (solution.covariances.empty()) return {};
  std::vector<int> components;
  for (const Block& block : solution.layout.blocks()) {
    if (!block.evolution.is_constant()) continue;
    for (int i = 0; i < block.dim; ++i) components.push_back(block.offset + i);
  }
  if (components.size() != solution.constants.size()) return {};
  const ErrorMatrix all =
      solution.covariances.Get(solution.covariances.size() - 1);
  Eigen::MatrixXd P = all(components, components);
  for (std::size_t i = 0; i < components.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    P.row(k) *= solution.constants[i].widened;
    P.col(k) *= solution.constants[i].widened;
  }
  return P;
}

std::vector<UnobservedSpan> FindUnobserved(const Solution& solution) {
  std::vector<UnobservedSpan> spans;
  const std::size_t count = solution.covariances.size();
  std::vector<int> open(static_cast<std::size_t>(solution.layout.dim()), -1);
  for (std::size_t k = 0; k < count; ++k) {
    const ErrorVector P = solution.covariances.Variances(k);
    const double t = solution.states[k].t;
    for (const Block& block : solution.layout.blocks()) {
      if (block.key.kind > BlockKind::kAttitude) continue;
      for (int i = 0; i < block.dim; ++i) {
        const int component = block.offset + i;
        const double sigma = std::sqrt(P(component));
        int& span = open[static_cast<std::size_t>(component)];
        // With masked axes component i may be another axis; the limits of the
        // horizontal ones are the same.
        const double limit = LimitOf(block.key.kind, block.dim == 3 ? i : 0);
        if (sigma <= limit) {
          span = -1;
          continue;
        }
        if (span < 0) {
          span = static_cast<int>(spans.size());
          spans.push_back(
              {solution.layout.ComponentName(component), t, t, sigma, limit});
        }
        UnobservedSpan& s = spans[static_cast<std::size_t>(span)];
        s.t_end = t;
        s.sigma = std::min(s.sigma, sigma);
      }
    }
  }
  return spans;
}

bool IsMostOfTheTime(const UnobservedSpan& span, const Solution& solution) {
  const double duration = solution.states.back().t - solution.states.front().t;
  return span.t_end - span.t_begin >= 0.5 * duration;
}

}  // namespace hindsight
