#include <cmath>

#include "geometry/so3.h"
#include "imu/preintegration.h"

namespace hindsight {

template <typename Real>
ImuSummary PreintegratorOf<Real>::Summary()
    const requires std::same_as<Real, double> {
  ImuSummary out;
  out.t_i = t_i_;
  out.t_j = t_i_ + T_;
  out.calibration = calibration_;
  out.dR = q_.normalized();
  out.dv = v_;
  out.dp = p_;
  out.R_bg = -S_g_;
  out.v_bg = V_g_;
  out.p_bg = P_g_;
  out.v_ba = -S_a_;
  out.p_ba = -P_a_;
  if (with_scale_) {
    // An error ds of the scale factor acts as a bias error of ds times the
    // true rate in the raw reading; calibration divides that by 1 + s.
    const Eigen::Array3d g = 1.0 / (1.0 + calibration_.s_g.array());
    const Eigen::Array3d a = 1.0 / (1.0 + calibration_.s_a.array());
    out.R_sg = -U_g_ * g.matrix().asDiagonal();
    out.v_sg = VU_g_ * g.matrix().asDiagonal();
    out.p_sg = PU_g_ * g.matrix().asDiagonal();
    out.v_sa = -U_a_ * a.matrix().asDiagonal();
    out.p_sa = -PU_a_ * a.matrix().asDiagonal();
    out.R_bg *= g.matrix().asDiagonal();
    out.v_bg *= g.matrix().asDiagonal();
    out.p_bg *= g.matrix().asDiagonal();
    out.v_ba *= a.matrix().asDiagonal();
    out.p_ba *= a.matrix().asDiagonal();
  } else {
    for (Eigen::Matrix3d* m :
         {&out.R_sg, &out.v_sg, &out.p_sg, &out.v_sa, &out.p_sa}) {
      m->setZero();
    }
  }
  out.gyro_bias_phi = noise_.GyroBiasEvolution().Phi(T_);
  out.accel_bias_phi = noise_.AccelBiasEvolution().Phi(T_);
  AssembleWhiteNoise(&out);
  out.bias_cross.setZero();
  if (has_bias_noise_) AssembleBiasNoise(&out);
  // e_R is wanted in the body axes at t_j.
  const Eigen::Matrix3d C_T = out.dR.conjugate().toRotationMatrix();
  out.noise.bottomRows<3>() = (C_T * out.noise.bottomRows<3>()).eval();
  out.noise.rightCols<3>() =
      (out.noise.rightCols<3>() * C_T.transpose()).eval();
  out.bias_cross.bottomRows<3>() =
      (C_T * out.bias_cross.bottomRows<3>()).eval();
  return out;
}

template <typename Real>
void PreintegratorOf<Real>::AssembleWhiteNoise(
    ImuSummary* out) const requires std::same_as<Real, double> {
  // A rotation error eps made at s moves velocity by -[a x] eps and position by
  // -[b x] eps, a = v(T) - v(s), b = p(T) - p(s) - (T - s) v(s)
  // = (p(T) - T v(s)) - u(s), and [a x][b x]' = (a.b) I - b a'.
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const double T = T_;
  const Eigen::Vector3d m_a = q_sum_ * v_ - qv_;
  const Eigen::Vector3d m_b = q_sum_ * p_ - T * qv_ - qu_;
  const Eigen::Matrix3d m_aa = q_sum_ * v_ * v_.transpose() -
                               v_ * qv_.transpose() - qv_ * v_.transpose() +
                               qvv_;
  // sum of q a b'
  const Eigen::Matrix3d m_ab =
      v_ * m_b.transpose() - qv_ * p_.transpose() + T * qvv_ + qvu_;
  // sum of q b b'
  const Eigen::Matrix3d m_sb = T * qvv_ + qvu_;  // of v (T v + u)'
  const Eigen::Matrix3d m_ub = T * qvu_.transpose() + quu_;
  const Eigen::Vector3d m_w = T * qv_ + qu_;
  const Eigen::Matrix3d m_bb = q_sum_ * p_ * p_.transpose() -
                               p_ * m_w.transpose() - m_w * p_.transpose() +
                               T * m_sb + m_ub;
  // sums of q (T - s)^2, q (T - s), q.
  const double a_pp = T * T * a_sum_ - 2.0 * T * as_ + ass_;
  const double a_pv = T * a_sum_ - as_;
  auto& N = out->noise;
  N.block<3, 3>(0, 0) = m_bb.trace() * I - m_bb + a_pp * I;
  N.block<3, 3>(3, 3) = m_aa.trace() * I - m_aa + a_sum_ * I;
  // e_p e_v' = [b x][a x]' = (a.b) I - a b'.
  N.block<3, 3>(0, 3) = m_ab.trace() * I - m_ab + a_pv * I;
  N.block<3, 3>(6, 6) = q_sum_ * I;
  N.block<3, 3>(0, 6) = -Skew(m_b);
  N.block<3, 3>(3, 6) = -Skew(m_a);
  N.block<3, 3>(3, 0) = N.block<3, 3>(0, 3).transpose();
  N.block<3, 3>(6, 0) = N.block<3, 3>(0, 6).transpose();
  N.block<3, 3>(6, 3) = N.block<3, 3>(3, 6).transpose();
}

template <typename Real>
void PreintegratorOf<Real>::AssembleBiasNoise(
    ImuSummary* out) const requires std::same_as<Real, double> {
  using Matrix93 = Eigen::Matrix<double, 9, 3>;
  using Matrix63 = Eigen::Matrix<double, 6, 3>;
  using Matrix9 = Eigen::Matrix<double, 9, 9>;
  const double q_g = noise_.gyro_bias_walk * noise_.gyro_bias_walk;
  const double q_a = noise_.accel_bias_walk * noise_.accel_bias_walk;
  out->gyro_bias_variance = noise_.GyroBiasEvolution().Q(T_);
  out->accel_bias_variance = noise_.AccelBiasEvolution().Q(T_);
  // Trapezoidal in s over the snapshots; the sensitivity vanishes at s = T.
  for (int k = 0; k < snapshot_count_; ++k) {
    const Snapshot& x = snapshots_[static_cast<std::size_t>(k)];
    const double s_next = k + 1 < snapshot_count_
                              ? snapshots_[static_cast<std::size_t>(k + 1)].s
                              : T_;
    const double s_previous =
        k > 0 ? snapshots_[static_cast<std::size_t>(k - 1)].s : x.s;
    const double weight = 0.5 * (s_next - s_previous);
    const double left = T_ - x.s;
    const double grow_g =
        gauss_markov_ ? std::exp(x.s / noise_.gyro_bias_tau) : 1.0;
    const double grow_a =
        gauss_markov_ ? std::exp(x.s / noise_.accel_bias_tau) : 1.0;
    Matrix93 J_g;
    J_g.topRows<3>() =
        P_g_ - x.P_g - left * x.V_g - Skew(p_ - x.p - left * x.v) * x.S_g;
    J_g.middleRows<3>(3) = V_g_ - x.V_g - Skew(v_ - x.v) * x.S_g;
    J_g.bottomRows<3>() = -(S_g_ - x.S_g);
    J_g *= grow_g;
    Matrix63 J_a;  // attitude does not feel it
    J_a.topRows<3>() = -(P_a_ - x.P_a - left * x.S_a);
    J_a.bottomRows<3>() = -(S_a_ - x.S_a);
    J_a *= grow_a;
    const double decay_g =
        gauss_markov_ ? std::exp(-left / noise_.gyro_bias_tau) : 1.0;
    const double decay_a =
        gauss_markov_ ? std::exp(-left / noise_.accel_bias_tau) : 1.0;
    // By elements: a general product would copy such small factors first.
    Matrix9 spread = q_g * J_g.lazyProduct(J_g.transpose());
    spread.topLeftCorner<6, 6>() += q_a * J_a.lazyProduct(J_a.transpose());
    out->noise += weight * spread;
    out->bias_cross.leftCols<3>() += (weight * q_g * decay_g) * J_g;
    out->bias_cross.topRightCorner<6, 3>() += (weight * q_a * decay_a) * J_a;
  }
}

template ImuSummary PreintegratorOf<double>::Summary() const;

}  // namespace hindsight
