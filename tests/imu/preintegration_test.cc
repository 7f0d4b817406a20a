#include "imu/preintegration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "support/seed_count.h"
#include "support/test_motion.h"

namespace hindsight {
namespace {

using testing::LivelyImu;

/// Independent reference: Euler steps of dC = C [w x], dv = C f, dp = v at a
/// tenth of a millisecond on the linear interpolation of the samples, which is to
/// be a fine one.
struct Reference {
  Eigen::Matrix3d C = Eigen::Matrix3d::Identity();
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
};

Reference IntegrateFinely(const ImuStream& stream, double t_i, double t_j,
                          const ImuCalibration& calibration) {
  Reference r;
  ImuIntegrator reading(stream);
  const int steps = static_cast<int>(std::lround((t_j - t_i) / 1e-4));
  const double h = (t_j - t_i) / steps;
  for (int i = 0; i < steps; ++i) {
    const Kinematics k = reading.ReadingAt(t_i + (i + 0.5) * h);
    const Eigen::Vector3d w =
        (k.w_ib_b - calibration.b_g).array() / (1.0 + calibration.s_g.array());
    const Eigen::Vector3d f =
        (k.f_b - calibration.b_a).array() / (1.0 + calibration.s_a.array());
    const Eigen::Matrix3d C_mid = r.C * Exp(0.5 * h * w).toRotationMatrix();
    const Eigen::Vector3d a = C_mid * f;
    r.p += h * r.v + 0.5 * h * h * a;
    r.v += h * a;
    r.C = r.C * Exp(h * w).toRotationMatrix();
  }
  return r;
}

TEST(Preintegration, EqualsFineStepwiseIntegration) {
  ImuCalibration calibration;
  calibration.b_g = {0.01, -0.02, 0.015};
  calibration.b_a = {0.1, 0.05, -0.08};
  const ImuStream stream = LivelyImu(3.0, 100.0);
  const ImuSummary s = ImuIntegrator(stream).Summarize(0.3, 2.3, calibration);
  const Reference r =
      IntegrateFinely(LivelyImu(3.0, 10000.0), 0.3, 2.3, calibration);
  EXPECT_LT(Log(s.dR.conjugate() * Eigen::Quaterniond(r.C)).norm(), 1e-8);
  // Rotation beyond second order within a sample, (|w| dt)^3/24 |f| dt each
  // with 0.7 rad/s, 10 m/s^2 and 200 samples of 10 ms, is left out.
  EXPECT_LT((s.dv - r.v).norm(), 3e-7);
  EXPECT_LT((s.dp - r.p).norm(), 3e-7);
}

/// Readings of w = cos(omega t) about x at these stamps.
ImuStream Swing(const std::vector<double>& stamps, double omega) {
  ImuStream stream;
  stream.nominal_dt = 0.01;
  for (const double t : stamps) {
    ImuSample sample;
    sample.t = t;
    sample.gyro = {std::cos(omega * t), 0.0, 0.0};
    sample.accel = {0.0, 0.0, std::sin(omega * t)};
    stream.samples.push_back(sample);
  }
  return stream;
}

/// Largest errors of the angle and the velocity over [0.2, t].
double SwingError(const ImuStream& stream, double omega) {
  double error = 0.0;
  for (double t = 0.3; t < 1.8; t += 0.037) {
    const ImuSummary s = ImuIntegrator(stream).Summarize(0.2, t, {});
    const double angle = (std::sin(omega * t) - std::sin(omega * 0.2)) / omega;
    error = std::max(error, std::abs(Log(s.dR).x() - angle));
  }
  return error;
}

/// A line from reading to reading would miss (omega dt)^2 / 12 of it: 3e-4 at
/// 100 Hz, a quarter of it at 200 Hz.
TEST(Preintegration, RatesOfASwingAreIntegratedToFourthOrder) {
  const double omega = 2.0 * kPi;
  const auto even = [](double rate) {
    std::vector<double> stamps;
    for (int k = 0; k <= 2.0 * rate; ++k) stamps.push_back(k / rate);
    return stamps;
  };
  const double coarse = SwingError(Swing(even(100.0), omega), omega);
  EXPECT_LT(coarse, 4e-7);
  EXPECT_LT(SwingError(Swing(even(200.0), omega), omega), coarse / 12.0);
  std::vector<double> uneven = even(100.0);
  for (std::size_t k = 1; k < uneven.size(); k += 2) uneven[k] += 0.002;
  EXPECT_LT(SwingError(Swing(uneven, omega), omega), 3e-6);
}

TEST(Preintegration, NothingIsBentAcrossADropOutOrOfIncrements) {
  std::vector<double> stamps;
  for (int k = 0; k < 100; ++k)
    stamps.push_back(0.01 * k + (k < 50 ? 0.0 : 0.3));
  ImuStream stream = Swing(stamps, 6.0);
  const auto bend = [&](std::size_t k) {
    return ImuIntegrator(stream).BendOfInterval(k).w_ib_b.x();
  };
  EXPECT_EQ(bend(50), 0.0);
  // -dt^2 / 12 w'' of the side that is there.
  const double dt = 0.01;
  const auto expected = [&](double t) {
    return dt * dt / 12.0 * 36.0 * std::cos(6.0 * t);
  };
  EXPECT_NEAR(bend(49), expected(stamps[48]), 1e-6);
  EXPECT_NEAR(bend(51), expected(stamps[51]), 1e-6);
  EXPECT_NEAR(bend(1), expected(stamps[1]), 1e-6);
  EXPECT_NEAR(bend(99), expected(stamps[98]), 1e-6);
  EXPECT_NEAR(bend(20), expected(0.5 * (stamps[19] + stamps[20])), 1e-6);
  stream.kind = ImuStream::Kind::kIncrements;
  EXPECT_EQ(bend(20), 0.0);
}

TEST(Preintegration, SplitIntervalsComposeToTheWhole) {
  const ImuStream stream = LivelyImu(3.0, 100.0);
  ImuIntegrator integrator(stream);
  const ImuCalibration calibration;
  const ImuSummary whole = integrator.Summarize(0.0, 2.0, calibration);
  const double cut = 0.73456;  // inside a sample
  const ImuSummary a = integrator.Summarize(0.0, cut, calibration);
  const ImuSummary b = integrator.Summarize(cut, 2.0, calibration);
  EXPECT_LT(Log((a.dR * b.dR).conjugate() * whole.dR).norm(), 1e-9);
  EXPECT_LT((a.dv + a.dR * b.dv - whole.dv).norm(), 1e-8);
  EXPECT_LT((a.dp + b.dt() * a.dv + a.dR * b.dp - whole.dp).norm(), 1e-8);
}

TEST(Preintegration, TheTurnAloneIsThatOfTheSummary) {
  const ImuStream stream = LivelyImu(3.0, 100.0);
  ImuIntegrator integrator(stream);
  ImuCalibration calibration;
  calibration.b_g = {0.01, -0.02, 0.03};
  const Eigen::Quaterniond dR =
      integrator.Summarize(0.4321, 2.1234, calibration).dR;
  const Eigen::Quaterniond q = integrator.Turn(0.4321, 2.1234, calibration.b_g);
  EXPECT_LT(Log(q.conjugate() * dR).norm(), 1e-12);
}

TEST(Preintegration, AMeanThatGrowsIsThatOfTheSummary) {
  ImuStream stream = LivelyImu(3.0, 100.0);
  stream.noise.gyro_bias_walk = 1e-5;
  stream.noise.gyro_bias_tau = 100.0;
  ImuIntegrator integrator(stream, /*with_scale_jacobians=*/true);
  ImuCalibration calibration;
  calibration.b_g = {0.01, -0.02, 0.03};
  calibration.b_a = {0.1, -0.2, 0.3};
  calibration.s_g = {0.01, 0.02, -0.01};
  calibration.s_a = {-0.01, 0.005, 0.02};
  ImuSummary mean = EmptyMean(0.4321, calibration);
  for (const double t : {0.4329, 0.5, 1.23456, 2.1234}) {
    integrator.AppendMean(t, &mean);
    const ImuSummary whole = integrator.Summarize(0.4321, t, calibration);
    EXPECT_EQ(mean.t_j, t);
    EXPECT_LT(Log(mean.dR.conjugate() * whole.dR).norm(), 1e-9);
    EXPECT_LT((mean.dv - whole.dv).norm(), 1e-8);
    EXPECT_LT((mean.dp - whole.dp).norm(), 1e-8);
    EXPECT_EQ(mean.gyro_bias_phi, whole.gyro_bias_phi);
  }
}

TEST(Preintegration, IncrementsAcrossADropOutAreThoseOfOneInterval) {
  constexpr double kStep = 0.01;
  const Eigen::Vector3d w(0.1, -0.2, 0.3);
  const Eigen::Vector3d f(0.5, 0.2, -9.8);
  ImuStream whole;
  whole.kind = ImuStream::Kind::kIncrements;
  whole.nominal_dt = kStep;
  for (int k = 0; k <= 200; ++k) {
    ImuSample s;
    s.t = k * kStep;
    s.gyro = kStep * w;
    s.accel = kStep * f;
    whole.samples.push_back(s);
  }
  ImuStream gap = whole;
  gap.samples.erase(gap.samples.begin() + 80, gap.samples.begin() + 120);
  const ImuSummary a = ImuIntegrator(whole).Summarize(0.0, 2.0, {});
  const ImuSummary b = ImuIntegrator(gap).Summarize(0.0, 2.0, {});
  EXPECT_LT(Log(a.dR.conjugate() * b.dR).norm(), 1e-9);
  // Over the bridge a sample's rotation is no longer small: 0.15 rad.
  EXPECT_LT((a.dv - b.dv).norm(), 2e-3);
}

TEST(Preintegration, TwoSampleConingFollowsTheConicalMotion) {
  // Classical coning: attitude of constant angle about an axis that circles.
  // Increments by exact integration; drift of the two-sample algorithm over
  // 10 s must stay below a hundredth of the uncorrected drift.
  const double cone = 0.02;
  const double omega = 20.0;
  const auto attitude = [&](double t) {
    return Exp(Eigen::Vector3d(cone * std::cos(omega * t),
                               cone * std::sin(omega * t), 0.0));
  };
  ImuStream stream;
  stream.kind = ImuStream::Kind::kIncrements;
  const double h = 0.01;
  const int fine = 200;
  stream.samples.emplace_back();
  for (int k = 1; k <= 1000; ++k) {
    ImuSample s;
    s.t = k * h;
    for (int i = 0; i < fine; ++i) {
      const double t = (k - 1) * h + i * h / fine;
      s.gyro += Log(attitude(t).conjugate() * attitude(t + h / fine));
    }
    stream.samples.push_back(s);
  }
  stream.samples[0].gyro = stream.samples[1].gyro;
  const ImuSummary s = ImuIntegrator(stream).Summarize(0.0, 10.0, {});
  const Eigen::Quaterniond exact = attitude(0.0).conjugate() * attitude(10.0);
  Eigen::Quaterniond plain = Eigen::Quaterniond::Identity();
  for (std::size_t k = 1; k < stream.samples.size(); ++k) {
    plain = plain * Exp(stream.samples[k].gyro);
  }
  const double drift = Log(s.dR.conjugate() * exact).norm();
  const double plain_drift = Log(plain.conjugate() * exact).norm();
  EXPECT_GT(plain_drift, 1e-4);
  EXPECT_LT(drift, 0.01 * plain_drift);
}

TEST(Preintegration, CalibrationJacobiansMatchNumericDifference) {
  ImuNoise noise;
  noise.gyro_bias_walk = 1e-5;
  noise.accel_bias_walk = 1e-4;
  const ImuStream stream = LivelyImu(3.0, 200.0, noise);
  ImuCalibration at;
  at.b_g = {0.01, -0.02, 0.015};
  at.s_g = {1e-3, -2e-3, 3e-3};
  at.s_a = {-1e-3, 2e-3, 1e-3};
  ImuIntegrator integrator(stream, true);
  const ImuSummary base = integrator.Summarize(0.2, 2.2, at);
  constexpr double kStep = 1e-5;
  for (int which = 0; which < 4; ++which) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto moved = [&](double step) {
        ImuCalibration c = at;
        (which == 0   ? c.b_g
         : which == 1 ? c.b_a
         : which == 2 ? c.s_g
                      : c.s_a)(axis) += step;
        return integrator.Summarize(0.2, 2.2, c);
      };
      const ImuSummary plus = moved(kStep);
      const ImuSummary minus = moved(-kStep);
      const Eigen::Vector3d R =
          Log(plus.dR * minus.dR.conjugate()) / (2 * kStep);
      const Eigen::Vector3d v = (plus.dv - minus.dv) / (2 * kStep);
      const Eigen::Vector3d p = (plus.dp - minus.dp) / (2 * kStep);
      const Eigen::Matrix3d zero = Eigen::Matrix3d::Zero();
      const Eigen::Matrix3d& R_ = which == 0   ? base.R_bg
                                  : which == 2 ? base.R_sg
                                               : zero;
      const Eigen::Matrix3d& v_ = which == 0   ? base.v_bg
                                  : which == 1 ? base.v_ba
                                  : which == 2 ? base.v_sg
                                               : base.v_sa;
      const Eigen::Matrix3d& p_ = which == 0   ? base.p_bg
                                  : which == 1 ? base.p_ba
                                  : which == 2 ? base.p_sg
                                               : base.p_sa;
      // Both sides carry O(sample^2) discretisation, 2.5e-5 relative.
      EXPECT_LT((R - R_.col(axis)).norm(), 1e-4) << which << axis;
      EXPECT_LT((v - v_.col(axis)).norm(), 1e-3) << which << axis;
      EXPECT_LT((p - p_.col(axis)).norm(), 1e-3) << which << axis;
    }
  }
}

