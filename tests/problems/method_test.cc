#include "problems/method.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "base/error.h"
#include "io/config/scenario_config.h"
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

}  // namespace
}  // namespace hindsight
