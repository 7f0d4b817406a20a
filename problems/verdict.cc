#include "problems/verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/units.h"
#include "problems/refusals.h"

namespace hindsight {
namespace {

constexpr double kObservedRatio = 1.0 / 3.0;
constexpr double kUnobservedRatio = 0.9;
constexpr double kPositionLimit = 1000.0;
constexpr double kVelocityLimit = 10.0;
constexpr double kTiltLimit = 5.0 * kDegree;
constexpr double kHeadingLimit = 20.0 * kDegree;

double LimitOf(BlockKind kind, int axis) {
  switch (kind) {
    case BlockKind::kPosition:
      return kPositionLimit;
    case BlockKind::kVelocity:
      return kVelocityLimit;
    default:
      return axis == 2 ? kHeadingLimit : kTiltLimit;
  }
}

/// The motion that makes a constant observable.
const char* AdviceFor(BlockKind kind) {
  switch (kind) {
    case BlockKind::kGyroBias:
      return "rest, or position or velocity aiding over a longer time";
    case BlockKind::kAccelBias:
      return "rest in several attitudes, or turns and accelerations";
    case BlockKind::kGyroScale:
      return "fast turns both ways about the axis";
    case BlockKind::kAccelScale:
      return "strong accelerations along the axis both ways, or rest in "
             "several attitudes";
    case BlockKind::kScale:
      return "travel between position fixes";
    case BlockKind::kMounting:
      return "travel at speed with heading and slope known from turns; roll "
             "only from side slip in turns";
    case BlockKind::kLeverArm:
      return "turns (forward and right arm), and roll and pitch (down arm)";
    case BlockKind::kTimeOffset:
      return "changes of speed or direction";
    case BlockKind::kOffset:
      return "position fixes with height";
    case BlockKind::kCurrent:
      return "bottom track, position fixes, or turns both ways";
    default:
      return "more motion, or a second sensor of the same quantity";
  }
}

}  // namespace

std::vector<ConstantEstimate> EstimateConstants(const Solution& solution) {
  std::vector<ConstantEstimate> constants;
  if (solution.states.empty() || solution.covariances.empty()) return constants;
  const State& x = solution.states.back();
  const ErrorMatrix P = solution.covariances.Get(solution.states.size() - 1);
  for (const Block& block : solution.layout.blocks()) {
    if (block.evolution.kind != Evolution::Kind::kConstant) continue;
    int component = block.offset;
    for (int axis = 0; axis < FullDimension(block.key.kind); ++axis) {
      if (!block.active[static_cast<std::size_t>(axis)]) continue;
      ConstantEstimate constant;
      constant.name = solution.layout.ComponentName(component);
      constant.unit = block.unit;
      constant.value = block.key.kind == BlockKind::kGyroBias ? x.b_g(axis)
                       : block.key.kind == BlockKind::kAccelBias
                           ? x.b_a(axis)
                           : x.parameters(block.parameter_offset + axis);
      constant.sigma = std::sqrt(P(component, component));
      constant.prior_sigma = block.sigma0(axis);
      const double ratio = constant.sigma / constant.prior_sigma;
      constant.verdict =
          ratio < kObservedRatio     ? ConstantEstimate::Verdict::kObserved
          : ratio < kUnobservedRatio ? ConstantEstimate::Verdict::kWeak
                                     : ConstantEstimate::Verdict::kUnobserved;
      if (constant.verdict != ConstantEstimate::Verdict::kObserved) {
        constant.advice = AdviceFor(block.key.kind);
      }
      constants.push_back(std::move(constant));
      ++component;
    }
  }
  return constants;
}

std::vector<UnobservedSpan> FindUnobserved(const Solution& solution) {
  std::vector<UnobservedSpan> spans;
  const std::size_t count = solution.covariances.size();
  std::vector<int> open(static_cast<std::size_t>(solution.layout.dim()), -1);
  for (std::size_t k = 0; k < count; ++k) {
    const ErrorMatrix P = solution.covariances.Get(k);
    const double t = solution.states[k].t;
    for (const Block& block : solution.layout.blocks()) {
      if (block.key.kind > BlockKind::kAttitude) continue;
      for (int i = 0; i < block.dim; ++i) {
        const int component = block.offset + i;
        const double sigma = std::sqrt(P(component, component));
        int& span = open[static_cast<std::size_t>(component)];
        // With masked axes component i may be another axis; the limits of the
        // horizontal ones are the same.
        if (sigma <= LimitOf(block.key.kind, block.dim == 3 ? i : 0)) {
          span = -1;
          continue;
        }
        if (span < 0) {
          span = static_cast<int>(spans.size());
          spans.push_back(
              {solution.layout.ComponentName(component), t, t, sigma});
        }
        UnobservedSpan& s = spans[static_cast<std::size_t>(span)];
        s.t_end = t;
        s.sigma = std::min(s.sigma, sigma);
      }
    }
  }
  return spans;
}

namespace {

constexpr double kWorstResidual = 5.0;

std::string Words(const char* format, const std::string& name, double a,
                  double b) {
  char text[200];
  std::snprintf(text, sizeof(text), format, name.c_str(), a, b);
  return text;
}

/// Why a solution is not usable, or nothing.
std::string Objection(const std::vector<Sensor>& sensors,
                      const Solution& solution) {
  if (!solution.converged) return "the iteration did not converge";
  if (solution.states.empty()) return "no epoch was estimated";
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    if (!solution.states[k].p_e.allFinite() ||
        !solution.covariances.Get(k).allFinite()) {
      return Words("%s from %.1f s on are not finite", "states or covariances",
                   solution.states[k].t, 0.0);
    }
  }
  const double duration = solution.states.back().t - solution.states.front().t;
  for (const UnobservedSpan& span : solution.unobserved) {
    // A forward filter need not know everything from its first second on.
    if (span.t_end - span.t_begin < 0.5 * duration) continue;
    return Words("%s is not observed from %.1f s to %.1f s", span.component,
                 span.t_begin, span.t_end);
  }
  const std::string refusal = FindRefusal(sensors, solution);
  if (!refusal.empty()) return refusal;
  std::vector<double> sum(sensors.size(), 0.0);
  std::vector<double> rows(sensors.size(), 0.0);
  for (const ResidualRecord& record : solution.residuals) {
    if (!record.accepted || record.withheld) continue;
    const auto i = static_cast<std::size_t>(record.sensor);
    sum[i] += record.weight * record.nis;
    rows[i] += record.weight * static_cast<double>(record.residual.size());
  }
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const double rms = rows[i] > 0.0 ? std::sqrt(sum[i] / rows[i]) : 0.0;
    if (rms <= kWorstResidual) continue;
    return Words(
        "residuals of %s are %.1f times what their sigma says (limit %.0f)",
        sensors[i].name, rms, kWorstResidual);
  }
  return "";
}

