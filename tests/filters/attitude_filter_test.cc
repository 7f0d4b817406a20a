#include "filters/attitude_filter.h"

#include <gtest/gtest.h>

#include "base/units.h"
#include "earth/wgs84.h"
#include "filters/attitude_run.h"
#include "filters/forward_filter.h"
#include "filters/rts.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

const Eigen::Vector3d kField_n(20.0, 0.0, 40.0);

/// A platform on the spot that turns at a constant rate, on an Earth that does
/// not unless `place` says so; readings exact but for the gyro bias.
struct Turntable {
  AttitudePlace place;
  Eigen::Vector3d b_g = Eigen::Vector3d::Zero();
  ImuStream imu;
  std::vector<MagneticSample> magnetic;
  std::vector<Eigen::Quaterniond> q_nb;

  void Turn(double duration, double rate) {
    const Eigen::Vector3d w_b(0.3, -0.2, 0.4);
    const int count = static_cast<int>(duration * rate);
    for (int k = 0; k <= count; ++k) {
      const double t = k / rate;
      const Eigen::Quaterniond q = Exp(-t * place.w_ie_n) *
                                   Exp(Eigen::Vector3d(0.2, -0.1, 0.7)) *
                                   Exp(t * w_b);
      q_nb.push_back(q);
      imu.samples.push_back(
          {t, w_b + b_g,
           q.conjugate() * Eigen::Vector3d(0.0, 0.0, -place.gravity)});
      magnetic.push_back({t, q.conjugate() * kField_n});
    }
  }
  AttitudeState Start(double attitude_sigma, double bias_sigma) const {
    AttitudeState start;
    start.q_nb = q_nb.front();
    start.P.diagonal() << Eigen::Vector3d::Constant(attitude_sigma *
                                                    attitude_sigma),
        Eigen::Vector3d::Constant(bias_sigma * bias_sigma);
    return start;
  }
};

AttitudeFilterOptions VectorOptions() {
  AttitudeFilterOptions options;
  options.magnetic_form = MagneticField::Form::kVector;
  options.magnetic.horizontal = kField_n.x();
  options.magnetic.down = kField_n.z();
  options.reference.enabled = false;
  return options;
}

TEST(AttitudeFilter, NoiselessDataGiveNoError) {
  for (const double low_pass : {0.0, 1.0}) {
    for (const auto form :
         {MagneticField::Form::kVector, MagneticField::Form::kHeading}) {
      Turntable table;
      table.Turn(20.0, 100.0);
      AttitudeFilterOptions options = VectorOptions();
      options.magnetic_form = form;
      options.low_pass_tau = low_pass;
      const AttitudeRun run = RunAttitudeFilter(
          table.imu, table.magnetic, options, table.Start(0.1, 0.01));
      EXPECT_LT(run.epochs.back().x.q_nb.angularDistance(table.q_nb.back()),
                1e-7);
      EXPECT_LT(run.epochs.back().x.b_g.norm(), 1e-8);
    }
  }
}

TEST(AttitudeFilter, FindsAttitudeAndGyroBias) {
  Turntable table;
  table.b_g = {0.01, -0.02, 0.015};
  table.Turn(60.0, 50.0);
  AttitudeState start = table.Start(0.2, 0.02);
  start.q_nb = Exp(Eigen::Vector3d(0.1, -0.1, 0.15)) * start.q_nb;
  const AttitudeRun run =
      RunAttitudeFilter(table.imu, table.magnetic, VectorOptions(), start);
  const AttitudeState& x = run.epochs.back().x;
  EXPECT_LT(x.q_nb.angularDistance(table.q_nb.back()), 2e-4);
  EXPECT_LT((x.b_g - table.b_g).norm(), 2e-5);
}

