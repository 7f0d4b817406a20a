#include "simulation/imu_simulator.h"

#include <algorithm>
#include <cmath>

#include "geometry/so3.h"
#include "imu/sample_integral.h"

namespace hindsight {

ImuSample InvertSample(double dt_previous, const ImuSample& previous, double dt,
                       const Eigen::Vector3d& phi, const Eigen::Vector3d& dv) {
  // The correction shrinks by the rotation of one sample at each pass.
  constexpr int kMaxPasses = 30;
  constexpr double kRelativeTolerance = 1e-16;
  ImuSample sample;
  sample.gyro = phi;
  sample.accel = dv;
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    const SampleIntegral integral = Integrate(
        RatesFromIncrements(dt_previous, previous.gyro, previous.accel, dt,
                            sample.gyro, sample.accel));
    const Eigen::Vector3d gyro_defect = phi - integral.phi;
    const Eigen::Vector3d accel_defect = dv - integral.dv;
    sample.gyro += gyro_defect;
    sample.accel += accel_defect;
    if (gyro_defect.norm() <= kRelativeTolerance * phi.norm() &&
        accel_defect.norm() <= kRelativeTolerance * dv.norm()) {
      break;
    }
  }
  return sample;
}

ImuSimulator::ImuSimulator(Trajectory* trajectory, ImuStream::Kind kind,
                           double rate_hz, double t_end)
    : trajectory_(trajectory), kind_(kind), rate_hz_(rate_hz) {
  constexpr double kStampTolerance = 1e-9;
  const double span = t_end - trajectory->t_begin();
  size_ = 1 + static_cast<std::size_t>(
                  std::floor(span * rate_hz * (1.0 + kStampTolerance)));
}

ImuSimulator::Inertial ImuSimulator::InertialOf(const Motion& m) {
  return {m.v_e + EarthRate_e().cross(m.p_e), Gravitation(m.p_e), m.q_eb};
}

bool ImuSimulator::Next(ImuSample* sample) {
  if (next_ == size_) return false;
  const double dt = 1.0 / rate_hz_;
  const double t =
      trajectory_->t_begin() + static_cast<double>(next_) / rate_hz_;
  const double t_before = motion_.t;
  motion_ = trajectory_->At(std::min(t, trajectory_->t_end()));
  motion_.t = t;
  if (kind_ == ImuStream::Kind::kRates || next_ == 0) {
    const Kinematics kinematics = TrueKinematics(motion_);
    const double scale = kind_ == ImuStream::Kind::kRates ? 1.0 : dt;
    sample->gyro = scale * kinematics.w_ib_b;
    sample->accel = scale * kinematics.f_b;
  }
  if (kind_ == ImuStream::Kind::kIncrements) {
    const Inertial at_start = inertial_;
    inertial_ = InertialOf(motion_);
    if (next_ > 0) {
      // The span of the two stamps, which rounding makes differ from 1/rate.
      const double span = t - t_before;
      const Eigen::Quaterniond E = Exp(EarthRate_e() * span);
      const Eigen::Quaterniond to_start = at_start.R.conjugate();
      const Eigen::Vector3d phi = Log(to_start * E * inertial_.R);
      const Eigen::Vector3d dv =
          to_start *
          (E * inertial_.V - at_start.V -
           (0.5 * span) * (at_start.gravitation + E * inertial_.gravitation));
      *sample = InvertSample(next_ == 1 ? span : previous_span_, previous_,
                             span, phi, dv);
      previous_span_ = span;
    }
    previous_ = *sample;
  }
  sample->t = t;
  ++next_;
  return true;
}

}  // namespace hindsight
