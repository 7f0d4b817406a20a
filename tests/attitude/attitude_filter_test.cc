#include "attitude/attitude_filter.h"

#include <gtest/gtest.h>

#include "attitude/attitude_run.h"
#include "base/chi_square.h"
#include "base/random.h"
#include "base/units.h"
#include "earth/wgs84.h"
#include "filters/forward_filter.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"
#include "measurements/stationary.h"
#include "measurements/tilt.h"

namespace hindsight {
namespace {

const Eigen::Vector3d kFieldNed(20.0, 0.0, 40.0);

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
      magnetic.push_back({t, q.conjugate() * kFieldNed});
    }
  }
  AttitudeState Start(double attitude_sigma, double bias_sigma) const {
    AttitudeState start;
    start.q_nb = q_nb.front();
    start.P.diagonal() << Eigen::Vector3d::Constant(attitude_sigma *
                                                    attitude_sigma),
        Eigen::Vector3d::Constant(bias_sigma * bias_sigma),
        Eigen::Vector3d::Constant(1e-12), Eigen::Vector3d::Constant(1e-12), 0.0;
    return start;
  }
};

AttitudeFilterOptions VectorOptions() {
  AttitudeFilterOptions options;
  options.magnetic_form = MagneticField::Form::kVector;
  options.magnetic.horizontal = kFieldNed.x();
  options.magnetic.down = kFieldNed.z();
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
          table.imu, {table.magnetic}, options, table.Start(0.1, 0.01));
      EXPECT_LT(run.nodes.back().x.q_nb.angularDistance(table.q_nb.back()),
                1e-7);
      EXPECT_LT(run.nodes.back().x.b_g.norm(), 1e-8);
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
      RunAttitudeFilter(table.imu, {table.magnetic}, VectorOptions(), start);
  const AttitudeState& x = run.nodes.back().x;
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
  EXPECT_LT(run.nodes.back().x.q_nb.angularDistance(table.q_nb.back()), 1e-5);
}

/// The general filter on the same layout, a node a sample, by field and tilt.
void ExpectAgreementWithTheGeneralFilter(bool turns) {
  Turntable table;
  const Eigen::Vector3d p_e =
      EcefFromGeodetic({52.0 * kDegree, 13.0 * kDegree, 50.0});
  table.place = PlaceOnEarth(p_e);
  table.b_g = {2e-4, -1e-4, 3e-4};
  table.Turn(4.0, 50.0);
  for (ImuSample& sample : table.imu.samples) {
    if (turns) break;
    // A body at rest over the Earth: w_ie is felt, q_nb constant.
    sample.gyro =
        table.q_nb.front().conjugate() * table.place.w_ie_n + table.b_g;
    sample.accel = table.q_nb.front().conjugate() *
                   Eigen::Vector3d(0.0, 0.0, -table.place.gravity);
  }
  for (MagneticSample& sample : table.magnetic) {
    if (turns) break;
    sample.field_b = table.q_nb.front().conjugate() * kFieldNed;
  }
  table.imu.noise.gyro_noise_density = 1e-3;
  AttitudeFilterOptions options = VectorOptions();
  options.place = table.place;
  AttitudeState start = table.Start(0.002, 5e-4);
  start.q_nb = Exp(Eigen::Vector3d(5e-4, -3e-4, 4e-4)) * start.q_nb;
  const AttitudeRun light =
      RunAttitudeFilter(table.imu, {table.magnetic}, options, start);

  Sensor sensor;
  sensor.kind = &MagnetometerKind();
  sensor.magnetic = options.magnetic;
  Sensor accelerometer;
  accelerometer.kind = &TiltKind();
  std::vector<Node> nodes;
  std::vector<Measurement> measurements;
  for (std::size_t k = 0; k < table.imu.samples.size(); ++k) {
    const ImuSample& sample = table.imu.samples[k];
    nodes.push_back(
        {sample.t, {sample.gyro, sample.accel}, static_cast<int>(2 * k), 2});
    measurements.push_back(
        {sample.t, 1, false,
         Tilt{sample.accel, table.place.gravity, options.rule.sigma}});
    measurements.push_back(
        {sample.t, 0, false,
         MagneticField{table.magnetic[k].field_b, options.magnetic_sigma,
                       MagneticField::Form::kVector}});
  }
  const ErrorLayout layout = AttitudeLayout(table.imu.noise, start);
  Prior prior;
  prior.x.p_e = p_e;
  prior.x.q_eb = Eigen::Quaterniond(NedAxes(p_e)) * start.q_nb;
  prior.x.parameters = start.s_g;
  prior.P = layout.InitialCovariance();
  Problem problem = {
      layout, prior,
      Timeline(nodes, measurements, {sensor, accelerometer}, table.imu, false)};
  const LinearTape tape = RunExtendedKalmanFilter(&problem);

  const State& general = tape.back().x_plus;
  const AttitudeState& x = light.nodes.back().x;
  const Eigen::Quaterniond q_nb =
      Eigen::Quaterniond(general.C_en()).conjugate() * general.q_eb;
  EXPECT_LT(q_nb.angularDistance(x.q_nb), 1e-6);
  EXPECT_LT((general.b_g - x.b_g).norm(), 1e-6);
  EXPECT_LT((general.parameters - x.s_g).norm(), 1e-6);
  const ErrorMatrix P = tape.P_plus(tape.size() - 1);
  const auto P_light = x.P.topLeftCorner(layout.dim(), layout.dim());
  EXPECT_LT((P - P_light).cwiseAbs().maxCoeff(),
            2e-3 * P.cwiseAbs().maxCoeff());
}