TEST(AttitudeFilter, KnowsTheEarthsRotationAtAPlace) {
  Turntable table;
  table.place =
      PlaceOnEarth(EcefFromGeodetic({52.0 * kDegree, 13.0 * kDegree, 50.0}));
  table.Turn(100.0, 50.0);
  AttitudeFilterOptions options = VectorOptions();
  options.place = table.place;
  // Nothing but gyros: the rule passes every sample over.
  options.rule.name = "gate";
  options.rule.limit = -1.0;
  // The table turns at w_b in n: the gyros feel the Earth's rate besides.
  for (std::size_t k = 0; k < table.imu.samples.size(); ++k) {
    const Eigen::Quaterniond q =
        Exp(Eigen::Vector3d(0.2, -0.1, 0.7)) *
        Exp(table.imu.samples[k].t * Eigen::Vector3d(0.3, -0.2, 0.4));
    table.q_nb[k] = q;
    table.imu.samples[k].gyro += q.conjugate() * table.place.w_ie_n;
  }
  const AttitudeRun run =
      RunAttitudeFilter(table.imu, {}, options, table.Start(0.01, 1e-4));
  EXPECT_LT(run.epochs.back().x.q_nb.angularDistance(table.q_nb.back()), 1e-5);
}

/// The general filter on the same layout, a node a sample.
TEST(AttitudeFilter, AgreesWithTheGeneralForwardFilter) {
  Turntable table;
  const Eigen::Vector3d p_e =
      EcefFromGeodetic({52.0 * kDegree, 13.0 * kDegree, 50.0});
  table.place = PlaceOnEarth(p_e);
  table.b_g = {2e-4, -1e-4, 3e-4};
  table.Turn(4.0, 50.0);
  for (ImuSample& sample : table.imu.samples) {
    // A body at rest over the Earth: w_ie is felt, q_nb constant.
    sample.gyro =
        table.q_nb.front().conjugate() * table.place.w_ie_n + table.b_g;
    sample.accel = table.q_nb.front().conjugate() *
                   Eigen::Vector3d(0.0, 0.0, -table.place.gravity);
  }
  for (MagneticSample& sample : table.magnetic) {
    sample.field_b = table.q_nb.front().conjugate() * kField_n;
  }
  table.imu.noise.gyro_noise_density = 1e-3;
  AttitudeFilterOptions options = VectorOptions();
  options.place = table.place;
  options.rule.name = "gate";
  options.rule.limit = -1.0;
  AttitudeState start = table.Start(0.002, 5e-4);
  start.q_nb = Exp(Eigen::Vector3d(5e-4, -3e-4, 4e-4)) * start.q_nb;
  const AttitudeRun light =
      RunAttitudeFilter(table.imu, table.magnetic, options, start);

  Sensor sensor;
  sensor.type = SensorType::kMagnetometer;
  sensor.magnetic = options.magnetic;
  std::vector<Node> nodes;
  std::vector<Measurement> measurements;
  for (std::size_t k = 0; k < table.imu.samples.size(); ++k) {
    const ImuSample& sample = table.imu.samples[k];
    nodes.push_back(
        {sample.t, {sample.gyro, sample.accel}, static_cast<int>(k), 1});
    measurements.push_back(
        {sample.t, 0, false,
         MagneticField{table.magnetic[k].field_b, options.magnetic_sigma,
                       MagneticField::Form::kVector}});
  }
  Timeline timeline(nodes, measurements, {sensor}, table.imu, false);
  const ErrorLayout layout = AttitudeLayout(table.imu.noise, start);
  Prior prior;
  prior.x.p_e = p_e;
  prior.x.q_eb = Eigen::Quaterniond(NedAxes(p_e)) * start.q_nb;
  prior.P = layout.InitialCovariance();
  const LinearTape tape = RunExtendedKalmanFilter(layout, prior, &timeline);

  const State& general = tape.back().x_plus;
  const AttitudeState& x = light.epochs.back().x;
  const Eigen::Quaterniond q_nb =
      Eigen::Quaterniond(general.C_en()).conjugate() * general.q_eb;
  EXPECT_LT(q_nb.angularDistance(x.q_nb), 1e-6);
  EXPECT_LT((general.b_g - x.b_g).norm(), 1e-6);
  const ErrorMatrix P = tape.P_plus(tape.size() - 1);
  EXPECT_LT((P - x.P).cwiseAbs().maxCoeff(), 2e-3 * P.cwiseAbs().maxCoeff());
}

