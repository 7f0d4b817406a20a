#include "state/chart.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "base/random.h"
#include "base/units.h"
#include "state/random_error.h"

namespace hindsight {
namespace {

using testing::RandomError;

ErrorLayout LayoutWithParameters() {
  ErrorLayout layout = NavigationLayout({});
  Block block;
  block.key = {BlockKind::kLeverArm, 0};
  block.name = "lever_arm";
  layout.Add(block);
  block.key = {BlockKind::kScale, 1};
  block.name = "scale";
  layout.Add(block);
  return layout;
}

State StateWithParameters() {
  State x = MakeState(0.0, {37.0 * kDegree, 127.0 * kDegree, 50.0},
                      {12.0, -7.0, 0.5}, {0.1, -0.2, 2.1});
  x.b_g = {1e-3, -2e-3, 1.5e-3};
  x.b_a = {0.02, 0.03, -0.05};
  return x;
}

class ChartOfKind : public ::testing::TestWithParam<ChartKind> {
 protected:
  ChartOfKind() : layout_(LayoutWithParameters()), x_(StateWithParameters()) {
    x_.parameters = ParameterVector::Zero(layout_.parameter_count());
    Random random(4);
    for (double& value : x_.parameters) value = 0.1 * random.Normal();
    origin_e_ = x_.p_e + Eigen::Vector3d(3000.0, -2000.0, 500.0);
  }
  Chart MakeChart() const { return {layout_, GetParam(), x_, origin_e_}; }

  ErrorLayout layout_;
  State x_;
  Eigen::Vector3d origin_e_;
};

TEST_P(ChartOfKind, StateOfCoordinatesIsTheState) {
  const Chart chart = MakeChart();
  Random random(1);
  for (int i = 0; i < 10; ++i) {
    const State x = Retract(layout_, x_, RandomError(layout_, &random, 0.05));
    const State y = chart.ToState(chart.Coordinates(x));
    EXPECT_LT(Local(layout_, x, y).cwiseAbs().maxCoeff(), 2e-8);
  }
}

TEST_P(ChartOfKind, JacobianIsTheDerivativeOfTheCoordinates) {
  const Chart chart = MakeChart();
  Random random(2);
  const State x = Retract(layout_, x_, RandomError(layout_, &random, 0.03));
  const ErrorMatrix J = chart.Jacobian(x);
  for (int j = 0; j < layout_.dim(); ++j) {
    const double h = j < 3 ? 1.0 : 1e-5;
    ErrorVector d = ErrorVector::Zero(layout_.dim());
    d(j) = h;
    const ErrorVector numeric = (chart.Coordinates(Retract(layout_, x, d)) -
                                 chart.Coordinates(Retract(layout_, x, -d))) /
                                (2.0 * h);
    // Positions of 6e6 m carry 1e-9 m of rounding, which h = 1e-5 leaves at
    // 1e-4 of a metre a unit; elsewhere truncation and rounding are below 1e-8.
    for (int i = 0; i < layout_.dim(); ++i) {
      const bool rounding = i < 3 && j >= 3;
      EXPECT_NEAR(J(i, j), numeric(i), rounding ? 2e-4 : 2e-7)
          << i << ", " << j;
    }
  }
}

TEST_P(ChartOfKind, AnglesAreContinuedAcrossTheFold) {
  State x = MakeState(0.0, {0.5, kPi - 1e-7, 0.0}, {1.0, 0.0, 0.0},
                      {kPi - 1e-3, 0.1, kPi - 1e-3});
  x.parameters = x_.parameters;
  const Chart chart(layout_, GetParam(), x, origin_e_);
  ErrorVector d = ErrorVector::Zero(layout_.dim());
  d(1) = 5.0;
  d(8) = 0.002;
  const ErrorVector step =
      chart.Coordinates(Retract(layout_, x, d)) - chart.Coordinates(x);
  EXPECT_LT((step - chart.Jacobian(x) * d).cwiseAbs().maxCoeff(), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ChartOfKind,
                         ::testing::Values(ChartKind::kAdditive,
                                           ChartKind::kEuler));

TEST(Chart, EulerCoordinatesAreLatitudeLongitudeHeightVelocityAngles) {
  const ErrorLayout layout = NavigationLayout({});
  const State x =
      MakeState(0.0, {0.6, -1.2, 80.0}, {3.0, -2.0, 0.5}, {0.1, -0.2, 2.5});
  const ErrorVector xi =
      Chart(layout, ChartKind::kEuler, x, x.p_e).Coordinates(x);
  const double expected[] = {0.6, -1.2, 80.0, 3.0, -2.0, 0.5, 0.1, -0.2, 2.5};
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(xi(i), expected[i], 1e-8) << i;
}

TEST(Chart, AdditiveCoordinatesAreMetresFromTheOrigin) {
  const ErrorLayout layout = NavigationLayout({});
  State x = MakeState(0.0, {0.0, 0.0, 0.0}, {3.0, -2.0, 0.5}, {0.1, -0.2, 2.5});
  x.b_a = {0.1, 0.2, 0.3};
  // At latitude and longitude zero north, east and down are e's z, y and -x.
  const Eigen::Vector3d origin_e = x.p_e - Eigen::Vector3d(7.0, 20.0, 100.0);
  const ErrorVector xi =
      Chart(layout, ChartKind::kAdditive, x, origin_e).Coordinates(x);
  ErrorVector expected = ErrorVector::Zero(15);
  expected.head<6>() << 100.0, 20.0, -7.0, 3.0, -2.0, 0.5;
  expected.segment<3>(12) = x.b_a;
  EXPECT_LT((xi - expected).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Chart, RefusesALayoutWithoutTheNavigationBlocks) {
  ErrorLayout layout;
  Block block;
  block.key = {BlockKind::kAttitude};
  layout.Add(block);
  const State x = StateWithParameters();
  EXPECT_THROW(Chart(layout, ChartKind::kEuler, x, x.p_e), std::logic_error);
}

}  // namespace
}  // namespace hindsight
