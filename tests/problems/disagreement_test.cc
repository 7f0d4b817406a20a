#include "problems/disagreement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/test_motion.h"

namespace hindsight {
namespace {

using testing::TypicalLayout;
using testing::TypicalState;

/// Three nodes; the second is `sigmas` of `component` elsewhere.
Solution Ended(int component, double sigmas,
               const ErrorLayout& layout = TypicalLayout()) {
  Solution solution;
  solution.layout = layout;
  const int dim = solution.layout.dim();
  solution.covariances = CovarianceSeries(dim, 3);
  for (int k = 0; k < 3; ++k) {
    State x = TypicalState();
    if (k == 1) {
      ErrorVector d = ErrorVector::Zero(dim);
      d(component) = 1e-3 * sigmas;
      x = Retract(solution.layout, x, d);
    }
    x.t = k;
    solution.states.push_back(x);
    const ErrorMatrix P = 1e-6 * ErrorMatrix::Identity(dim, dim);
    solution.covariances.Set(static_cast<std::size_t>(k), P);
  }
  return solution;
}

TEST(OptimumComparison, MethodsThatEndMoreThanASigmaApartAreDoubtful) {
  for (const int component : {0, 2, 6, 8}) {
    OptimumComparison comparison;
    EXPECT_FALSE(comparison.Compare("iterated", Ended(component, 0.0)));
    EXPECT_FALSE(comparison.Compare("batch", Ended(component, 0.9)));
    const auto found = comparison.Compare("batch", Ended(component, -1.1));
    ASSERT_TRUE(found) << component;
    EXPECT_EQ(found->grade, Grade::kDoubtful);
    EXPECT_EQ(found->against, "iterated");
    EXPECT_EQ(found->t_begin, 1.0);
    EXPECT_NEAR(*found->value, 1.1, 1e-3);
    EXPECT_THAT(found->what,
                ::testing::HasSubstr("iterated and batch end 1.1"));
  }
}

TEST(OptimumComparison, OtherNodesAndFailuresAreNotCompared) {
  OptimumComparison comparison;
  Solution failed = Ended(0, 50.0);
  failed.converged = false;
  EXPECT_FALSE(comparison.Compare("iterated", failed));
  EXPECT_FALSE(comparison.Compare("iterated", Ended(0, 0.0)));
  EXPECT_FALSE(comparison.Compare("batch", failed));
  Solution moved = Ended(0, 50.0);
  moved.states[2].t += 0.1;
  EXPECT_FALSE(comparison.Compare("batch", moved));
}

Solution EndedBy(const char* method, int component, double sigmas) {
  Solution solution = Ended(component, sigmas);
  solution.method = method;
  return solution;
}

TEST(MethodComparison, TwoThatMayBothBeUsedAreDoubtfulWhereTheyAreFarApart) {
  // One node of three: in the root mean square 1/sqrt(3) of it.
  for (const int component : {0, 2, 6, 8}) {
    MethodComparison comparison(TrajectoryTerms());
    EXPECT_FALSE(comparison.Compare(EndedBy("batch", component, 0.0)));
    EXPECT_FALSE(comparison.Compare(EndedBy("rts", component, 5.0)));
    const auto found =
        comparison.Compare(EndedBy("imm_smoother", component, -5.4));
    ASSERT_TRUE(found) << component;
    EXPECT_EQ(found->grade, Grade::kDoubtful);
    EXPECT_EQ(found->against, "rts");
    EXPECT_NEAR(*found->value, 10.4 / std::sqrt(3.0), 0.01);
  }
}

TEST(MethodComparison, WhatIsRefutedForwardOrElsewhereSaysNothing) {
  MethodComparison comparison(TrajectoryTerms());
  Solution refuted = EndedBy("batch", 0, 50.0);
  refuted.grade = Grade::kUnusable;
  EXPECT_FALSE(comparison.Compare(refuted));
  Solution forward = EndedBy("ekf", 0, 50.0);
  forward.forward = true;
  EXPECT_FALSE(comparison.Compare(forward));
  Solution moved = EndedBy("robust_batch", 0, 50.0);
  moved.states[2].t += 0.1;
  EXPECT_FALSE(comparison.Compare(moved));
  EXPECT_FALSE(comparison.Compare(EndedBy("rts", 0, 0.0)));
}

/// With the variances of `component` `factor` times as large.
Solution Widened(Solution solution, int component, double factor) {
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    ErrorMatrix P = solution.covariances.Get(k);
    P(component, component) *= factor;
    solution.covariances.Set(k, P);
  }
  return solution;
}

TEST(MethodComparison, IsTooSureWhoseErrorsASearchKnowsToBeThreeSigmas) {
  const auto sigmas = [](const Solution& first, const Solution& second) {
    MethodComparison comparison(TrajectoryTerms());
    EXPECT_TRUE(comparison.TooSure(first).empty());
    comparison.Compare(first);
    const auto found = comparison.TooSure(second);
    if (found.empty()) return 0.0;
    EXPECT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].first, "rts");
    EXPECT_EQ(found[0].second.grade, Grade::kDoubtful);
    EXPECT_THAT(found[0].second.better_methods,
                ::testing::ElementsAre("robust_batch"));
    return *found[0].second.value;
  };
  for (const int component : {0, 2, 6, 8}) {
    const Solution plain = EndedBy("rts", component, 0.0);
    const auto held = [&](double factor, double moved) {
      return Widened(EndedBy("robust_batch", component, moved), component,
                     factor);
    };
    EXPECT_NEAR(sigmas(plain, held(10.0, 0.0)), std::sqrt(10.0), 1e-6);
    EXPECT_NEAR(sigmas(held(10.0, 0.0), plain), std::sqrt(10.0), 1e-6);
    EXPECT_EQ(sigmas(plain, held(8.9, 0.0)), 0.0);
    // Its own moves add to what it does not know: of one node of three.
    EXPECT_NEAR(sigmas(plain, held(8.0, 3.0)), std::sqrt(8.0 + 3.0), 1e-3);
    // Two that take sensors at their word say nothing of each other.
    MethodComparison comparison(TrajectoryTerms());
    comparison.Compare(plain);
    EXPECT_TRUE(
        comparison
            .TooSure(Widened(EndedBy("batch", component, 0.0), component, 20.0))
            .empty());
  }
}

