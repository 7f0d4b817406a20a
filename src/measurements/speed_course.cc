#include "measurements/speed_course.h"

#include <algorithm>
#include <cmath>

#include "geometry/so3.h"
#include "measurements/point_motion.h"

namespace hindsight {

void SpeedCourse::Evaluate(const ModelContext& context,
                           LinearizedMeasurement* out) const {
  const PointMotion motion = MotionOfSensor(context);
  const Eigen::Matrix3d C_ne = motion.C_en.transpose();
  const Eigen::Vector3d v_n = C_ne * motion.v_e;
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMaxRows, 3> axes(rows(), 3);
  out->Resize(rows(), context.layout.dim());
  if (has_course) {
    constexpr double kSlow = 1.0;
    const double s = std::sin(course);
    const double c = std::cos(course);
    axes << c, s, 0.0, -s, c, 0.0;
    out->residual = -axes * v_n;
    out->residual(0) += speed;
    const double sigma_across = std::max(std::abs(speed), kSlow) * sigma_course;
    out->R(1, 1) = sigma_across * sigma_across;
    out->R(0, 0) = sigma_speed * sigma_speed;
  } else if (is_slow()) {
    axes << 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
    out->residual = -axes * v_n;
    out->R.diagonal().setConstant(speed * speed + sigma_speed * sigma_speed);
  } else {
    const double predicted = std::max(v_n.head<2>().norm(), sigma_speed);
    axes << v_n.x() / predicted, v_n.y() / predicted, 0.0;
    out->residual(0) = speed - predicted;
    out->R(0, 0) = sigma_speed * sigma_speed;
  }
  AddVelocityColumns(context, motion, axes * C_ne, &out->H);
  context.layout.AddColumns(BlockKind::kPosition, BlockKey::kNoSensor,
                            axes * Skew(v_n) * NedTurn(context.state.p_e),
                            &out->H);
}

}  // namespace hindsight
