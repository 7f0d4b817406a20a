#include "dataset/clock_rows.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>
#include <optional>

namespace hindsight {
namespace {

/// The velocity of a DVL in its own axes; nothing of fewer than three beams.
std::optional<Eigen::Vector3d> DvlVelocity(const Dvl& dvl) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> B(dvl.rows(), 3);
  Eigen::VectorXd z(dvl.rows());
  Eigen::Index row = 0;
  for (int i = 0; i < dvl.components(); ++i) {
    if (!dvl.valid[static_cast<std::size_t>(i)]) continue;
    B.row(row) = dvl.Direction(i).transpose();
    z(row++) = dvl.speed(i);
  }
  if (row < 3) return std::nullopt;
  return Eigen::Vector3d(B.colPivHouseholderQr().solve(z));
}

Eigen::Vector3d OdometerVelocity(const Odometer& odometer, double dt) {
  const double speed = odometer.form == Odometer::Form::kIncrements
                           ? odometer.distance / dt
                           : odometer.speed;
  return {speed, odometer.side_down.x(), odometer.side_down.y()};
}

double MeanSigma(const Eigen::Matrix3d& R) {
  return std::sqrt(R.trace() / 3.0);
}

}  // namespace

void TimedRows::Add(double time, const Eigen::Vector3d& v, double s) {
  if (!t.empty() && time <= t.back()) return;
  t.push_back(time);
  value.push_back(v);
  sigma.push_back(s);
}

TimedRows RowsOf(const AidingStream& stream) {
  TimedRows rows;
  const Eigen::Quaterniond q_bs = stream.sensor.q_sb.conjugate();
  for (const Measurement& z : stream.measurements) {
    if (z.withheld) continue;
    if (const auto* fix = std::get_if<PositionFix>(&z.model)) {
      rows.Add(z.t, fix->p_e, MeanSigma(fix->R_n));
    } else if (const auto* v = std::get_if<VelocityFix>(&z.model)) {
      rows.Add(z.t, v->v_n, MeanSigma(v->R_n));
    } else if (const auto* s = std::get_if<SpeedCourse>(&z.model)) {
      if (!s->has_course) continue;
      rows.Add(z.t,
               s->speed * Eigen::Vector3d(std::cos(s->course),
                                          std::sin(s->course), 0.0),
               s->sigma_speed);
    } else if (const auto* h = std::get_if<HeightFix>(&z.model)) {
      rows.Add(z.t, {h->height, 0.0, 0.0}, h->sigma);
    } else if (const auto* m = std::get_if<MagneticField>(&z.model)) {
      rows.Add(z.t, m->field_b, m->sigma);
    } else if (const auto* dvl = std::get_if<Dvl>(&z.model)) {
      const auto v_s = DvlVelocity(*dvl);
      if (v_s) rows.Add(z.t, q_bs * *v_s, dvl->sigma.head<3>().mean());
    } else if (const auto* odometer = std::get_if<Odometer>(&z.model)) {
      const bool counts = odometer->form == Odometer::Form::kIncrements;
      const double dt = z.t - odometer->t_from;
      rows.Add(counts ? z.t - 0.5 * dt : z.t,
               q_bs * OdometerVelocity(*odometer, dt),
               odometer->sigma.x() / (counts ? dt : 1.0));
    }
  }
  return rows;
}

}  // namespace hindsight