TEST(AttitudeFilter, AgreesWithTheGeneralForwardFilterAtRest) {
  ExpectAgreementWithTheGeneralFilter(false);
}

TEST(AttitudeFilter, AgreesWithTheGeneralForwardFilterWhileTurning) {
  ExpectAgreementWithTheGeneralFilter(true);
}

/// Six turns about the vertical and back with the field seen at all times: what
/// the scale factor adds is told from the bias by the way back.
TEST(AttitudeFilter, FindsTheScaleFactor) {
  Turntable table;
  const Eigen::Vector3d b_g(0.002, -0.001, 0.003);
  const double scale = 0.004;
  for (int k = 0; k <= 6000; ++k) {
    const double t = 0.01 * k;
    const double phase = kPi * t / 60.0;
    const double rate = 2.0 * std::cos(phase);
    const double angle = 120.0 / kPi * std::sin(phase);
    const Eigen::Quaterniond q = Exp(Eigen::Vector3d(0.0, 0.0, angle));
    table.q_nb.push_back(q);
    table.imu.samples.push_back(
        {t, b_g + Eigen::Vector3d(0.0, 0.0, (1.0 + scale) * rate),
         Eigen::Vector3d(0.0, 0.0, -table.place.gravity)});
    table.magnetic.push_back({t, q.conjugate() * kFieldNed});
  }
  AttitudeState start = table.Start(0.01, 0.01);
  start.P.diagonal()
      .segment<3>(AttitudeState::kGyroScale)
      .setConstant(0.005 * 0.005);
  const AttitudeRun run =
      RunAttitudeFilter(table.imu, {table.magnetic}, VectorOptions(), start);
  const AttitudeState& x = run.nodes.back().x;
  EXPECT_NEAR(x.s_g.z(), scale, 2e-4);
  EXPECT_LT(std::abs(x.b_g.z() - b_g.z()), 3.0 * std::sqrt(x.P(5, 5)));
}

