#ifndef HINDSIGHT_TESTS_MEASUREMENTS_NUMERIC_JACOBIAN_H_
#define HINDSIGHT_TESTS_MEASUREMENTS_NUMERIC_JACOBIAN_H_

#include <gtest/gtest.h>

#include <string>

#include "measurements/measurement.h"
#include "support/test_motion.h"

namespace hindsight::testing {

/// A state, layout, sensor and reading at which a model is looked at.
struct Scene {
  ErrorLayout layout = TypicalLayout();
  State state = TypicalState();
  Kinematics kinematics{{0.11, -0.23, 0.31}, {0.9, -1.4, -9.6}};
  Sensor sensor;
  double stamp = 0.0;

  LinearizedMeasurement Evaluate(const Measurement& z) const {
    return EvaluateAt(z, state);
  }
  /// A time offset is linearised at `state`.
  LinearizedMeasurement EvaluateAt(const Measurement& z, const State& x) const {
    const RowVector rate =
        TimeOffsetRate(z, {layout, state, kinematics, sensor, 0, stamp});
    LinearizedMeasurement out;
    hindsight::Evaluate(z, {layout, x, kinematics, sensor, 0, stamp, &rate},
                        &out);
    return out;
  }
};

/// All blocks that any model knows, with values that are not zero.
inline Scene RichScene() {
  Scene scene;
  scene.layout = RichLayout();
  const auto add = [&scene](BlockKind kind, const char* name) {
    Block block;
    block.key = {kind, 0};
    block.name = name;
    block.unit = "1";
    block.sigma0.setOnes();
    scene.layout.Add(block);
  };
  add(BlockKind::kScale, "scale");
  add(BlockKind::kMounting, "mounting");
  ParameterVector& values = scene.state.parameters;
  values.setZero(scene.layout.parameter_count());
  const auto set = [&](BlockKind kind, int sensor, const Eigen::Vector3d& v) {
    const Block& block = *scene.layout.Find(kind, sensor);
    const int dim = FullDimension(kind);
    values.segment(block.parameter_offset, dim) = v.head(dim);
  };
  set(BlockKind::kGyroScale, BlockKey::kNoSensor, {0.010, -0.020, 0.030});
  set(BlockKind::kAccelScale, BlockKey::kNoSensor, {-0.010, 0.015, 0.020});
  set(BlockKind::kLeverArm, 0, {0.6, -0.4, -1.3});
  set(BlockKind::kTimeOffset, 0, {0.05, 0.0, 0.0});
  set(BlockKind::kColouredNoise, 0, {0.3, -0.2, 0.5});
  set(BlockKind::kOffset, 0, {0.7, 0.0, 0.0});
  set(BlockKind::kScale, 0, {0.02, 0.0, 0.0});
  set(BlockKind::kMounting, 0, {0.03, -0.05, 0.08});
  scene.sensor.q_sb = Exp(Eigen::Vector3d(0.1, 0.2, -0.3));
  scene.stamp = scene.state.t + 0.02;  // 0.07 s after the node by the offset
  return scene;
}

/// Central differences of `predicted` = -residual through the public Evaluate.
/// Steps: 1 m, 1e-4 otherwise. What is left by construction:
///   rounding of ECEF positions, 2e-9 m over 2 h: 1e-9 for the steps of 1 m and
///   1e-5 for those of 1e-4 where the row is a position,
///   third derivatives: h^2/6 of a rotation of the largest vector seen, 100 m
///   or m/s: 2e-7; for a metre the turn of the axes, 2e-7 rad, squared.
inline void ExpectJacobian(const Scene& scene, const Measurement& z,
                           const std::string& name) {
  const LinearizedMeasurement at = scene.Evaluate(z);
  for (int c = 0; c < scene.layout.dim(); ++c) {
    const bool metre = c < 3;
    const double h = metre ? 1.0 : 1e-4;
    const double tolerance = metre ? 3e-7 : 3e-5;
    ErrorVector step = ErrorVector::Zero(scene.layout.dim());
    step(c) = h;
    const RowVector plus =
        scene.EvaluateAt(z, Retract(scene.layout, scene.state, step)).residual;
    const RowVector minus =
        scene.EvaluateAt(z, Retract(scene.layout, scene.state, -step)).residual;
    const RowVector numeric = (minus - plus) / (2.0 * h);
    EXPECT_LT((numeric - at.H.col(c)).cwiseAbs().maxCoeff(), tolerance)
        << name << ", " << scene.layout.ComponentName(c) << "\nnumeric "
        << numeric.transpose() << "\nH       " << at.H.col(c).transpose();
  }
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_MEASUREMENTS_NUMERIC_JACOBIAN_H_
