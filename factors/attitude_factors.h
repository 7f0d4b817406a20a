#ifndef HINDSIGHT_FACTORS_ATTITUDE_FACTORS_H_
#define HINDSIGHT_FACTORS_ATTITUDE_FACTORS_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace hindsight {

/// Residuals of a problem of attitude alone, for ceres::AutoDiffCostFunction.
/// Blocks: q_nb (Eigen's order x y z w), gyro bias b_g [rad/s], magnetic
/// disturbance d_n [uT]. Each comes whitened.
template <typename T>
using FactorQuaternion = Eigen::Map<const Eigen::Quaternion<T>>;
template <typename T>
using FactorVector3 = Eigen::Map<const Eigen::Matrix<T, 3, 1>>;

/// Preintegrated gyros over one interval, and the bias's walk:
///   r_R = W Log(dR'^-1 q_i^-1 Exp(w_ie_n dt) q_j),
///   dR' = Exp(R_bg (b_i - b_0) + R_sg s_g) dR,
///   r_b = (b_j - b_i) / bias_sigma.
/// The logarithm is taken as twice the vector part, right to the cube of a
/// residual of some mrad.
struct RotationResidual {
  Eigen::Quaterniond dR;
  Eigen::Matrix3d R_bg, R_sg;
  Eigen::Vector3d b_0;
  Eigen::Quaterniond earth;   ///< Exp(w_ie_n dt)
  Eigen::Matrix3d whitening;  ///< W, W' W = covariance^-1
  double bias_sigma = 1.0;    ///< [rad/s]

  /// Blocks q_i, b_i, q_j, b_j and the gyros' scale factors s_g.
  template <typename T>
  bool operator()(const T* q_i, const T* b_i, const T* q_j, const T* b_j,
                  const T* s_g, T* residual) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    using Quaternion = Eigen::Quaternion<T>;
    const FactorVector3<T> b(b_i);
    const Vector half = T(0.5) * (R_bg.cast<T>() * (b - b_0.cast<T>()) +
                                  R_sg.cast<T>() * FactorVector3<T>(s_g));
    const Quaternion turn(T(1.0), half.x(), half.y(), half.z());
    const Quaternion step = turn.normalized() * dR.cast<T>();
    const Quaternion e = step.conjugate() *
                         FactorQuaternion<T>(q_i).conjugate() *
                         earth.cast<T>() * FactorQuaternion<T>(q_j);
    const T sign = e.w() < T(0.0) ? T(-2.0) : T(2.0);
    Eigen::Map<Eigen::Matrix<T, 6, 1>> r(residual);
    const Vector miss = sign * e.vec();
    r.template head<3>() = whitening.cast<T>() * miss;
    r.template tail<3>() = (FactorVector3<T>(b_j) - b) / T(bias_sigma);
    return true;
  }
};

/// Specific force averaged in axes that do not turn, as tilt sensor:
///   north and east of C_nb f_b, over sigma.
struct GravityResidual {
  Eigen::Vector3d f_b;  ///< [m/s^2]
  double sigma = 1.0;   ///< [m/s^2]

  template <typename T>
  bool operator()(const T* q, T* residual) const {
    const Eigen::Matrix<T, 3, 1> f_n =
        FactorQuaternion<T>(q) * f_b.cast<T>().eval();
    residual[0] = f_n.x() / T(sigma);
    residual[1] = f_n.y() / T(sigma);
    return true;
  }
};

/// Field as a vector: (m_b - C_bn (m_n + d_n)) over sigma, m_n of horizontal
/// part H, vertical part V and declination D. Hard iron already removed.
struct FieldResidual {
  Eigen::Vector3d m_b;  ///< [uT]
  double sigma = 1.0;   ///< [uT]

  /// Blocks q, d_n, (H, V) [uT] and D [rad].
  template <typename T>
  bool operator()(const T* q, const T* d_n, const T* field,
                  const T* declination, T* residual) const {
    using std::cos;
    using std::sin;
    const Eigen::Matrix<T, 3, 1> m_n(field[0] * cos(*declination),
                                     field[0] * sin(*declination), field[1]);
    const Eigen::Matrix<T, 3, 1> total = m_n + FactorVector3<T>(d_n);
    Eigen::Map<Eigen::Matrix<T, 3, 1>> r(residual);
    r = (m_b.cast<T>() - FactorQuaternion<T>(q).conjugate() * total) / T(sigma);
    return true;
  }
};

/// First-order Gauss-Markov step, (d_j - phi d_i) over sigma.
struct MarkovResidual {
  double phi = 1.0;
  double sigma = 1.0;

  template <typename T>
  bool operator()(const T* d_i, const T* d_j, T* residual) const {
    for (int i = 0; i < 3; ++i) {
      residual[i] = (d_j[i] - T(phi) * d_i[i]) / T(sigma);
    }
    return true;
  }
};

/// Attitude known beforehand: Log(q q_0^-1) in NED, over sigma.
struct AttitudePriorResidual {
  Eigen::Quaterniond q_0;
  Eigen::Vector3d sigma;  ///< [rad]

  template <typename T>
  bool operator()(const T* q, T* residual) const {
    const Eigen::Quaternion<T> e =
        FactorQuaternion<T>(q) * q_0.conjugate().cast<T>();
    const T sign = e.w() < T(0.0) ? T(-2.0) : T(2.0);
    residual[0] = sign * e.x() / T(sigma.x());
    residual[1] = sign * e.y() / T(sigma.y());
    residual[2] = sign * e.z() / T(sigma.z());
    return true;
  }
};

}  // namespace hindsight

#endif  // HINDSIGHT_FACTORS_ATTITUDE_FACTORS_H_