/// Of 100 tables that turn with noise, gyro and accelerometer biases drawn by the
/// a priori sigmas: errors of attitude and accelerometer bias over sigmas are a
/// chi-square of 600, within its 99.9 %, and the bias is known five times better.
TEST(AttitudeFilter, FindsTheAccelerometerBias) {
  constexpr int kTables = 100;
  constexpr double kForce = 0.1;  // of a reading [m/s^2]
  const double prior = 0.3;
  Random random(21);
  double nees = 0.0;
  for (int table_number = 0; table_number < kTables; ++table_number) {
    Turntable table;
    table.b_g = 0.005 * random.NormalVector3();
    table.Turn(40.0, 50.0);
    AttitudeState start = table.Start(0.05, 0.005);
    start.q_nb = Exp(0.05 * random.NormalVector3()) * start.q_nb;
    start.P.diagonal()
        .segment<3>(AttitudeState::kAccelBias)
        .setConstant(prior * prior);
    const Eigen::Vector3d b_a = prior * random.NormalVector3();
    table.imu.noise.gyro_noise_density = 1e-4;
    for (ImuSample& sample : table.imu.samples) {
      sample.gyro += 1e-4 * std::sqrt(50.0) * random.NormalVector3();
      sample.accel += b_a + kForce * random.NormalVector3();
    }
    AttitudeFilterOptions options = VectorOptions();
    options.rule.sigma = kForce;
    for (MagneticSample& sample : table.magnetic) {
      sample.field_b += options.magnetic_sigma * random.NormalVector3();
    }
    const AttitudeRun run =
        RunAttitudeFilter(table.imu, {table.magnetic}, options, start);
    const AttitudeState& x = run.nodes.back().x;
    Eigen::Matrix<double, 6, 1> error;
    error << Log(table.q_nb.back() * x.q_nb.conjugate()), b_a - x.b_a;
    Eigen::Matrix<double, 6, 6> P;
    constexpr int kAccel = AttitudeState::kAccelBias;
    P << x.P.topLeftCorner<3, 3>(), x.P.block<3, 3>(0, kAccel),
        x.P.block<3, 3>(kAccel, 0), x.P.block<3, 3>(kAccel, kAccel);
    EXPECT_LT(std::sqrt(P(5, 5)), 0.2 * prior);
    nees += error.dot(P.llt().solve(error));
  }
  EXPECT_GT(nees, ChiSquareQuantile(0.0005, 6.0 * kTables));
  EXPECT_LT(nees, ChiSquareQuantile(0.9995, 6.0 * kTables));
}

/// A turn that begins slowly is none of the bias, however long the body lay
/// still before: the attitude follows it, within its sigma.
TEST(AttitudeFilter, FollowsATurnThatBeginsSlowly) {
  constexpr double kStep = 0.01;
  constexpr double kBegin = 15.0;
  constexpr double kJerk = 0.02;  // rate = kJerk (t - kBegin)^2 [rad/s^3]
  constexpr double kSigma = 1e-3;
  Random random(6);
  Turntable table;
  for (int k = 0; k <= 1800; ++k) {
    const double s = std::max(kStep * k - kBegin, 0.0);
    table.q_nb.push_back(
        Exp(Eigen::Vector3d(0.0, 0.0, kJerk * s * s * s / 3.0)));
    table.imu.samples.push_back(
        {kStep * k,
         Eigen::Vector3d(0.0, 0.0, kJerk * s * s) +
             kSigma * random.NormalVector3(),
         Eigen::Vector3d(0.0, 0.0, -table.place.gravity)});
  }
  table.imu.noise.gyro_noise_density = kSigma * std::sqrt(kStep);
  AttitudeFilterOptions options;
  options.rest_sigma = kSigma;
  const AttitudeRun run =
      RunAttitudeFilter(table.imu, {}, options, table.Start(1e-4, 0.01));
  const AttitudeState& x = run.nodes.back().x;
  EXPECT_LT(x.q_nb.angularDistance(table.q_nb.back()),
            4.0 * std::sqrt(x.P(2, 2)));
  EXPECT_LT(std::abs(x.b_g.z()), 4.0 * std::sqrt(x.P(5, 5)));
}

