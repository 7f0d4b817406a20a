#include "dataset/truth_lever_arm.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "imu/preintegration.h"

namespace hindsight {
namespace {

using Matrix36 = Eigen::Matrix<double, 3, 6>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Normal equations of l and b.
struct Sums {
  Matrix6 N = Matrix6::Zero();
  Vector6 n = Vector6::Zero();
  double squares = 0.0;
  int rows = 0;

  void Add(const Matrix36& A, const Eigen::Vector3d& z) {
    N += A.transpose() * A;
    n += A.transpose() * z;
    squares += z.squaredNorm();
    rows += 3;
  }
};

Matrix6 WithPrior(Matrix6 N, double weight) {
  N.diagonal().head<3>().array() += weight;
  return N;
}

double SquaresLeft(const Sums& sums, double weight) {
  const Eigen::LDLT<Matrix6> factor(WithPrior(sums.N, weight));
  return std::max(0.0, sums.squares - sums.n.dot(factor.solve(sums.n)));
}

class Pairs {
 public:
  explicit Pairs(const Dataset& dataset)
      : integrator_(dataset.imu), b_g_(dataset.initial.gyro_bias) {
    calibration_.b_g = b_g_;
  }

  void Add(const TruthPoint& i, const TruthPoint& j, Sums* sums) {
    const double dt = j.t - i.t;
    const Eigen::Matrix3d C_en = NedAxes(*i.p_e);
    const Eigen::Matrix3d C_i = C_en * i.q_nb->toRotationMatrix();
    const Eigen::Matrix3d C_j = NedAxes(*j.p_e) * j.q_nb->toRotationMatrix();
    const Eigen::Vector3d v_i = C_en * *i.v_n;
    const Eigen::Vector3d v_j = NedAxes(*j.p_e) * *j.v_n;
    const Eigen::Vector3d free =
        Gravity(*i.p_e) - 2.0 * EarthRate_e().cross(v_i);
    const ImuSummary summary = integrator_.Summarize(i.t, j.t, calibration_);
    const Eigen::Vector3d z =
        C_i.transpose() * (v_j - v_i - dt * free) - summary.dv;
    Matrix36 A;
    A.leftCols<3>() =
        C_i.transpose() * C_j * Skew(RateAt(j.t)) - Skew(RateAt(i.t));
    A.rightCols<3>() = -dt * Eigen::Matrix3d::Identity();
    sums->Add(A, z);
  }

 private:
  Eigen::Vector3d RateAt(double t) {
    return integrator_.ReadingAt(t).w_ib_b - b_g_;
  }

  ImuIntegrator integrator_;
  Eigen::Vector3d b_g_;
  ImuCalibration calibration_;
};

}  // namespace

std::optional<TruthLeverArm> FindTruthLeverArm(const Dataset& dataset) {
  constexpr double kLongest = 2.0;   // s
  constexpr double kShortest = 0.5;  // s, or the truth's noise outweighs it
  constexpr int kFewest = 20;
  constexpr double kPrior = 3.0;  // m
  const ImuStream& imu = dataset.imu;
  Pairs pairs(dataset);
  Sums sums;
  std::optional<TruthPoint> last;
  for (const TruthPoint& point : dataset.truth) {
    if (point.t < imu.t_begin() || point.t > imu.t_end()) continue;
    if (!point.p_e || !point.v_n || !point.q_nb) continue;
    if (last && point.t - last->t < kShortest) continue;
    if (last && point.t - last->t <= kLongest) pairs.Add(*last, point, &sums);
    last = point;
  }
  if (sums.rows < 3 * kFewest) return std::nullopt;
  // What no turn shows stays at zero, as uncertain as it is beforehand.
  const double left = SquaresLeft(sums, 1e-12 * sums.N.trace());
  const double variance = left / (sums.rows - 6);
  const Eigen::LDLT<Matrix6> factor(
      WithPrior(sums.N, variance / (kPrior * kPrior)));
  const Vector6 x = factor.solve(sums.n);
  const Matrix6 P = factor.solve(Matrix6::Identity()) * variance;
  TruthLeverArm found;
  found.l_b = x.head<3>();
  found.sigma = P.diagonal().head<3>().cwiseSqrt();
  return found;
}

}  // namespace hindsight
