#include "problems/disagreement.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "evaluation/grade.h"
#include "problems/method.h"

namespace hindsight {
namespace {

bool IsPose(const Block& block) {
  return block.key.kind == BlockKind::kPosition ||
         block.key.kind == BlockKind::kAttitude;
}

/// The blocks of position and attitude alone.
ErrorLayout PoseLayout(const ErrorLayout& layout) {
  ErrorLayout poses;
  for (const Block& block : layout.blocks()) {
    if (IsPose(block)) poses.Add(block);
  }
  return poses;
}

/// Its components among those of `layout`.
std::vector<int> PoseComponents(const ErrorLayout& layout) {
  std::vector<int> components;
  for (const Block& block : layout.blocks()) {
    for (int i = 0; IsPose(block) && i < block.dim; ++i) {
      components.push_back(block.offset + i);
    }
  }
  return components;
}

Pose PoseOf(const State& x) { return {x.t, x.p_e, x.q_eb}; }

State StateAt(const Pose& pose) {
  State x;
  x.t = pose.t;
  x.p_e = pose.p_e;
  x.q_eb = pose.q_eb;
  return x;
}

bool AreAtTheSameTimes(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  constexpr double kSameTime = 1e-9;
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Pose& one, const Pose& other) {
                      return std::abs(one.t - other.t) <= kSameTime;
                    });
}

/// Whether it is a method that seeks errors of sensors.
bool Seeks(const std::string& name) {
  return std::ranges::any_of(Methods(), [&name](const Method* method) {
    return method->name == name && method->Has(MethodTrait::kSearches);
  });
}

/// Of poses in the order of time, of which there is one.
std::size_t NearestTo(double t, const std::vector<Pose>& poses) {
  const auto after =
      std::lower_bound(poses.begin(), poses.end(), t,
                       [](const Pose& pose, double at) { return pose.t < at; });
  if (after == poses.end()) return poses.size() - 1;
  const auto i = static_cast<std::size_t>(after - poses.begin());
  return i > 0 && t - poses[i - 1].t < after->t - t ? i - 1 : i;
}

}  // namespace

