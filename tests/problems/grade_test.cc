#include <gtest/gtest.h>

#include <limits>

#include "problems/reconstruction.h"
#include "problems/verdict.h"
#include "simulation/in_flight_alignment.h"

namespace hindsight {
namespace {

/// The prefix of a verdict that has nothing to object to.
const std::string kObserved = "usable: every navigation state is observed";

std::vector<std::string> KeptAtPriors(const Solution& solution) {
  std::vector<std::string> names;
  for (const ConstantEstimate& c : solution.constants) {
    if (c.verdict == ConstantEstimate::Verdict::kUnobserved) {
      names.push_back(c.name);
    }
  }
  return names;
}

TEST(Verdict, NamesTheConstantsThatStayAtTheirPriors) {
  const Dataset dataset = Simulate(InFlightAlignment({}), 1);
  ReconstructionOptions options;
  options.to = kFirstManoeuvre + 2.0;
  Reconstruction reconstruction(dataset, options);
  for (const Method method : {Method::kEkf, Method::kBatch}) {
    const Solution solution = reconstruction.Run(method);
    const std::vector<std::string> names = KeptAtPriors(solution);
    ASSERT_GT(names.size(), 1u);
    ASSERT_LE(names.size(), 6u);
    std::string expected = kObserved + "; " + std::to_string(names.size()) +
                           " constants are kept at their priors: ";
    for (const std::string& name : names) {
      expected += (name == names.front() ? "" : ", ") + name;
    }
    EXPECT_EQ(solution.verdict, expected);
  }
}

TEST(Verdict, SaysNothingOfConstantsWhereAllAreObserved) {
  const Dataset dataset = Simulate(InFlightAlignment({}), 1);
  const Solution solution = Solve(dataset, {});
  EXPECT_TRUE(KeptAtPriors(solution).empty());
  EXPECT_EQ(solution.verdict, kObserved);
}

TEST(Verdict, WhatIsNotFiniteIsNotUsable) {
  const Dataset dataset = Simulate(InFlightAlignment({}), 1);
  Solution solution = Solve(dataset, {});
  ASSERT_TRUE(solution.usable());
  ErrorMatrix P = solution.covariances.Get(3);
  P(0, 0) = std::numeric_limits<double>::quiet_NaN();
  solution.covariances.Set(3, P);
  Conclude({}, {}, "", &solution);
  EXPECT_FALSE(solution.usable());
  EXPECT_NE(solution.verdict.find("not finite"), std::string::npos);
}

}  // namespace
}  // namespace hindsight