TEST(AttitudeFilter, SmootherEndsWhereTheFilterEnds) {
  Turntable table;
  table.b_g = {0.01, -0.02, 0.015};
  table.Turn(30.0, 20.0);
  AttitudeState start = table.Start(0.2, 0.02);
  start.q_nb = Exp(Eigen::Vector3d(0.1, -0.1, 0.15)) * start.q_nb;
  LinearTape tape(AttitudeLayout(table.imu.noise, start));
  const AttitudeRun run = RunAttitudeFilter(table.imu, table.magnetic,
                                            VectorOptions(), start, &tape);
  const SmoothedTrajectory smoothed = SmoothRts(std::move(tape));
  ASSERT_EQ(smoothed.states.size(), run.epochs.size());
  EXPECT_LT((smoothed.states.back().b_g - run.epochs.back().x.b_g).norm(),
            1e-15);
  // The error of the start, 0.2 rad, is gone already at the start.
  const State& first = smoothed.states.front();
  const Eigen::Quaterniond q_nb =
      Eigen::Quaterniond(first.C_en()).conjugate() * first.q_eb;
  EXPECT_LT(q_nb.angularDistance(table.q_nb.front()), 2e-3);
  EXPECT_LT((first.b_g - table.b_g).norm(), 2e-3);
}

/// Errors that go on for a second: an update each 20 ms is told as much as one
/// each 5 ms. Between updates no more is neglected than what the attitude has
/// to be corrected by within one of them.
TEST(AttitudeFilter, FewerUpdatesTellAsMuchOfErrorsThatGoOn) {
  Turntable table;
  table.b_g = {0.01, -0.02, 0.015};
  table.Turn(20.0, 200.0);
  table.imu.noise.gyro_noise_density = 1e-3;
  AttitudeFilterOptions options = VectorOptions();
  options.accel_correlation_time = 1.0;
  options.magnetic_correlation_time = 1.0;
  options.rest_sigma = 0.02;
  AttitudeState start = table.Start(0.1, 0.02);
  start.q_nb = Exp(Eigen::Vector3d(0.1, -0.1, 0.05)) * start.q_nb;
  const AttitudeRun every =
      RunAttitudeFilter(table.imu, table.magnetic, options, start);
  options.update_interval = 0.02;
  const AttitudeRun fewer =
      RunAttitudeFilter(table.imu, table.magnetic, options, start);
  ASSERT_EQ(fewer.epochs.size(), every.epochs.size());
  for (std::size_t k = 400; k < every.epochs.size(); k += 37) {
    const AttitudeState& a = every.epochs[k].x;
    const AttitudeState& b = fewer.epochs[k].x;
    EXPECT_EQ(a.t, b.t);
    const double sigma2 = options.rule.sigma * options.rule.sigma;
    EXPECT_NEAR(every.epochs[k].verdict.accel_variance, sigma2 / 0.005, 1e-6);
    EXPECT_NEAR(fewer.epochs[k].verdict.accel_variance, sigma2 / 0.02, 1e-6);
    const Eigen::Matrix<double, 6, 1> sigma = a.P.diagonal().cwiseSqrt();
    const Eigen::Vector3d psi = Log(b.q_nb * a.q_nb.conjugate());
    EXPECT_LT((psi.array() / sigma.head<3>().array()).abs().maxCoeff(), 0.05);
    EXPECT_LT(
        ((b.b_g - a.b_g).array() / sigma.tail<3>().array()).abs().maxCoeff(),
        0.05);
    EXPECT_LT((b.P.diagonal().cwiseSqrt().array() / sigma.array() - 1.0)
                  .abs()
                  .maxCoeff(),
              0.03);
  }
}

}  // namespace
}  // namespace hindsight