TEST(MethodComparison, OfOtherNodesTheVariancesAloneSayWhoIsTooSure) {
  const Solution plain = EndedBy("batch", 0, 0.0);
  for (const double shift : {0.0, 0.1, -0.1, 0.9}) {
    Solution searched = Widened(EndedBy("robust_batch", 0, 9.0), 0, 8.0);
    for (State& x : searched.states) x.t += shift;
    MethodComparison comparison(TrajectoryTerms());
    comparison.Compare(plain);
    EXPECT_EQ(comparison.TooSure(searched).size(), shift == 0.0 ? 1u : 0u);
    searched = Widened(searched, 0, 2.0);
    EXPECT_EQ(comparison.TooSure(searched).size(), 1u) << shift;
  }
}

TEST(MethodComparison, ForwardOrRefutedNoneIsTooSure) {
  MethodComparison comparison(TrajectoryTerms());
  Solution forward = EndedBy("ekf", 0, 0.0);
  forward.forward = true;
  comparison.Compare(forward);
  Solution searched = Widened(EndedBy("robust_batch", 0, 0.0), 0, 100.0);
  EXPECT_TRUE(comparison.TooSure(searched).empty());
  comparison.Compare(EndedBy("batch", 0, 0.0));
  EXPECT_EQ(comparison.TooSure(searched).size(), 1u);
  searched.grade = Grade::kUnusable;
  EXPECT_TRUE(comparison.TooSure(searched).empty());
}

TEST(MethodComparison, OfAttitudeAloneTheForwardMethodIsAskedToo) {
  ErrorLayout layout;
  for (const BlockKind kind : {BlockKind::kGyroBias, BlockKind::kAttitude}) {
    layout.Add(*TypicalLayout().Find(kind));
  }
  // A bias elsewhere is none of its concern.
  for (const int component : {0, 3, 5}) {
    MethodComparison comparison(AttitudeTerms());
    Solution filter = Ended(component, 0.0, layout);
    filter.method = "ahrs";
    filter.forward = true;
    EXPECT_FALSE(comparison.Compare(filter));
    Solution smoother = Ended(component, 6.0, layout);
    smoother.method = "ahrs_smoother";
    const auto found = comparison.Compare(smoother);
    ASSERT_EQ(found.has_value(), component >= 3);
    if (!found) continue;
    EXPECT_EQ(found->what,
              "ahrs and ahrs_smoother are 3.5 sigma of the less certain one "
              "apart in attitude");
    EXPECT_EQ(found->against, "ahrs");
  }
}

}  // namespace
}  // namespace hindsight
