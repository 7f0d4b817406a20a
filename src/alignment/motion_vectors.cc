#include "alignment/motion_vectors.h"

#include <algorithm>
#include <cmath>

#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "imu/preintegration.h"

namespace hindsight {
namespace {

/// A fix of either kind at its true time.
struct TimedVector {
  double t = 0.0;
  Eigen::Vector3d value;  ///< v_n or p_e
  Eigen::Vector3d l_b;
  double sigma = 0.0;
};

template <typename Model, typename Get>
std::vector<TimedVector> Collect(const AlignmentInput& input, double t_end,
                                 const Get& get) {
  std::vector<TimedVector> out;
  for (const AidingStream& stream : input.dataset.streams) {
    for (const Measurement& z : stream.measurements) {
      const double t = z.t + stream.sensor.time_offset;
      const auto* fix = std::get_if<Model>(&z.model);
      if (fix == nullptr || z.withheld || t < input.t || t > t_end) continue;
      out.push_back({t, get(*fix), stream.sensor.lever_arm_b,
                     std::sqrt(fix->R_n.trace() / 3.0)});
    }
  }
  std::stable_sort(
      out.begin(), out.end(),
      [](const TimedVector& x, const TimedVector& y) { return x.t < y.t; });
  return out;
}

/// The IMU's integrals from t_0 on, interval after interval.
class RunningIntegral {
 public:
  RunningIntegral(const ImuStream& imu, double t_0,
                  const ImuCalibration& calibration)
      : integrator_(imu), calibration_(calibration), t_(t_0) {
    R_bg_.setZero();
    v_.setZero();
    p_.setZero();
  }

  void AdvanceTo(double t) {
    if (t <= t_) return;
    const ImuSummary s = integrator_.Summarize(t_, t, calibration_);
    const double dt = s.dt();
    const Eigen::Matrix3d C = dR_.toRotationMatrix();
    const Eigen::Vector3d dv = C * s.dv;
    const Eigen::Vector3d dp = C * s.dp;
    p_ += dt * v_;
    p_.leftCols<3>() += C * s.p_bg - Skew(dp) * R_bg_;
    p_.rightCols<3>() += C * s.p_ba;
    v_.leftCols<3>() += C * s.v_bg - Skew(dv) * R_bg_;
    v_.rightCols<3>() += C * s.v_ba;
    R_bg_ += C * s.R_bg;
    dp_ += dt * dv_ + dp;
    dv_ += dv;
    dR_ = (dR_ * s.dR).normalized();
    t_ = t;
  }

  MotionVector Velocity(const Eigen::Vector3d& l_b) {
    MotionVector out;
    const Eigen::Vector3d swing =
        (integrator_.ReadingAt(t_).w_ib_b - calibration_.b_g).cross(l_b);
    out.b = dv_ + dR_ * swing;
    out.J = v_;
    return out;
  }

  MotionVector Position(const Eigen::Vector3d& l_b) const {
    MotionVector out;
    out.b = dp_ + dR_ * l_b;
    out.J = p_;
    return out;
  }

 private:
  ImuIntegrator integrator_;
  ImuCalibration calibration_;
  double t_;
  Eigen::Quaterniond dR_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d dv_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d dp_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_bg_;
  Eigen::Matrix<double, 3, 6> v_, p_;
};

/// The path of the vehicle and the integrals of gravitation along it, in
/// inertial axes, from point to point.
class Path {
 public:
  Path(double t_0, const Eigen::Vector3d& p_e)
      : t_0_(t_0), t_(t_0), p_e_(p_e), g_(Gravitation(p_e)) {}

  /// Moves on with a velocity, or to a position.
  void MoveBy(double t, const Eigen::Vector3d& v_n) {
    const Eigen::Vector3d v_e = NedAxes(p_e_) * v_n;
    MoveTo(t, p_e_ + 0.5 * (t - t_) * ((t_ > t_0_ ? v_e_ : v_e) + v_e));
    v_e_ = v_e;
  }

  void MoveTo(double t, const Eigen::Vector3d& p_e) {
    const double dt = t - t_;
    const Eigen::Vector3d g = Turn(t) * Gravitation(p_e);
    integral_2_ += dt * integral_1_ + dt * dt * (g_ / 3.0 + g / 6.0);
    integral_1_ += 0.5 * dt * (g_ + g);
    g_ = g;
    p_e_ = p_e;
    t_ = t;
  }

  Eigen::Vector3d Velocity(const Eigen::Vector3d& v_n) const {
    const Eigen::Vector3d v_e = NedAxes(p_e_) * v_n;
    return Turn(t_) * (v_e + EarthRate_e().cross(p_e_)) - integral_1_;
  }
  Eigen::Vector3d Position() const { return Turn(t_) * p_e_ - integral_2_; }

 private:
  Eigen::Quaterniond Turn(double t) const {
    return Exp((t - t_0_) * EarthRate_e());
  }

  double t_0_;
  double t_;
  Eigen::Vector3d p_e_;
  Eigen::Vector3d v_e_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d g_;
  Eigen::Vector3d integral_1_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d integral_2_ = Eigen::Vector3d::Zero();
};

}  // namespace

MotionVectors CollectMotion(const AlignmentInput& input, double t_end,
                            const Eigen::Vector3d& b_g,
                            const Eigen::Vector3d& b_a) {
  MotionVectors motion;
  std::vector<TimedVector> fixes = Collect<VelocityFix>(
      input, t_end, [](const VelocityFix& fix) { return fix.v_n; });
  motion.of_velocity = !fixes.empty();
  if (!motion.of_velocity) {
    fixes = Collect<PositionFix>(
        input, t_end, [](const PositionFix& fix) { return fix.p_e; });
  }
  ImuCalibration calibration;
  calibration.b_g = b_g;
  calibration.b_a = b_a;
  RunningIntegral integral(input.dataset.imu, input.t, calibration);
  Path path(input.t, input.p_e);
  for (const TimedVector& fix : fixes) {
    integral.AdvanceTo(fix.t);
    MotionVector vector = motion.of_velocity ? integral.Velocity(fix.l_b)
                                             : integral.Position(fix.l_b);
    if (motion.of_velocity) {
      path.MoveBy(fix.t, fix.value);
      vector.a = path.Velocity(fix.value);
    } else {
      path.MoveTo(fix.t, fix.value);
      vector.a = path.Position();
    }
    vector.t = fix.t;
    vector.sigma = fix.sigma;
    motion.vectors.push_back(std::move(vector));
  }
  return motion;
}

}  // namespace hindsight
