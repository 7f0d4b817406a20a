#include "problems/method.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "base/error.h"
#include "problems/attitude.h"
#include "problems/reconstruction.h"
#include "simulation/builtin_scenarios.h"
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
    EXPECT_NE(method->reconstruct == nullptr,
              method->estimate_attitude == nullptr);
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
  const Dataset dataset = Simulate(BuiltinScenario("short_drive"), 1);
  EXPECT_THROW(Reconstruction(dataset, {}).Run("ahrs"), InputError);
  EXPECT_THROW(AttitudeEstimation(dataset, {}).Run("batch"), InputError);
}

}  // namespace
}  // namespace hindsight
