#include "problems/disagreement.h"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "evaluation/grade.h"

namespace hindsight {

bool OptimumComparison::HasNodesOf(const Solution& solution) const {
  constexpr double kSameTime = 1e-9;
  if (poses_.size() != solution.states.size()) return false;
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    if (std::abs(poses_[k].t - solution.states[k].t) > kSameTime) return false;
  }
  return true;
}

std::optional<Evidence> OptimumComparison::Compare(const std::string& method,
                                                   const Solution& solution) {
  constexpr double kLimit = 1.0;  // sigma
  if (!solution.converged || solution.covariances.empty()) return std::nullopt;
  if (!HasNodesOf(solution)) {
    method_ = method;
    poses_.clear();
    for (const State& x : solution.states) {
      poses_.push_back({x.t, x.p_e, x.q_eb});
    }
    return std::nullopt;
  }
  double largest = 0.0;
  double t = 0.0;
  std::string component;
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    State other = solution.states[k];
    other.p_e = poses_[k].p_e;
    other.q_eb = poses_[k].q_eb;
    const ErrorVector d = Local(solution.layout, solution.states[k], other);
    const ErrorMatrix P = solution.covariances.Get(k);
    for (const Block& block : solution.layout.blocks()) {
      if (block.key.kind != BlockKind::kPosition &&
          block.key.kind != BlockKind::kAttitude) {
        continue;
      }
      for (int i = block.offset; i < block.offset + block.dim; ++i) {
        const double sigmas = std::abs(d(i)) / std::sqrt(P(i, i));
        if (!(sigmas > largest)) continue;
        largest = sigmas;
        t = other.t;
        component = solution.layout.ComponentName(i);
      }
    }
  }
  if (!(largest > kLimit)) return std::nullopt;
  return Evidence{
      .rule = "disagreement",
      .grade = Grade::kDoubtful,
      .what = fmt::format(
          "{} and {} end {:.2g} sigma apart in {} at {:.1f} s (limit 1)",
          method_, method, largest, component, t),
      .value = largest,
      .limit = kLimit,
      .unit = "sigma",
      .t_begin = t,
      .t_end = t,
      .causes = {"a start so uncertain, or data that say so little, that the "
                 "cost has several minima"},
      .remedies = {"a better known start"},
      .against = method_};
}

std::optional<Evidence> MethodComparison::Compare(const Solution& solution) {
  constexpr BlockKind kPose[] = {BlockKind::kPosition, BlockKind::kAttitude};
  if (solution.forward || solution.grade == Grade::kUnusable ||
      solution.covariances.empty() || !solution.layout.has_canonical_head()) {
    return std::nullopt;
  }
  Course own{.method = solution.method};
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    State pose = solution.states[k];
    pose.parameters.resize(0);
    own.states.push_back(pose);
    const ErrorMatrix P = solution.covariances.Get(k);
    own.variances.emplace_back();
    own.variances.back() << P.diagonal().segment<3>(0),
        P.diagonal().segment<3>(6);
  }
  ErrorLayout pose_layout;
  for (const BlockKind kind :
       {BlockKind::kPosition, BlockKind::kVelocity, BlockKind::kAttitude}) {
    Block block;
    block.key.kind = kind;
    pose_layout.Add(block);
  }
  std::optional<Evidence> found;
  for (const Course& other : courses_) {
    if (other.states.size() != own.states.size()) continue;
    Variances squares = Variances::Zero();
    bool same_nodes = true;
    for (std::size_t k = 0; same_nodes && k < own.states.size(); ++k) {
      const State& a = own.states[k];
      State b = a;
      b.p_e = other.states[k].p_e;
      b.q_eb = other.states[k].q_eb;
      same_nodes = std::abs(a.t - other.states[k].t) < 1e-9;
      const ErrorVector d = Local(pose_layout, a, b);
      Variances apart;
      apart << d.segment<3>(0), d.segment<3>(6);
      squares += apart.cwiseAbs2().cwiseQuotient(
          own.variances[k].cwiseMax(other.variances[k]));
    }
    Eigen::Index worst = 0;
    const double sigmas = std::sqrt(squares.maxCoeff(&worst) /
                                    static_cast<double>(own.states.size()));
    if (!same_nodes || !(sigmas > kUnusableBias) ||
        (found && *found->value >= sigmas)) {
      continue;
    }
    const Block* block = solution.layout.Find(kPose[worst / 3]);
    found = Evidence{
        .rule = "disagreement",
        .grade = Grade::kDoubtful,
        .what =
            fmt::format("{} and {} are {:.2g} sigma apart in {} (limit {:.0f})",
                        other.method, own.method, sigmas,
                        solution.layout.ComponentName(
                            block->offset + static_cast<int>(worst % 3)),
                        kUnusableBias),
        .value = sigmas,
        .limit = kUnusableBias,
        .unit = "sigma",
        .causes = {"data that contradict each other, of which each method "
                   "believes others"},
        .remedies = {"what the other methods are told"},
        .against = other.method};
  }
  courses_.push_back(std::move(own));
  return found;
}

}  // namespace hindsight
