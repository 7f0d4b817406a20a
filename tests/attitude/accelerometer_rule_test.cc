#include "attitude/accelerometer_rule.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace hindsight {
namespace {

TEST(AccelerometerRule, GatePassesOverAboveItsLimitAlone) {
  GateRule gate{0.3, 0.88};
  EXPECT_DOUBLE_EQ(gate.Variance(0.88), 0.09);
  EXPECT_TRUE(std::isinf(gate.Variance(0.89)));
  EXPECT_DOUBLE_EQ(gate.Variance(0.0), 0.09);
}

TEST(AccelerometerRule, HeldGateStaysClosedForNSamples) {
  HeldGateRule gate{0.3, 0.88, 2};
  EXPECT_TRUE(std::isinf(gate.Variance(1.0)));
  EXPECT_TRUE(std::isinf(gate.Variance(0.0)));
  EXPECT_TRUE(std::isinf(gate.Variance(0.0)));
  EXPECT_DOUBLE_EQ(gate.Variance(0.0), 0.09);
}

TEST(AccelerometerRule, SmncSumsTheLastNPlusOneSquares) {
  SmncRule smnc(0.3, 0.05, 2);
  EXPECT_NEAR(smnc.Variance(1.0), 0.09 + 0.05 * 1.0, 1e-15);
  EXPECT_NEAR(smnc.Variance(2.0), 0.09 + 0.05 * 5.0, 1e-15);
  EXPECT_NEAR(smnc.Variance(3.0), 0.09 + 0.05 * 14.0, 1e-15);
  // The first has left the window.
  EXPECT_NEAR(smnc.Variance(0.0), 0.09 + 0.05 * 13.0, 1e-15);
}

TEST(AccelerometerRule, SmncWeighsByAge) {
  SmncRule smnc(0.0, 1.0, std::vector<double>{1.0, 0.5, 0.25});
  smnc.Variance(4.0);
  smnc.Variance(2.0);
  EXPECT_NEAR(smnc.Variance(1.0), 1.0 + 0.5 * 4.0 + 0.25 * 16.0, 1e-14);
}

TEST(AccelerometerRule, SmncWithNZeroIsTheAdaptiveRule) {
  SmncRule smnc(0.3, 0.25, 0);
  AdaptiveRule adaptive{0.3, 0.25};
  for (const double s : {0.0, 3.0, 0.2, 7.0}) {
    EXPECT_NEAR(smnc.Variance(s), adaptive.Variance(s), 1e-13);
  }
}

TEST(AccelerometerRule, RulesAreMadeAtEqualLambdaTimesNPlusOne) {
  AccelerometerRuleOptions options;
  options.name = "adaptive";
  options.lambda = 0.05;
  options.N = 4;
  EXPECT_DOUBLE_EQ(
      std::get<AdaptiveRule>(MakeAccelerometerRule(options)).lambda, 0.25);
  EXPECT_EQ(SamplesIn(0.4, 0.1), 4);
  options.name = "trust";
  EXPECT_THROW(MakeAccelerometerRule(options), InputError);
}

}  // namespace
}  // namespace hindsight