/// Of `a` against `b`, in units of the last digits of a double.
template <typename Matrix>
double Rounding(const Matrix& a, const Matrix& b) {
  return (a - b).norm() /
         (std::numeric_limits<double>::epsilon() * (b.norm() + 1e-300));
}

double LargestRounding(const ImuSummary& a, const ImuSummary& b) {
  EXPECT_EQ(a.t_i, b.t_i);
  EXPECT_EQ(a.t_j, b.t_j);
  return std::max({Rounding(a.dR.coeffs(), b.dR.coeffs()), Rounding(a.dv, b.dv),
                   Rounding(a.dp, b.dp), Rounding(a.R_bg, b.R_bg),
                   Rounding(a.v_bg, b.v_bg), Rounding(a.p_bg, b.p_bg),
                   Rounding(a.v_ba, b.v_ba), Rounding(a.p_ba, b.p_ba),
                   Rounding(a.R_sg, b.R_sg), Rounding(a.v_sg, b.v_sg),
                   Rounding(a.p_sg, b.p_sg), Rounding(a.v_sa, b.v_sa),
                   Rounding(a.p_sa, b.p_sa), Rounding(a.noise, b.noise),
                   Rounding(a.bias_cross, b.bias_cross)});
}

TEST(Preintegration, PairsAreWhatTheyAreOneByOne) {
  ImuNoise noise{.gyro_noise_density = 1e-3,
                 .accel_noise_density = 2e-3,
                 .gyro_bias_walk = 1e-4,
                 .accel_bias_walk = 3e-4,
                 .gyro_noise_per_rate = 1e-3};
  const ImuCalibration calibration{.b_g = {0.01, -0.02, 0.015},
                                   .b_a = {0.1, 0.05, -0.08},
                                   .s_g = {1e-3, -2e-3, 3e-3},
                                   .s_a = {2e-3, 1e-3, -1e-3}};
  for (const double tau : {std::numeric_limits<double>::infinity(), 50.0}) {
    noise.gyro_bias_tau = noise.accel_bias_tau = tau;
    for (const auto kind :
         {ImuStream::Kind::kRates, ImuStream::Kind::kIncrements}) {
      // At 2 Hz one sample turns by more than SmallExp takes.
      for (const double rate : {2.0, 100.0}) {
        ImuStream stream = LivelyImu(9.0, rate, noise);
        stream.kind = kind;
        if (kind == ImuStream::Kind::kIncrements) {
          for (ImuSample& sample : stream.samples) {
            sample.gyro /= rate;
            sample.accel /= rate;
          }
        }
        ImuIntegrator integrator(stream, true);
        // As many samples in both, and more in the second.
        for (const double end : {5.33, 7.91}) {
          const auto pair =
              integrator.SummarizePair({1.33, 3.33, end}, calibration);
          EXPECT_LT(LargestRounding(
                        pair[0], integrator.Summarize(1.33, 3.33, calibration)),
                    100.0);
          EXPECT_LT(LargestRounding(
                        pair[1], integrator.Summarize(3.33, end, calibration)),
                    100.0);
        }
      }
    }
  }
}