std::optional<Evidence> OptimumComparison::Compare(const std::string& method,
                                                   const Solution& solution) {
  constexpr double kLimit = 1.0;  // sigma
  if (!solution.converged || solution.covariances.empty()) return std::nullopt;
  std::vector<Pose> own;
  for (const State& x : solution.states) own.push_back(PoseOf(x));
  if (!AreAtTheSameTimes(own, poses_)) {
    method_ = method;
    poses_ = std::move(own);
    return std::nullopt;
  }
  const ErrorLayout layout = PoseLayout(solution.layout);
  const std::vector<int> components = PoseComponents(solution.layout);
  double largest = 0.0;
  double t = 0.0;
  std::string component;
  for (std::size_t k = 0; k < own.size(); ++k) {
    const ErrorVector d = Local(layout, StateAt(own[k]), StateAt(poses_[k]));
    const ErrorVector variances = solution.covariances.Variances(k)(components);
    for (int i = 0; i < layout.dim(); ++i) {
      const double sigmas = std::abs(d(i)) / std::sqrt(variances(i));
      if (!(sigmas > largest)) continue;
      largest = sigmas;
      t = own[k].t;
      component = layout.ComponentName(i);
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

ComparisonTerms TrajectoryTerms() {
  return {.what = "{} and {} are {:.2g} sigma apart in {} (limit {:.0f})",
          .causes = {"data that contradict each other, of which each method "
                     "believes others"},
          .remedies = {"what the other methods are told"}};
}

ComparisonTerms AttitudeTerms() {
  return {.of_all = true,
          .most_nodes = 20000,
          .what =
              "{} and {} are {:.2g} sigma of the less certain one apart in "
              "attitude",
          .causes = {"readings that contradict each other, or sigmas that are "
                     "too small"}};
}

MethodComparison::Course MethodComparison::CourseOf(
    const Solution& solution) const {
  const std::vector<int> components = PoseComponents(solution.layout);
  const std::size_t stride = solution.states.size() / terms_.most_nodes + 1;
  Course course = {.method = solution.method, .seeks = Seeks(solution.method)};
  for (std::size_t k = 0; k < solution.states.size(); k += stride) {
    course.poses.push_back(PoseOf(solution.states[k]));
    course.variances.emplace_back(
        solution.covariances.Variances(k)(components));
  }
  return course;
}

bool MethodComparison::Asks(const Solution& solution) const {
  const bool is_asked = terms_.of_all || (!solution.forward &&
                                          solution.grade != Grade::kUnusable);
  return is_asked && !solution.covariances.empty();
}

std::optional<Evidence> MethodComparison::Compare(const Solution& solution) {
  if (!Asks(solution)) return std::nullopt;
  const ErrorLayout layout = PoseLayout(solution.layout);
  Course own = CourseOf(solution);
  std::optional<Evidence> found;
  for (const Course& other : courses_) {
    if (!AreAtTheSameTimes(own.poses, other.poses)) continue;
    Variances squares = Variances::Zero(layout.dim());
    for (std::size_t k = 0; k < own.poses.size(); ++k) {
      const Variances apart =
          Local(layout, StateAt(own.poses[k]), StateAt(other.poses[k]));
      squares += apart.cwiseAbs2().cwiseQuotient(
          own.variances[k].cwiseMax(other.variances[k]));
    }
    int worst = 0;
    const double sigmas = std::sqrt(squares.maxCoeff(&worst) /
                                    static_cast<double>(own.poses.size()));
    if (!(sigmas > kUnusableBias) || (found && *found->value >= sigmas)) {
      continue;
    }
    found = Evidence{
        .rule = "disagreement",
        .grade = Grade::kDoubtful,
        .what = fmt::format(fmt::runtime(terms_.what), other.method, own.method,
                            sigmas, layout.ComponentName(worst), kUnusableBias),
        .value = sigmas,
        .limit = kUnusableBias,
        .unit = "sigma",
        .causes = terms_.causes,
        .remedies = terms_.remedies,
        .against = other.method};
  }
  courses_.push_back(std::move(own));
  return found;
}

MethodComparison::Variances MethodComparison::ExpectedSquares(
    const ErrorLayout& layout, const Course& sure, const Course& searched) {
  const bool same = AreAtTheSameTimes(sure.poses, searched.poses);
  Variances squares = Variances::Zero(layout.dim());
  for (std::size_t k = 0; k < sure.poses.size(); ++k) {
    const std::size_t i = same ? k : NearestTo(sure.poses[k].t, searched.poses);
    Variances expected = searched.variances[i];
    if (same) {
      const Variances apart =
          Local(layout, StateAt(sure.poses[k]), StateAt(searched.poses[i]));
      expected += apart.cwiseAbs2();
    }
    squares += expected.cwiseQuotient(sure.variances[k]);
  }
  return squares / static_cast<double>(sure.poses.size());
}

std::vector<std::pair<std::string, Evidence>> MethodComparison::TooSure(
    const Solution& solution) const {
  std::vector<std::pair<std::string, Evidence>> found;
  const bool seeks = Seeks(solution.method);
  const bool has_pair = std::ranges::any_of(
      courses_, [seeks](const Course& other) { return other.seeks != seeks; });
  if (!has_pair || !Asks(solution)) return found;
  const ErrorLayout layout = PoseLayout(solution.layout);
  const Course own = CourseOf(solution);
  for (const Course& other : courses_) {
    if (other.seeks == seeks) continue;
    const Course& sure = seeks ? other : own;
    const Course& searched = seeks ? own : other;
    int worst = 0;
    const double sigmas =
        std::sqrt(ExpectedSquares(layout, sure, searched).maxCoeff(&worst));
    if (!(sigmas > kUnusableBias)) continue;
    found.emplace_back(
        sure.method,
        Evidence{.rule = "too_sure",
                 .grade = Grade::kDoubtful,
                 .what = fmt::format(
                     "by the errors of sensors that {} finds or cannot rule "
                     "out, {} is {:.2g} sigma off (limit {:.0f})",
                     searched.method, layout.ComponentName(worst), sigmas,
                     kUnusableBias),
                 .value = sigmas,
                 .limit = kUnusableBias,
                 .unit = "sigma",
                 .causes = {"errors of a sensor that last longer than those of "
                            "its stated noise"},
                 .better_methods = {searched.method}});
  }
  return found;
}

}  // namespace hindsight
