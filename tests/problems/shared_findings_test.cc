#include "problems/shared_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/test_motion.h"

namespace hindsight {
namespace {

using ::testing::StartsWith;
using testing::TypicalLayout;

/// Usable.
Solution Solved(const std::string& method) {
  Solution solution;
  solution.method = method;
  solution.layout = TypicalLayout();
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
  std::vector<Solution> all = {Solved("batch"), Solved("ekf"),
                               Solved("robust_batch"), Solved("rts")};
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
  std::vector<Solution> all = {Solved("batch"), Solved("robust_batch"),
                               Solved("rts")};
  Evidence ended = DoubtOfSearch("was ended");
  ended.is_always_told = true;
  Add(ended, &all[1]);
  Add({.rule = "linearisation", .grade = Grade::kDoubtful}, &all[1]);
  Add({.rule = "linearisation", .grade = Grade::kDoubtful}, &all[2]);
  ShareFindings(&all);
  EXPECT_TRUE(all[0].usable());
}

}  // namespace
}  // namespace hindsight