TEST(Preintegration, PairsKnowDropOuts) {
  ImuStream stream = LivelyImu(6.0, 100.0, {.gyro_noise_density = 1e-3});
  stream.nominal_dt = 0.01;
  stream.samples.erase(stream.samples.begin() + 120,
                       stream.samples.begin() + 140);
  stream.samples.erase(stream.samples.begin() + 300,
                       stream.samples.begin() + 320);
  ImuIntegrator integrator(stream);
  const auto pair = integrator.SummarizePair({1.0, 3.0, 5.0}, {});
  EXPECT_EQ(pair[0].noise, integrator.Summarize(1.0, 3.0, {}).noise);
  EXPECT_EQ(pair[1].noise, integrator.Summarize(3.0, 5.0, {}).noise);
}

/// Scatter of simulated noisy summaries against the computed covariance: for
/// N runs the sum of normalised squares of a 15-vector is chi-square of 15 N.
void CheckNoise(const ImuNoise& noise) {
  constexpr int kRuns = testing::SeedCount(400);
  constexpr double kRate = 50.0;
  const ImuStream clean = LivelyImu(2.0, kRate, noise);
  ImuIntegrator exact(clean);
  const ImuSummary truth = exact.Summarize(0.0, 2.0, {});
  Eigen::Matrix<double, 15, 15> S = Eigen::Matrix<double, 15, 15>::Zero();
  S.topLeftCorner<9, 9>() = truth.noise;
  S.topRightCorner<9, 6>() = truth.bias_cross;
  S.bottomLeftCorner<6, 9>() = truth.bias_cross.transpose();
  S.diagonal().segment<3>(9).setConstant(truth.gyro_bias_variance);
  S.diagonal().segment<3>(12).setConstant(truth.accel_bias_variance);
  const int dim = noise.gyro_bias_walk > 0.0 ? 15 : 9;
  const Eigen::MatrixXd S_used = S.topLeftCorner(dim, dim);
  const Eigen::LLT<Eigen::MatrixXd> llt(S_used);
  ASSERT_EQ(llt.info(), Eigen::Success);

  Random random(11);
  double sum = 0.0;
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(dim, dim);
  for (int run = 0; run < kRuns; ++run) {
    Preintegrator noisy(noise, false);
    noisy.Start(0.0, {});
    Eigen::Vector3d b_g = Eigen::Vector3d::Zero();
    Eigen::Vector3d b_a = Eigen::Vector3d::Zero();
    const double dt = 1.0 / kRate;
    for (std::size_t k = 1; k < clean.samples.size(); ++k) {
      LinearRates r = exact.RatesOfInterval(k);
      const Eigen::Vector3d n_g = b_g + noise.gyro_noise_density /
                                            std::sqrt(dt) *
                                            random.NormalVector3();
      const Eigen::Vector3d n_a = b_a + noise.accel_noise_density /
                                            std::sqrt(dt) *
                                            random.NormalVector3();
      r.w0 += n_g;
      r.w1 += n_g;
      r.f0 += n_a;
      r.f1 += n_a;
      noisy.Add(r);
      b_g = noise.GyroBiasEvolution().Phi(dt) * b_g +
            std::sqrt(noise.GyroBiasEvolution().Q(dt)) * random.NormalVector3();
      b_a =
          noise.AccelBiasEvolution().Phi(dt) * b_a +
          std::sqrt(noise.AccelBiasEvolution().Q(dt)) * random.NormalVector3();
    }
    const ImuSummary s = noisy.Finish();
    Eigen::Matrix<double, 15, 1> e;
    // True minus preintegrated, and the bias the run has accumulated.
    e << truth.dp - s.dp, truth.dv - s.dv, Log(s.dR.conjugate() * truth.dR),
        b_g, b_a;
    const Eigen::VectorXd used = e.head(dim);
    sum += llt.matrixL().solve(used).squaredNorm();
    scatter += used * used.transpose() / kRuns;
  }
  const boost::math::chi_squared distribution(dim * kRuns);
  EXPECT_GT(sum, boost::math::quantile(distribution, 0.0005));
  EXPECT_LT(sum, boost::math::quantile(distribution, 0.9995));
  // Each variance within 4.5 standard deviations of a sample variance.
  for (int i = 0; i < dim; ++i) {
    EXPECT_NEAR(scatter(i, i) / S_used(i, i), 1.0, 4.5 * std::sqrt(2.0 / kRuns))
        << i;
  }
}

