#include "geometry/so3.h"
#include "imu/preintegration.h"

namespace hindsight {

ImuSummary EmptyMean(double t, const ImuCalibration& calibration) {
  ImuSummary mean;
  mean.t_i = mean.t_j = t;
  mean.calibration = calibration;
  for (Eigen::Matrix3d* m :
       {&mean.R_bg, &mean.v_bg, &mean.p_bg, &mean.v_ba, &mean.p_ba, &mean.R_sg,
        &mean.v_sg, &mean.p_sg, &mean.v_sa, &mean.p_sa}) {
    m->setZero();
  }
  mean.noise.setZero();
  mean.bias_cross.setZero();
  return mean;
}

CorrectedMean Correct(const ImuSummary& summary, const ImuCalibration& at) {
  const Eigen::Vector3d d_bg = at.b_g - summary.calibration.b_g;
  const Eigen::Vector3d d_ba = at.b_a - summary.calibration.b_a;
  CorrectedMean mean;
  mean.rotation_correction = summary.R_bg * d_bg;
  mean.dv = summary.dv + summary.v_bg * d_bg + summary.v_ba * d_ba;
  mean.dp = summary.dp + summary.p_bg * d_bg + summary.p_ba * d_ba;
  const Eigen::Vector3d d_sg = at.s_g - summary.calibration.s_g;
  const Eigen::Vector3d d_sa = at.s_a - summary.calibration.s_a;
  if (!d_sg.isZero(0.0) || !d_sa.isZero(0.0)) {
    mean.rotation_correction += summary.R_sg * d_sg;
    mean.dv += summary.v_sg * d_sg + summary.v_sa * d_sa;
    mean.dp += summary.p_sg * d_sg + summary.p_sa * d_sa;
  }
  mean.dR = Exp(mean.rotation_correction) * summary.dR;
  return mean;
}

bool NeedsReintegration(const ImuSummary& summary, const ImuCalibration& at) {
  constexpr double kMaxRotation = 1e-3;
  const Eigen::Vector3d d_sg = at.s_g - summary.calibration.s_g;
  const double rotation =
      (summary.R_bg * (at.b_g - summary.calibration.b_g)).norm() +
      (d_sg.isZero(0.0) ? 0.0 : (summary.R_sg * d_sg).norm());
  const Eigen::Vector3d d_sa = at.s_a - summary.calibration.s_a;
  return rotation > kMaxRotation || d_sa.norm() > kMaxRotation;
}

}  // namespace hindsight
