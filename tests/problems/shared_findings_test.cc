#include "problems/shared_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/test_motion.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using testing::TypicalLayout;
using testing::TypicalState;

constexpr std::size_t kNodes = 3;

/// Usable; so many metres north of where all are, with such a sigma.
Solution Solved(const std::string& method, double north, double sigma) {
  Solution solution;
  solution.method = method;
  solution.layout = TypicalLayout();
  const int dim = solution.layout.dim();
  solution.covariances = CovarianceSeries(dim, kNodes);
  for (std::size_t k = 0; k < kNodes; ++k) {
    ErrorVector d = ErrorVector::Zero(dim);
    d(0) = north;
    State x = Retract(solution.layout, TypicalState(), d);
    x.t = static_cast<double>(k);
    solution.states.push_back(x);
    solution.covariances.Set(
        k, ErrorMatrix(sigma * sigma * ErrorMatrix::Identity(dim, dim)));
  }
  return solution;
}

Evidence DoubtOfSearch(const std::string& what) {
  return {.rule = "search", .grade = Grade::kDoubtful, .what = what};
}

void Add(const Evidence& evidence, Solution* solution) {
  solution->evidence.push_back(evidence);
  solution->grade = GradeOf(solution->evidence);
}

TEST(ShareFindings, WhatTheSearchDoubtsHoldsForAllThatSeeTheWholeInterval) {
  std::vector<Solution> all = {
      Solved("batch", 0.0, 1.0), Solved("ekf", 0.0, 1.0),
      Solved("robust_batch", 0.0, 1.0), Solved("rts", 0.0, 1.0)};
  all[1].forward = true;
  ShareFindings(&all);
  for (const Solution& one : all) EXPECT_TRUE(one.usable()) << one.method;
  Add(DoubtOfSearch("gnss errs"), &all[2]);
  for (int twice = 0; twice < 2; ++twice) {
    ShareFindings(&all);
    EXPECT_EQ(all[0].grade, Grade::kDoubtful);
    ASSERT_EQ(all[0].evidence.size(), 1u);
    EXPECT_EQ(all[0].evidence[0].what, "robust_batch: gnss errs");
    EXPECT_THAT(all[0].verdict,
                StartsWith("doubtful: robust_batch: gnss errs"));
    EXPECT_TRUE(all[1].usable());
    EXPECT_EQ(all[2].evidence.size(), 1u);
    EXPECT_EQ(all[3].grade, Grade::kDoubtful);
  }
}

/// That there was no time for a search says nothing of the recording, and what any other
/// method is doubted by is its own.
TEST(ShareFindings, ASearchThatWasEndedSaysNothing) {
  std::vector<Solution> all = {Solved("batch", 0.0, 1.0),
                               Solved("robust_batch", 0.0, 1.0),
                               Solved("rts", 0.0, 1.0)};
  Evidence ended = DoubtOfSearch("was ended");
  ended.is_always_told = true;
  Add(ended, &all[1]);
  Add({.rule = "linearisation", .grade = Grade::kDoubtful}, &all[1]);
  Add({.rule = "linearisation", .grade = Grade::kDoubtful}, &all[2]);
  ShareFindings(&all);
  EXPECT_TRUE(all[0].usable());
}

/// Three sigmas off in all axes: by what the search leaves open, or by the distance, an
/// axis of three.
TEST(ShareFindings, WhoIsTooSureByTheSearchIsDoubtful) {
  const auto grade = [](double north, double sigma) {
    std::vector<Solution> all = {Solved("batch", 0.0, 1.0),
                                 Solved("robust_batch", north, sigma)};
    ShareFindings(&all);
    EXPECT_TRUE(all[1].usable());
    if (!all[0].usable()) {
      EXPECT_THAT(all[0].evidence[0].what,
                  HasSubstr("robust_batch finds errors of sensors by which "
                            "positions are 3.1 sigma off (limit 3)"));
      EXPECT_THAT(all[0].evidence[0].better_methods,
                  ::testing::ElementsAre("robust_batch"));
    }
    return all[0].grade;
  };
  EXPECT_EQ(grade(0.0, 2.9), Grade::kUsable);
  EXPECT_EQ(grade(0.0, 3.1), Grade::kDoubtful);
  // d^2 / 3 + sigma^2.
  EXPECT_EQ(grade(std::sqrt(3.0 * (2.9 * 2.9 - 1.0)), 1.0), Grade::kUsable);
  EXPECT_EQ(grade(std::sqrt(3.0 * (3.1 * 3.1 - 1.0)), 1.0), Grade::kDoubtful);
  // Less sure than the search.
  std::vector<Solution> all = {Solved("batch", 0.0, 5.0),
                               Solved("robust_batch", 8.0, 0.1)};
  ShareFindings(&all);
  EXPECT_TRUE(all[0].usable());
}

TEST(ShareFindings, SolutionsOnOtherNodesAreNotCompared) {
  std::vector<Solution> all = {Solved("batch", 0.0, 1.0),
                               Solved("robust_batch", 50.0, 1.0)};
  for (State& x : all[0].states) x.t += 0.5;
  ShareFindings(&all);
  EXPECT_TRUE(all[0].usable());
}

}  // namespace
}  // namespace hindsight
