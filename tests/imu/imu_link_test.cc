#include "imu/imu_link.h"

#include <gtest/gtest.h>

#include "earth/wgs84.h"
#include "support/test_motion.h"

namespace hindsight {
namespace {

using testing::LivelyImu;
using testing::RandomError;
using testing::RichLayout;
using testing::TypicalLayout;
using testing::TypicalState;

ImuNoise SomeNoise() {
  ImuNoise noise;
  noise.gyro_noise_density = 1e-4;
  noise.accel_noise_density = 1e-3;
  noise.gyro_bias_walk = 1e-6;
  noise.accel_bias_walk = 1e-5;
  noise.gyro_bias_tau = 300.0;
  return noise;
}

TEST(ImuLink, PredictionLeavesNoResidual) {
  const ImuStream stream = LivelyImu(3.0, 100.0, SomeNoise());
  const ErrorLayout layout = TypicalLayout(SomeNoise());
  const State x_i = TypicalState();
  for (const double dt : {0.004, 0.1, 1.0, 2.5}) {
    const ImuSummary s = ImuIntegrator(stream).Summarize(
        0.2, 0.2 + dt, CalibrationOf(layout, x_i));
    ImuLink link;
    EvaluateLink(layout, s, x_i, Predict(layout, x_i, s), false, &link);
    EXPECT_LT(link.residual.norm(), 3e-9) << dt;
  }
}

TEST(ImuLink, StepwiseAndWholePredictionAgree) {
  // The gravitation quadrature is the only approximation: below 5e-7 over 1 s.
  const ImuStream stream = LivelyImu(1.0, 200.0);
  const ErrorLayout layout = TypicalLayout();
  const State x0 = TypicalState();
  ImuIntegrator integrator(stream);
  const State whole = Predict(
      layout, x0, integrator.Summarize(0.0, 1.0, CalibrationOf(layout, x0)));
  State x = x0;
  for (int k = 0; k < 200; ++k) {
    x = Predict(layout, x,
                integrator.Summarize(k * 0.005, (k + 1) * 0.005,
                                     CalibrationOf(layout, x)));
  }
  const ErrorVector d = Local(layout, whole, x);
  EXPECT_LT(d.segment<3>(0).norm(), 5e-7);
  EXPECT_LT(d.segment<3>(3).norm(), 5e-7);
  EXPECT_LT(d.segment<3>(6).norm(), 1e-9);
}

TEST(ImuLink, StandstillOnTheRotatingEarthStaysPut) {
  // Reaction to gravity and Earth rate, constant in body axes: nothing moves.
  for (const double latitude : {-89.9999, -30.0, 0.0, 52.0, 90.0}) {
    const State x0 = MakeState(0.0, {latitude * kDegree, 3.1, 100.0},
                               {0.0, 0.0, 0.0}, {0.02, -0.03, 1.0});
    ImuStream stream;
    for (int k = 0; k <= 1000; ++k) {
      stream.samples.push_back({k * 0.01, x0.q_eb.conjugate() * EarthRate_e(),
                                x0.q_eb.conjugate() * (-Gravity(x0.p_e))});
    }
    ImuIntegrator integrator(stream);
    const ErrorLayout layout = TypicalLayout();
    State x = x0;
    for (int k = 0; k < 10; ++k) {
      x = Predict(layout, x, integrator.Summarize(k, k + 1.0, {}));
    }
    EXPECT_LT((x.p_e - x0.p_e).norm(), 1e-6) << latitude;
    EXPECT_LT(x.v_e.norm(), 1e-6) << latitude;
    EXPECT_LT(x.q_eb.angularDistance(x0.q_eb), 1e-10) << latitude;
  }
}

TEST(ImuLink, JacobiansMatchNumericDifference) {
  const ErrorLayout layout = RichLayout(SomeNoise());
  const ImuStream stream = LivelyImu(3.0, 100.0, SomeNoise());
  Random random(3);
  State x_i = TypicalState();
  x_i.parameters = ParameterVector::Zero(layout.parameter_count());
  x_i.parameters.head<6>() << 1e-3, 2e-3, -1e-3, 5e-4, -1e-3, 2e-3;
  const ImuSummary s = ImuIntegrator(stream, true).Summarize(0.5, 2.0, {});
  State x_j = Predict(layout, x_i, s);
  x_j = Retract(layout, x_j, RandomError(layout, &random, 0.01));
  ImuLink link;
  EvaluateLink(layout, s, x_i, x_j, true, &link);
  const auto residual = [&](const ErrorVector& d_i, const ErrorVector& d_j) {
    ImuLink moved;
    EvaluateLink(layout, s, Retract(layout, x_i, d_i),
                 Retract(layout, x_j, d_j), false, &moved);
    return moved.residual;
  };
  const ErrorVector zero = ErrorVector::Zero(layout.dim());
  for (int c = 0; c < 21; ++c) {
    // Positions of 6.4e6 m carry 1e-9 m of rounding.
    const double h = c < 3 ? 1.0 : 1e-4;
    const double tolerance = c < 3 ? 1e-8 : 5e-5;
    ErrorVector step = zero;
    step(c) = h;
    const auto J_i =
        ((residual(step, zero) - residual(-step, zero)) / (2 * h)).eval();
    if (c < 15) {
      const auto J_j =
          ((residual(zero, step) - residual(zero, -step)) / (2 * h)).eval();
      EXPECT_LT((J_i - link.J_i.col(c)).norm(), tolerance) << c;
      EXPECT_LT((J_j - link.J_j.col(c)).norm(), tolerance) << c;
    } else {
      EXPECT_LT((J_i - link.J_s.col(c - 15)).norm(), tolerance) << c;
    }
  }
}

TEST(ImuLink, TransitionMatchesNumericDifferenceOfPropagation) {
  const ErrorLayout layout = RichLayout(SomeNoise());
  const ImuStream stream = LivelyImu(3.0, 100.0, SomeNoise());
  State x_i = TypicalState();
  x_i.parameters = ParameterVector::Constant(layout.parameter_count(), 1e-3);
  const ImuSummary s = ImuIntegrator(stream, true)
                           .Summarize(0.5, 1.5, CalibrationOf(layout, x_i));
  const State x_j = Predict(layout, x_i, s);
  Transition transition;
  LinearizeTransition(layout, s, x_i, x_j, &transition);
  EXPECT_LT(transition.c.norm(), 1e-8);
  for (int c = 0; c < layout.dim(); ++c) {
    const double h = c < 3 ? 1.0 : 1e-4;
    const double tolerance = c < 3 ? 1e-8 : 5e-5;
    ErrorVector step = ErrorVector::Zero(layout.dim());
    step(c) = h;
    const ErrorVector plus =
        Local(layout, x_j, Predict(layout, Retract(layout, x_i, step), s));
    const ErrorVector minus =
        Local(layout, x_j, Predict(layout, Retract(layout, x_i, -step), s));
    EXPECT_LT(((plus - minus) / (2 * h) - transition.Phi.col(c)).norm(),
              tolerance)
        << layout.ComponentName(c);
  }
}

TEST(ImuLink, DefectIsTheDifferenceToThePrediction) {
  const ErrorLayout layout = RichLayout(SomeNoise());
  const ImuStream stream = LivelyImu(3.0, 100.0, SomeNoise());
  Random random(5);
  State x_i = TypicalState();
  x_i.parameters = ParameterVector::Zero(layout.parameter_count());
  const ImuSummary s = ImuIntegrator(stream, true)
                           .Summarize(0.5, 1.5, CalibrationOf(layout, x_i));
  const State predicted = Predict(layout, x_i, s);
  const State x_j =
      Retract(layout, predicted, RandomError(layout, &random, 1e-4));
  Transition transition;
  LinearizeTransition(layout, s, x_i, x_j, &transition);
  const ErrorVector expected = Local(layout, x_j, predicted);
  EXPECT_LT((transition.c - expected).norm(), 1e-7);
}

}  // namespace
}  // namespace hindsight