/// At rest the gyros' noise and bias are no turn, whether the rest is known or
/// found; their mean is the bias.
TEST(AttitudeFilter, DoesNotTurnAtRest) {
  for (const bool known : {true, false}) {
    Random random(5);
    const Eigen::Vector3d b_g(0.004, -0.003, 0.005);
    Turntable table;
    for (int k = 0; k <= 6000; ++k) {
      table.q_nb.push_back(Eigen::Quaterniond::Identity());
      table.imu.samples.push_back(
          {0.01 * k, b_g + 0.002 * random.NormalVector3(),
           Eigen::Vector3d(0.0, 0.0, -table.place.gravity)});
    }
    table.imu.noise.gyro_noise_density = 2e-4;
    AttitudeFilterOptions options;
    options.rest_sigma = 0.005;
    if (known) options.rests.emplace(table.imu.samples.size(), true);
    const AttitudeRun run =
        RunAttitudeFilter(table.imu, {}, options, table.Start(0.01, 0.01));
    const AttitudeState& x = run.nodes.back().x;
    EXPECT_LT(x.q_nb.angularDistance(run.samples[300].q_nb),
              known ? 1e-9 : 0.02);
    EXPECT_LT(x.q_nb.angularDistance(run.samples[1000].q_nb), 1e-3);
    EXPECT_LT((x.b_g - b_g).norm(), 2e-4);
  }
}

/// A filter that has turned for a second, with a covariance that has
/// correlations everywhere.
struct TurnedFilter {
  Eigen::Vector3d w = {1.0, -0.7, 0.4};  ///< [rad/s]
  AttitudeFilterOptions options;
  ImuNoise noise;
  AttitudeState start;

  TurnedFilter() {
    options.place =
        PlaceOnEarth(EcefFromGeodetic({52.0 * kDegree, 13.0 * kDegree, 50.0}));
    options.rest_sigma = 0.01;
    start.q_nb = Exp(Eigen::Vector3d(0.2, -0.1, 0.7));
    start.b_g = {0.002, -0.001, 0.003};
    start.P.diagonal() << Eigen::Vector3d::Constant(4e-4),
        Eigen::Vector3d::Constant(1e-4), Eigen::Vector3d::Constant(1e-5),
        Eigen::Vector3d::Constant(4e-4), 0.0;
  }
  AttitudeFilter Turn() const {
    AttitudeFilter filter(options, noise, start, 0.01);
    for (int k = 0; k < 100; ++k) filter.Turn(0.01, w, w);
    filter.Predict();
    return filter;
  }
};

/// One reading, in the general form.
AttitudeState::Matrix Updated(const AttitudeState& x, const Eigen::MatrixXd& H,
                              const Eigen::VectorXd& residual, double R,
                              Eigen::VectorXd* dx) {
  const Eigen::MatrixXd S = H * x.P * H.transpose() +
                            R * Eigen::MatrixXd::Identity(H.rows(), H.rows());
  const Eigen::MatrixXd K = x.P * H.transpose() * S.inverse();
  *dx = K * residual;
  return x.P - K * H * x.P;
}

/// What a filter makes of one reading is what its model says in the general
/// form, at the state before the update; the layout's own transition plays no
/// part.
class ReadingTie {
 public:
  explicit ReadingTie(const TurnedFilter& turned) : turned_(turned) {}

  /// `x` is the state before the reading is used, `tolerance` relative. The dip of
  /// the field is no part of the model's layout.
  template <class Model>
  void Expect(const Model& model, const Sensor& sensor, const AttitudeState& x,
              const AttitudeFilter& after, double tolerance) const {
    State state;
    state.p_e = turned_.options.place.p_e;
    state.q_eb = Eigen::Quaterniond(NedAxes(state.p_e)) * x.q_nb;
    state.b_g = x.b_g;
    state.parameters = x.s_g;
    const ErrorLayout layout = AttitudeLayout(turned_.noise, turned_.start);
    const Kinematics turning = {turned_.w, Eigen::Vector3d::Zero()};
    LinearizedMeasurement z;
    model.Evaluate({layout, state, turning, sensor}, &z);
    Eigen::VectorXd dx;
    z.H.conservativeResize(Eigen::NoChange, AttitudeState::kDim);
    z.H.col(AttitudeState::kDip).setZero();
    const AttitudeState::Matrix P = Updated(x, z.H, z.residual, z.R(0, 0), &dx);
    EXPECT_GT(dx.norm(), 1e-5);
    EXPECT_LT((after.dx() - dx).norm(), tolerance * dx.norm());
    EXPECT_LT((after.state().P - P).norm(), tolerance * P.norm());
    EXPECT_GT((x.P - P).norm(), 100.0 * tolerance * P.norm())
        << "the reading says too little to be told from none";
  }

