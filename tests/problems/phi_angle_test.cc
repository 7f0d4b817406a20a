#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "support/test_motion.h"

namespace hindsight {
namespace {

using Matrix15 = Eigen::Matrix<double, 15, 15>;

/// What the error equations of the 2002 paper are made of.
struct Quantities {
  double L, h, R_m, R_t;  ///< radii at height: R + h
  Eigen::Vector3d v;      ///< NED

  explicit Quantities(const State& x) {
    const Geodetic g = GeodeticFromEcef(x.p_e);
    L = g.latitude;
    h = g.height;
    R_m = MeridianRadius(L) + h;
    R_t = TransverseRadius(L) + h;
    v = x.v_n();
  }
};

/// Equations (31)-(42) over (dL, dl, dh, dv_N, dv_E, dv_D, phi, eps_g,
/// nabla_a), with what the print lost: the dots of (31)-(33), (35), (36); the
/// sign of rho_N sec^2 L in (38); and rho_D/v_E written as -tan L/(R_t + h).
Matrix15 PaperMatrix(const Quantities& q, const Eigen::Matrix3d& C_nb,
                     const Eigen::Vector3d& f_n) {
  const double sec = 1.0 / std::cos(q.L);
  const double tan = std::tan(q.L);
  const double rho_N = q.v.y() / q.R_t;
  const double rho_E = -q.v.x() / q.R_m;
  const double rho_D = -q.v.y() * tan / q.R_t;
  const Eigen::Vector3d w_en(rho_N, rho_E, rho_D);
  const Eigen::Vector3d w_ie(kEarthRate * std::cos(q.L), 0.0,
                             -kEarthRate * std::sin(q.L));
  // d w_ie and d w_en over the six components of position and velocity.
  Eigen::Matrix<double, 3, 6> dw_ie = Eigen::Matrix<double, 3, 6>::Zero();
  dw_ie(0, 0) = -kEarthRate * std::sin(q.L);
  dw_ie(2, 0) = -kEarthRate * std::cos(q.L);
  Eigen::Matrix<double, 3, 6> dw_en = Eigen::Matrix<double, 3, 6>::Zero();
  dw_en(0, 2) = -rho_N / q.R_t;
  dw_en(0, 4) = 1.0 / q.R_t;
  dw_en(1, 2) = -rho_E / q.R_m;
  dw_en(1, 3) = -1.0 / q.R_m;
  dw_en(2, 0) = -rho_N * sec * sec;
  dw_en(2, 2) = -rho_D / q.R_t;
  dw_en(2, 4) = -tan / q.R_t;

  Matrix15 F = Matrix15::Zero();
  F(0, 2) = rho_E / q.R_m;
  F(0, 3) = 1.0 / q.R_m;
  F(1, 0) = rho_N * sec * tan;
  F(1, 2) = -rho_N * sec / q.R_t;
  F(1, 4) = sec / q.R_t;
  F(2, 5) = -1.0;
  F.block<3, 6>(3, 0) = Skew(q.v) * (2.0 * dw_ie + dw_en);
  F.block<3, 3>(3, 3) -= Skew(2.0 * w_ie + w_en);
  F.block<3, 3>(3, 6) = Skew(f_n);
  F.block<3, 3>(3, 12) = C_nb;
  F.block<3, 6>(6, 0) = dw_ie + dw_en;
  F.block<3, 3>(6, 6) = -Skew(w_ie + w_en);
  F.block<3, 3>(6, 9) = -C_nb;
  return F;
}

/// From our error (dr, dv, psi, db_g, db_a), truth minus estimate, to the
/// paper's, estimate minus truth but for phi and biases:
///   phi = psi - dtheta,  dv_phi = dv - dtheta x v,
///   dtheta = (dr_E/R_t, -dr_N/R_m, -tan L dr_E/R_t).
Matrix15 ToPaper(const Quantities& q) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  turn(0, 1) = 1.0 / q.R_t;
  turn(1, 0) = -1.0 / q.R_m;
  turn(2, 1) = -std::tan(q.L) / q.R_t;
  Matrix15 T = Matrix15::Identity();
  T(0, 0) = -1.0 / q.R_m;
  T(1, 1) = -1.0 / (q.R_t * std::cos(q.L));
  T.block<3, 3>(3, 3) *= -1.0;
  T.block<3, 3>(3, 0) = -Skew(q.v) * turn;
  T.block<3, 3>(6, 0) = -turn;
  return T;
}

/// F of Phi = Exp(F h): the series of the logarithm, |Phi - I| < 1.
Matrix15 ContinuousDynamics(const ErrorMatrix& Phi, double h) {
  const Matrix15 X = Phi - Matrix15::Identity();
  Matrix15 power = X;
  Matrix15 sum = X;
  for (int k = 2; k <= 12; ++k) {
    power = (power * X).eval();
    sum += (k % 2 == 0 ? -1.0 : 1.0) / k * power;
  }
  return sum / h;
}

TEST(PhiAngleModel, EqualsOurDynamicsUpToTheTermsThePaperDrops) {
  const State begin = MakeState(0.0, {37.0 * kDegree, 127.0 * kDegree, 50.0},
                                {30.0, -20.0, 2.0}, {0.1, -0.2, 2.1});
  const Quantities q0(begin);
  constexpr double kSpan = 0.02;
  // A body that keeps its attitude to NED while it speeds up.
  const Eigen::Vector3d w_en =
      TransportRate_n(GeodeticFromEcef(begin.p_e), q0.v);
  const Eigen::Matrix3d C_nb =
      begin.C_en().transpose() * begin.q_eb.toRotationMatrix();
  const Eigen::Vector3d w_ie_n = begin.C_en().transpose() * EarthRate_e();
  const Eigen::Vector3d acceleration(1.0, -2.0, 0.5);
  const Eigen::Vector3d f_n = acceleration + (2.0 * w_ie_n + w_en).cross(q0.v) -
                              begin.C_en().transpose() * Gravity(begin.p_e);
  ImuStream imu;
  for (int k = 0; k <= 200; ++k) {
    imu.samples.push_back({k * kSpan / 200, C_nb.transpose() * (w_ie_n + w_en),
                           C_nb.transpose() * f_n});
  }
  const ErrorLayout layout = testing::TypicalLayout();
  ImuIntegrator integrator(imu);
  const ImuSummary half = integrator.Summarize(0.0, 0.5 * kSpan, {});
  const ImuSummary whole = integrator.Summarize(0.0, kSpan, {});
  const State middle = Predict(layout, begin, half);
  const State end = Predict(layout, begin, whole);
  Transition transition;
  LinearizeTransition(layout, whole, begin, end, &transition);

  const Matrix15 F = ContinuousDynamics(transition.Phi, kSpan);
  const Quantities q(middle);
  const Matrix15 T = ToPaper(q);
  const Matrix15 T_rate = (ToPaper(Quantities(end)) - ToPaper(q0)) / kSpan;
  // Latitude and longitude in metres, so that one bound fits all elements of a
  // block.
  Matrix15 metres = Matrix15::Identity();
  metres(0, 0) = q.R_m;
  metres(1, 1) = q.R_t * std::cos(q.L);
  const Matrix15 ours =
      metres * (T_rate + T * F) * T.inverse() * metres.inverse();
  const Matrix15 paper = metres * PaperMatrix(q, C_nb, f_n) * metres.inverse();
  Matrix15 dropped = ours - paper;

  // Dropped first: gravity falls off with height, in (dv_D, dh).
  const double g = Gravity(middle.p_e).norm();
  const double fall = 2.0 * g / kEarthSemiMajorAxis;
  EXPECT_NEAR(std::abs(dropped(5, 2)), fall, 0.01 * fall);
  dropped(5, 2) = 0.0;
  // Dropped second: the radii change with latitude, at most by 3 e^2 relative
  // over a radius; so do gravity and the direction of gravity, of order e^2.
  const double e2 = kEarthFlattening * (2.0 - kEarthFlattening);
  const double speed = q.v.norm();
  const double R = kEarthSemiMajorAxis;
  const double radii = 3.0 * e2;
  const auto largest_of = [](const Matrix15& M, int row, int column) {
    return M.block<3, 3>(row, column).cwiseAbs().maxCoeff();
  };
  const auto largest = [&](int row, int column) {
    return largest_of(dropped, row, column);
  };
  EXPECT_LT(largest(0, 0), radii * speed / R);
  EXPECT_LT(largest(3, 0), radii * g / R);
  EXPECT_LT(largest(6, 0), radii * (speed / R + kEarthRate) / R);
  // Everything else is the same system: what is left is the time that the
  // interval takes, h^2/12 [F, F'] with F' = w f (w below 1e-4 rad/s) and a/R.
  EXPECT_LT(largest(0, 3), 1e-9);
  EXPECT_LT(largest(3, 3), 1e-9);
  EXPECT_LT(largest(6, 3), 1e-14);
  EXPECT_LT(largest(0, 6), kSpan * kSpan / 6.0 * 1e-4 * g);
  EXPECT_LT(largest(3, 6), 1e-6 * g);
  EXPECT_LT(largest(6, 6), 1e-9);
  EXPECT_LT(largest(3, 12), 1e-6);
  EXPECT_LT(largest(6, 9), 1e-6);
  // The terms compared are there at all, each above its bound.
  EXPECT_GT(largest_of(paper, 0, 0), radii * speed / R);
  EXPECT_GT(largest_of(paper, 6, 0), radii * (speed / R + kEarthRate) / R);
  EXPECT_GT(largest_of(paper, 6, 3), 1e-8);
}

}  // namespace
}  // namespace hindsight
