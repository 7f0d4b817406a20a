#include "problems/method.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/error.h"
#include "io/config/scenario_config.h"
#include "problems/method_stage.h"
#include "problems/reconstruction.h"
#include "simulation/scenario.h"

namespace hindsight {
namespace {

TEST(Method, EachHasANameOfItsOwnHelpAndOneFunction) {
  std::set<std::string> names;
  for (const Method* method : Methods()) {
    SCOPED_TRACE(method->name);
    EXPECT_TRUE(names.insert(method->name).second);
    EXPECT_EQ(&MethodOf(method->name), method);
    EXPECT_GT(std::string(method->help).size(), 5u);
    EXPECT_TRUE(
        std::visit([](auto run) { return run != nullptr; }, method->run));
    EXPECT_NE(MethodNames(method->attitude_alone()).find(method->name),
              std::string::npos);
  }
}

TEST(Method, AnUnknownNameIsRefusedWithThoseThatAreKnown) {
  try {
    MethodOf("magic");
    FAIL();
  } catch (const InputError& error) {
    const std::string words = error.what();
    EXPECT_NE(words.find("'magic'"), std::string::npos) << words;
    for (const Method* method : Methods()) {
      EXPECT_NE(words.find(method->name), std::string::npos) << words;
    }
  }
}

TEST(Method, OfTheOtherKindIsRefused) {
  const Dataset dataset = Simulate(FindScenario("short_drive"), 1);
  EXPECT_THROW(Reconstruction(dataset, {}).Run("ahrs"), InputError);
  EXPECT_THROW(Reconstruction(dataset, AttitudeAlone()).Run("batch"),
               InputError);
}

/// The smoother's trajectory by another name, which nothing but this file knows.
Solution RunTwin(MethodStage* stage) {
  const SmoothedTrajectory& smoothed = stage->forward().smoothed();
  return stage->FromSmoothed(smoothed.states, smoothed.P, stage->SharedNodes());
}

TEST(MadeUpMethod, RunsIsHelpedWithAndIsPreferredLeast) {
  static constexpr Method kTwin = {
      .name = "twin",
      .help = "the smoother once more, made up for a test",
      .traits = TraitsOf({MethodTrait::kLinearisesOnce}),
      .run = RunTwin};
  AddMethod(kTwin);
  EXPECT_THROW(AddMethod(kTwin), std::invalid_argument);
  EXPECT_TRUE(MethodNames(false).ends_with(", twin"));
  EXPECT_NE(MethodHelp(false).find("  twin           the smoother once"),
            std::string::npos);
  const Dataset dataset = Simulate(FindScenario("short_drive"), 1);
  Reconstruction reconstruction(dataset, {});
  std::vector<Solution> solutions = {reconstruction.Run("twin"),
                                     reconstruction.Run("rts")};
  EXPECT_EQ(solutions[0].method, "twin");
  EXPECT_EQ(solutions[0].grade, solutions[1].grade);
  ASSERT_EQ(solutions[0].states.size(), solutions[1].states.size());
  EXPECT_EQ(solutions[0].states[7].p_e, solutions[1].states[7].p_e);
  EXPECT_EQ(Best(solutions).method, "rts");
}

}  // namespace
}  // namespace hindsight