 private:
  const TurnedFilter& turned_;
};

TEST(AttitudeFilter, ReadsRestAsItsModelDoes) {
  const TurnedFilter turned;
  AttitudeFilter filter = turned.Turn();
  filter.SetResting(true);
  const Eigen::Vector3d w(0.004, 0.001, -0.002);
  for (int k = 0; k < 4; ++k) filter.Turn(0.01, w, w);
  filter.Predict();
  const AttitudeState x = filter.state();
  filter.UseRest();
  ReadingTie(turned).Expect(ZeroAngularRate{w, 0.005}, {}, x, filter, 1e-3);
}

/// The body turns on after the reading, up to the update: the filter keeps it
/// in axes that do not turn, the model has it turned by the gyros.
Eigen::Vector3d TurnedOn(const Eigen::Vector3d& reading_b,
                         const AttitudeState& at, const AttitudeState& x) {
  return x.q_nb.conjugate() * (at.q_nb * reading_b);
}

TEST(AttitudeFilter, ReadsTheTiltAsItsModelDoesWhileTheBodyTurns) {
  TurnedFilter turned;
  turned.options.place.w_ie_n.setZero();
  // The model's third row tells of the bias, and of nothing else.
  turned.start.P.diagonal()
      .segment<3>(AttitudeState::kAccelBias)
      .setConstant(1e-20);
  AttitudeFilter filter = turned.Turn();
  const AttitudeState at = filter.state();
  const double g = turned.options.place.gravity;
  const Eigen::Vector3d f_b = Exp(Eigen::Vector3d(2e-2, -3e-2, 1e-2)) *
                              (at.q_nb.conjugate() * ForceAtRest_n(g));
  filter.AddForce(ForceAsRead(f_b));
  for (int k = 0; k < 5; ++k) filter.Turn(0.01, turned.w, turned.w);
  filter.Predict();
  const AttitudeState x = filter.state();
  ASSERT_GT(x.q_nb.angularDistance(at.q_nb), 0.05);
  filter.UseAccelerometer();
  ReadingTie(turned).Expect(
      Tilt{TurnedOn(f_b, at, x), g, std::sqrt(filter.verdict().accel_variance)},
      {}, x, filter, 1e-9);
}

/// Against differences of the residuals, which are as the bias was at the
/// readings, and not where the body has turned to since.
TEST(AttitudeFilter, HasTheJacobianOfTheTiltByTheBiasOfTheReadings) {
  TurnedFilter turned;
  turned.options.low_pass_tau = 0.1;
  const auto updates = [&turned](const Eigen::Vector3d& b_a) {
    TurnedFilter off = turned;
    off.start.b_a = b_a;
    AttitudeFilter filter = off.Turn();
    std::vector<ScalarUpdate> recorded;
    filter.RecordUpdates(&recorded);
    for (int k = 0; k < 30; ++k) {
      filter.AddForce(
          ForceAsRead({0.3, -0.2 + 0.01 * k, -off.options.place.gravity}));
      filter.Turn(0.01, off.w, off.w);
    }
    filter.Predict();
    filter.UseAccelerometer();
    return recorded;
  };
  const Eigen::Vector3d at(0.02, -0.01, 0.03);
  const ScalarUpdate analytic = updates(at).front();
  for (int i = 0; i < 3; ++i) {
    constexpr double kStep = 1e-3;
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
    const double numeric = (updates(at + step).front().innovation -
                            updates(at - step).front().innovation) /
                           (2.0 * kStep);
    EXPECT_NEAR(-analytic.h(AttitudeState::kAccelBias + i), numeric, 1e-9);
  }
}

