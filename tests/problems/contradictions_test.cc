#include "problems/contradictions.h"

#include <gtest/gtest.h>

#include "support/test_motion.h"

namespace hindsight {
namespace {

using testing::TypicalLayout;
using testing::TypicalState;

struct Told {
  ErrorLayout layout = TypicalLayout();
  Prior prior{TypicalState(), TypicalLayout().InitialCovariance()};
};

/// A first state that far, in a priori sigmas, from the prior in a component.
Solution Displaced(const Told& told, int component, double sigmas) {
  Solution solution;
  solution.layout = told.layout;
  ErrorVector d = ErrorVector::Zero(told.layout.dim());
  d(component) = sigmas * std::sqrt(told.prior.P(component, component));
  solution.states = {Retract(told.layout, told.prior.x, d)};
  return solution;
}

TEST(Contradictions, ComponentFarFromItsPriorIsNamed) {
  const Told told;
  EXPECT_TRUE(
      FindContradictions({}, told.prior, Displaced(told, 2, 4.9)).empty());
  for (const double sigmas : {5.1, -30.0}) {
    const auto found =
        FindContradictions({}, told.prior, Displaced(told, 2, sigmas));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].find("position[down] at the start "), 0u) << found[0];
  }
  // Of a start that lies elsewhere nothing is known.
  Solution later = Displaced(told, 2, 30.0);
  later.states.front().t += 1.0;
  EXPECT_TRUE(FindContradictions({}, told.prior, later).empty());
}

TEST(Contradictions, SensorThatLostMostOfItsMeasurementsIsNamed) {
  const Told told;
  std::vector<Sensor> sensors(2);
  sensors[0].name = "dvl";
  sensors[1].name = "depth";
  Solution solution;
  const auto add = [&](int sensor, bool accepted, bool withheld) {
    ResidualRecord record;
    record.sensor = sensor;
    record.accepted = accepted;
    record.withheld = withheld;
    solution.residuals.push_back(record);
  };
  for (int k = 0; k < 4; ++k) {
    add(0, k % 2 == 0, false);
    add(1, k == 0, false);
    add(1, true, true);
  }
  const auto found = FindContradictions(sensors, told.prior, solution);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].find("3 of 4 measurements of depth "), 0u) << found[0];
}

}  // namespace
}  // namespace hindsight