/// "; 2 constants are kept at their priors: a, b", or nothing.
std::string ConstantsAtPriors(const std::vector<ConstantEstimate>& constants) {
  constexpr int kMostNames = 6;
  std::string names;
  int count = 0;
  for (const ConstantEstimate& constant : constants) {
    if (constant.verdict != ConstantEstimate::Verdict::kUnobserved) continue;
    if (++count > kMostNames) continue;
    names += (count == 1 ? "" : ", ") + constant.name;
  }
  if (count == 0) return "";
  const std::string more =
      count > kMostNames
          ? " and " + std::to_string(count - kMostNames) + " more"
          : "";
  return (count == 1 ? "; 1 constant is kept at its prior: "
                     : "; " + std::to_string(count) +
                           " constants are kept at their priors: ") +
         names + more;
}

/// What is true of a usable solution.
std::string Praise(const Solution& solution) {
  if (!solution.unobserved.empty()) {
    return "usable, but not everywhere: see the unobserved spans" +
           ConstantsAtPriors(solution.constants);
  }
  // P of an observer is no covariance, and tells nothing of the constants.
  if (solution.observer) {
    return "usable: every navigation state is within its limit by P, which is "
           "no covariance";
  }
  return "usable: every navigation state is observed" +
         ConstantsAtPriors(solution.constants);
}

}  // namespace

void Conclude(const std::vector<Sensor>& sensors,
              const std::vector<UnobservedSpan>& known,
              const std::string& objection, Solution* solution) {
  solution->constants = EstimateConstants(*solution);
  solution->unobserved = FindUnobserved(*solution);
  for (const UnobservedSpan& span : known) {
    const bool named =
        std::any_of(solution->unobserved.begin(), solution->unobserved.end(),
                    [&span](const UnobservedSpan& own) {
                      return own.component == span.component;
                    });
    if (!named) solution->unobserved.push_back(span);
  }
  const std::string why =
      objection.empty() ? Objection(sensors, *solution) : objection;
  solution->usable = why.empty();
  solution->verdict =
      solution->usable ? Praise(*solution) : "not usable: " + why;
}

}  // namespace hindsight