TEST(AttitudeFilter, ReadsTheFieldAsItsModelDoesWhileTheBodyTurns) {
  for (const auto form :
       {MagneticField::Form::kVector, MagneticField::Form::kHeading}) {
    TurnedFilter turned;
    turned.options.place.w_ie_n.setZero();
    turned.options.magnetic_form = form;
    turned.options.decouple_heading = false;
    turned.options.reference.enabled = false;
    Sensor sensor;
    sensor.magnetic.horizontal = kFieldNed.x();
    sensor.magnetic.down = kFieldNed.z();
    sensor.magnetic.declination = 0.06;
    turned.options.magnetic = sensor.magnetic;
    AttitudeFilter filter = turned.Turn();
    const AttitudeState at = filter.state();
    // Of the norm of the field, 1 deg beside it.
    const Eigen::Vector3d field_b =
        Exp(Eigen::Vector3d(1e-2, -5e-3, 2e-2)) *
        (at.q_nb.conjugate() *
         UndisturbedField(sensor.magnetic, sensor.magnetic.declination));
    filter.AddField({at.t, field_b});
    for (int k = 0; k < 5; ++k) filter.Turn(0.01, turned.w, turned.w);
    filter.Predict();
    const AttitudeState x = filter.state();
    ASSERT_GT(x.q_nb.angularDistance(at.q_nb), 0.05);
    filter.UseMagnetometer();
    ASSERT_TRUE(filter.verdict().magnetic_used);
    MagneticField z{TurnedOn(field_b, at, x), turned.options.magnetic_sigma,
                    form};
    if (form == MagneticField::Form::kHeading) {
      // The filter weighs by the horizontal part that is read.
      const Eigen::Vector3d u_n = x.q_nb * z.field_b;
      z.sigma *= sensor.magnetic.horizontal / u_n.head<2>().norm();
    }
    ReadingTie(turned).Expect(z, sensor, x, filter, 1e-9);
  }
}

/// Errors that go on for a second: an update each 100 ms is told as much as one
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
      RunAttitudeFilter(table.imu, {table.magnetic}, options, start);
  options.update_interval = 0.1;
  const AttitudeRun fewer =
      RunAttitudeFilter(table.imu, {table.magnetic}, options, start);
  ASSERT_EQ(fewer.samples.size(), every.samples.size());
  for (std::size_t k = 400; k < every.samples.size(); k += 37) {
    const AttitudeNode& node = every.nodes[every.samples[k].node];
    const AttitudeNode& last = fewer.nodes[fewer.samples[k].node];
    const AttitudeSample& a = every.samples[k];
    const AttitudeSample& b = fewer.samples[k];
    const double sigma2 = options.rule.sigma * options.rule.sigma;
    EXPECT_NEAR(node.verdict.accel_variance, sigma2 / 0.005, 1e-6);
    EXPECT_NEAR(last.verdict.accel_variance, sigma2 / 0.1, 1e-6);
    const Eigen::Matrix<double, 6, 1> sigma =
        node.x.P.diagonal().head<6>().cwiseSqrt();
    const Eigen::Vector3d psi = Log(b.q_nb * a.q_nb.conjugate());
    EXPECT_LT((psi.array() / sigma.head<3>().array()).abs().maxCoeff(), 0.05);
    EXPECT_LT(
        ((b.b_g - a.b_g).array() / sigma.tail<3>().array()).abs().maxCoeff(),
        0.05);
    EXPECT_LT(
        (last.x.P.diagonal().head<6>().cwiseSqrt().array() / sigma.array() -
         1.0)
            .abs()
            .maxCoeff(),
        0.03);
  }
}

}  // namespace
}  // namespace hindsight
