#include "problems/blunders.h"

#include <gtest/gtest.h>

#include "earth/wgs84.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

TestProblem Drive() {
  TestProblemOptions options;
  options.layout = TypicalLayout(options.noise);
  options.velocity_sigma = 0.0;
  return MakeProblem(options, 1);
}

void MoveToPole(std::size_t i, TestProblem* problem) {
  std::get<PositionFix>(problem->measurements[i].model).p_e =
      EcefFromGeodetic({1.5707963267948966, 0.0, 0.0});
}

TEST(Blunders, AreNoneOfAReceiverThatErrsByHundredsOfMetres) {
  TestProblem problem = Drive();
  for (std::size_t i = 5; i < 10; ++i) {
    std::get<PositionFix>(problem.measurements[i].model).p_e.x() += 900.0;
  }
  EXPECT_TRUE(FindBlunders(problem.MakeTimeline()).empty());
}

TEST(Blunders, AreFixesAtAPoleWhereverTheyStand) {
  for (const std::size_t at : {std::size_t{0}, std::size_t{7}}) {
    TestProblem problem = Drive();
    MoveToPole(at, &problem);
    MoveToPole(at + 1, &problem);
    EXPECT_EQ(FindBlunders(problem.MakeTimeline()),
              (std::vector<std::size_t>{at, at + 1}));
  }
}

}  // namespace
}  // namespace hindsight
