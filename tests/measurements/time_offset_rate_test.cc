#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "earth/wgs84.h"
#include "imu/imu_link.h"
#include "measurements/numeric_jacobian.h"

namespace hindsight {
namespace {

using testing::RichScene;
using testing::Scene;

/// The rich scene's state after dt of its constant body rate over the Earth and
/// constant specific force.
State After(const Scene& scene, double dt) {
  State x = scene.state;
  const ImuCalibration c = CalibrationOf(scene.layout, x);
  const Eigen::Vector3d w_ib_b =
      (scene.kinematics.w_ib_b - c.b_g).array() / (1.0 + c.s_g.array());
  const Eigen::Vector3d f_b =
      (scene.kinematics.f_b - c.b_a).array() / (1.0 + c.s_a.array());
  const Eigen::Vector3d w_eb_b = w_ib_b - x.q_eb.conjugate() * EarthRate_e();
  const Eigen::Vector3d a_e =
      x.q_eb * f_b + Gravity(x.p_e) - 2.0 * EarthRate_e().cross(x.v_e);
  x.p_e += dt * x.v_e + 0.5 * dt * dt * a_e;
  x.v_e += dt * a_e;
  x.q_eb = x.q_eb * Exp(dt * w_eb_b);
  return x;
}

std::vector<std::pair<std::string, MeasurementModel>> Models(
    const Scene& scene) {
  std::vector<std::pair<std::string, MeasurementModel>> models;
  models.emplace_back("position", PositionFix{scene.state.p_e});
  models.emplace_back("velocity",
                      VelocityFix{Eigen::Vector3d(11.0, -6.0, 0.3)});
  models.emplace_back("height", HeightFix{51.0, 0.5});
  Odometer odometer;
  odometer.speed = 12.0;
  models.emplace_back("odometer", odometer);
  SpeedCourse course;
  course.speed = 13.0;
  course.course = -0.5;
  models.emplace_back("speed and course", course);
  course.has_course = false;
  models.emplace_back("speed", course);
  Dvl dvl;
  dvl.form = Dvl::Form::kBeams;
  dvl.beam_angle = 0.35;
  dvl.sigma.setConstant(0.1);
  models.emplace_back("dvl", dvl);
  AcousticFix acoustic;
  acoustic.has_bearing = true;
  acoustic.p_t_e = scene.state.p_e +
                   scene.state.C_en() * Eigen::Vector3d(100.0, -160.0, 48.0);
  models.emplace_back("range and bearing", acoustic);
  const Eigen::Vector3d field_b(11.0, -25.0, 30.0);
  models.emplace_back(
      "field", MagneticField{field_b, 1.0, MagneticField::Form::kVector});
  models.emplace_back(
      "azimuth", MagneticField{field_b, 1.0, MagneticField::Form::kHeading});
  return models;
}

/// What the rate is: the change of the prediction along the motion. Central
/// differences over 2 ms: a third derivative of some 10 units/s^3 leaves 2e-6,
/// rounding of ECEF positions 1e-6; the turn of NED axes with the vehicle, by
/// 2e-6 rad/s, of 60 uT and of 14 m/s, 1e-4 and 3e-5 of the units used.
TEST(TimeOffsetRate, IsTheChangeOfThePredictionAlongTheMotion) {
  const Scene scene = RichScene();
  constexpr double kStep = 1e-3;
  constexpr double kTolerance = 2e-4;
  for (const auto& [name, model] : Models(scene)) {
    const Measurement z{0.0, 0, false, model};
    const RowVector rate = TimeOffsetRate(
        z, {scene.layout, scene.state, scene.kinematics, scene.sensor, 0, 0.0});
    const auto residual = [&](double dt) {
      const State x = After(scene, dt);
      LinearizedMeasurement out;
      Evaluate(z, {scene.layout, x, scene.kinematics, scene.sensor, 0, 0.0},
               &out);
      return out.residual;
    };
    const RowVector numeric =
        (residual(-kStep) - residual(kStep)) / (2.0 * kStep);
    EXPECT_LT((numeric - rate).cwiseAbs().maxCoeff(), kTolerance)
        << name << "\nnumeric " << numeric.transpose() << "\nrate    "
        << rate.transpose();
    EXPECT_GT(rate.norm(), 1e-3) << name;
  }
}

/// Linear in the offset, and without a product of the offset and the state.
TEST(TimeOffsetRate, EntersTheResidualLinearly) {
  Scene scene = RichScene();
  const Measurement z{0.0, 0, false,
                      VelocityFix{Eigen::Vector3d(11.0, -6.0, 0.3)}};
  const Block& offset = *scene.layout.Find(BlockKind::kTimeOffset, 0);
  const LinearizedMeasurement at = scene.Evaluate(z);
  State x = scene.state;
  x.parameters(offset.parameter_offset) += 0.2;
  EXPECT_LT((at.residual - scene.EvaluateAt(z, x).residual -
             0.2 * at.H.col(offset.offset))
                .norm(),
            1e-12);
  // The same at another velocity.
  State faster = scene.state;
  faster.v_e *= 1.5;
  State both = faster;
  both.parameters(offset.parameter_offset) += 0.2;
  EXPECT_LT((scene.EvaluateAt(z, faster).residual -
             scene.EvaluateAt(z, both).residual - 0.2 * at.H.col(offset.offset))
                .norm(),
            1e-12);
}

TEST(TimeOffsetRate, IsNoiseUntilATrajectoryIsKnown) {
  const Scene scene = RichScene();
  const Measurement z{0.0, 0, false,
                      VelocityFix{Eigen::Vector3d(11.0, -6.0, 0.3)}};
  const ModelContext context{scene.layout, scene.state, scene.kinematics,
                             scene.sensor, 0,           scene.stamp};
  LinearizedMeasurement unknown;
  Evaluate(z, context, &unknown);
  const Block& offset = *scene.layout.Find(BlockKind::kTimeOffset, 0);
  const RowVector scatter = offset.sigma0(0) * TimeOffsetRate(z, context);
  EXPECT_TRUE(unknown.H.col(offset.offset).isZero());
  EXPECT_LT((unknown.R - scene.Evaluate(z).R -
             RowMatrix(scatter * scatter.transpose()))
                .norm(),
            1e-12);
}

}  // namespace
}  // namespace hindsight