TEST(Preintegration, WhiteNoiseCovarianceMatchesMonteCarlo) {
  ImuNoise noise;
  noise.gyro_noise_density = 1e-3;
  noise.accel_noise_density = 2e-3;
  CheckNoise(noise);
}

TEST(Preintegration, BiasWalkCovarianceMatchesMonteCarlo) {
  ImuNoise noise;
  noise.gyro_noise_density = 2e-4;
  noise.accel_noise_density = 1e-3;
  noise.gyro_bias_walk = 1e-3;
  noise.accel_bias_walk = 5e-3;
  CheckNoise(noise);
}

TEST(Preintegration, GaussMarkovBiasCovarianceMatchesMonteCarlo) {
  ImuNoise noise;
  noise.gyro_noise_density = 2e-4;
  noise.accel_noise_density = 1e-3;
  noise.gyro_bias_walk = 1e-3;
  noise.accel_bias_walk = 5e-3;
  noise.gyro_bias_tau = 1.0;
  noise.accel_bias_tau = 3.0;
  CheckNoise(noise);
}

TEST(Preintegration, GaussMarkovBiasDecaysWithinTheInterval) {
  ImuNoise noise;
  noise.gyro_bias_walk = 1e-4;
  noise.gyro_bias_tau = 0.7;
  noise.accel_bias_walk = 1e-4;
  noise.accel_bias_tau = 1.5;
  const ImuStream clean = LivelyImu(2.0, 200.0, noise);
  const Eigen::Vector3d b0(1e-4, -2e-4, 3e-4);
  const Eigen::Vector3d a0(1e-3, 2e-3, -1e-3);
  ImuStream biased = clean;
  for (ImuSample& s : biased.samples) {
    s.gyro += std::exp(-s.t / noise.gyro_bias_tau) * b0;
    s.accel += std::exp(-s.t / noise.accel_bias_tau) * a0;
  }
  const ImuSummary truth = ImuIntegrator(clean).Summarize(0.0, 2.0, {});
  const ImuSummary s = ImuIntegrator(biased).Summarize(0.0, 2.0, {});
  const CorrectedMean mean = Correct(s, {b0, a0, {0, 0, 0}, {0, 0, 0}});
  EXPECT_LT(Log(mean.dR.conjugate() * truth.dR).norm(), 1e-7);
  EXPECT_LT((mean.dv - truth.dv).norm(), 1e-6);
  EXPECT_LT((mean.dp - truth.dp).norm(), 1e-6);
}

TEST(Preintegration, RefusesAnIntervalOutsideTheStream) {
  const ImuStream stream = LivelyImu(1.0, 100.0);
  ImuIntegrator integrator(stream);
  EXPECT_THROW(integrator.Summarize(0.5, 1.5, {}), EstimationError);
  EXPECT_THROW(integrator.Summarize(-0.5, 0.5, {}), EstimationError);
}

}  // namespace
}  // namespace hindsight
