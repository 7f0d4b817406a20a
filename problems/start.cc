#include "problems/start.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "base/error.h"
#include "base/units.h"
#include "dataset/ground_motion.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

// A priori values where neither the user nor the data say anything better: a
// consumer IMU straight from power-up.
constexpr double kDefaultGyroBiasSigma = 0.2 * kDegree;
constexpr double kDefaultAccelBiasSigma = 0.2;
constexpr double kCourseSpeed = 3.0;  // heading from course above [m/s]
constexpr double kUnknownHeadingSigma = 104.0 * kDegree;  // uniform on a circle
constexpr double kAssumedLevelSigma = 5.0 * kDegree;

std::string Words(const char* format, double a, double b = 0.0) {
  char buffer[160];
  std::snprintf(buffer, sizeof(buffer), format, a, b);
  return buffer;
}

/// Means of the readings over [begin, end].
Kinematics MeanReading(const ImuStream& imu, double begin, double end) {
  ImuIntegrator integrator(imu);
  Kinematics mean;
  constexpr int kCount = 400;
  for (int i = 0; i < kCount; ++i) {
    const Kinematics k =
        integrator.ReadingAt(begin + (i + 0.5) * (end - begin) / kCount);
    mean.w_ib_b += k.w_ib_b / kCount;
    mean.f_b += k.f_b / kCount;
  }
  return mean;
}

/// Works through the steps of FindStart; each fills its part of the report.
class StartFinder {
 public:
  StartFinder(const Dataset& dataset, double from, double to)
      : dataset_(dataset),
        from_(std::max(from, dataset.imu.t_begin())),
        to_(std::min(to, dataset.imu.t_end())) {}

  Start Find() {
    if (!(from_ < to_)) {
      throw InputError("no IMU data " +
                       (from_ > dataset_.imu.t_begin()
                            ? "after the asked " + std::to_string(from_)
                            : "before the asked " + std::to_string(to_)) +
                       " s: they cover " +
                       std::to_string(dataset_.imu.t_begin()) + " s to " +
                       std::to_string(dataset_.imu.t_end()) + " s");
    }
    fixes_ = PositionFixes(dataset_, from_, to_);
    velocities_ = GroundVelocities(dataset_, from_, to_);
    rests_ = FindRests(dataset_);
    ChooseTime();
    ChooseGyroBias();
    ChooseAttitude();
    ChooseHeading();
    ChooseVelocity();
    ChoosePosition();
    return Finish();
  }

 private:
  const InitialState& given() const { return dataset_.initial; }

  void ChooseTime() {
    if (given().t) {
      t_ = std::max(*given().t, from_);
    } else if (given().position) {
      t_ = from_;
    } else if (!fixes_.empty()) {
      t_ = fixes_.front().t;
      for (const TimeInterval& rest : rests_) {
        if (rest.begin <= from_ + 1.0 && rest.end >= t_) t_ = from_;
      }
    } else {
      throw EstimationError(
          "no initial position: give initial.position or a position stream "
          "with fixes inside the interval");
    }
    for (const TimeInterval& rest : rests_) {
      if (rest.begin <= t_ + 1.0 && rest.end > t_ + 1.0) {
        rest_ = TimeInterval{std::max(t_, rest.begin), rest.end};
      }
    }
  }

  /// At rest the mean rate is the bias, but for Earth rate. It makes the start
  /// value and the sigma with which the gyros carry heading; the a priori sigma
  /// is left as it was where zero-rate measurements will use the same data.
  void ChooseGyroBias() {
    b_g_ = given().gyro_bias;
    b_g_sigma_ = given().gyro_bias_sigma.value_or(
        Eigen::Vector3d::Constant(kDefaultGyroBiasSigma));
    gyro_sigma_ = b_g_sigma_.maxCoeff();
    if (!rest_) return;
    const double T = rest_->end - rest_->begin;
    const double sigma = std::hypot(
        dataset_.imu.noise.gyro_noise_density / std::sqrt(T), kEarthRate);
    const Eigen::Array3d weight = b_g_sigma_.array().square() /
                                  (b_g_sigma_.array().square() + sigma * sigma);
    const Eigen::Vector3d mean =
        MeanReading(dataset_.imu, rest_->begin, rest_->end).w_ib_b;
    b_g_ += (weight * (mean - b_g_).array()).matrix();
    gyro_sigma_ = std::min(gyro_sigma_, sigma);
    if (!dataset_.stationary.enabled) {
      b_g_sigma_ = b_g_sigma_.cwiseMin(sigma);
    }
  }

  void ChooseAttitude() {
    const double accel_sigma =
        given()
            .accel_bias_sigma
            .value_or(Eigen::Vector3d::Constant(kDefaultAccelBiasSigma))
            .maxCoeff();
    if (given().euler) {
      euler_ = *given().euler;
      euler_sigma_ = given().attitude_sigma.value_or(
          Eigen::Vector3d(1.0 * kDegree, 1.0 * kDegree, 2.0 * kDegree));
      report_.attitude = "given";
      return;
    }
    const double end = rest_ ? rest_->end : std::min(t_ + 1.0, to_);
    const Kinematics mean =
        MeanReading(dataset_.imu, rest_ ? rest_->begin : t_, end);
    const Eigen::Vector3d f = mean.f_b - given().accel_bias;
    euler_ = {std::atan2(-f.y(), -f.z()),
              std::atan2(f.x(), std::hypot(f.y(), f.z())), 0.0};
    const double tilt_sigma = accel_sigma / kStandardGravity;
    if (rest_) {
      report_.attitude =
          Words("levelled at rest for %.1f s", rest_->end - rest_->begin);
      euler_sigma_ = {tilt_sigma, tilt_sigma, kUnknownHeadingSigma};
      levelled_ = !given().attitude_sigma;
    } else {
      report_.attitude = "assumed near level, no rest at the start";
      euler_sigma_ = {kAssumedLevelSigma, kAssumedLevelSigma,
                      kUnknownHeadingSigma};
    }
    if (given().attitude_sigma) euler_sigma_ = *given().attitude_sigma;
  }

  void ChooseHeading() {
    if (given().euler) {
      report_.heading = "given";
      return;
    }
    if (given().heading) {
      euler_.z() = *given().heading;
      euler_sigma_.z() =
          given().attitude_sigma ? given().attitude_sigma->z() : 2.0 * kDegree;
      report_.heading = "given";
      return;
    }
    for (const TimedVelocity& v : velocities_) {
      const double speed = v.v_n.head<2>().norm();
      if (v.t < t_ || speed < std::max(kCourseSpeed, 10.0 * v.sigma)) continue;
      TakeCourse(v, speed);
      return;
    }
    report_.heading = "unknown: no motion above 3 m/s";
  }

  /// Carries the course at v.t back to the start with the gyros alone.
  void TakeCourse(const TimedVelocity& v, double speed) {
    const double course = std::atan2(v.v_n.y(), v.v_n.x());
    ImuCalibration calibration;
    calibration.b_g = b_g_;
    ImuIntegrator integrator(dataset_.imu);
    const ImuSummary summary = integrator.Summarize(t_, v.t, calibration);
    const Eigen::Quaterniond there =
        QuaternionFromEuler(euler_.x(), euler_.y(), 0.0) * summary.dR;
    euler_.z() = WrapAngle(course - EulerFromQuaternion(there).z());
    const double elapsed = v.t - t_;
    const double drift =
        std::hypot(gyro_sigma_ * elapsed,
                   dataset_.imu.noise.gyro_noise_density * std::sqrt(elapsed));
    // A few degrees of side slip and of antenna sway are not in v.sigma.
    constexpr double kCourseSigma = 3.0 * kDegree;
    euler_sigma_.z() = std::hypot(kCourseSigma, v.sigma / speed, drift);
    if (given().attitude_sigma) euler_sigma_.z() = given().attitude_sigma->z();
    report_.heading =
        Words("course at t = %.2f s (%.1f m/s), carried back by the gyros", v.t,
              speed);
  }

  void ChooseVelocity() {
    if (given().v_n) {
      v_n_ = *given().v_n;
      v_sigma_ =
          given().velocity_sigma.value_or(Eigen::Vector3d::Constant(0.1));
      return;
    }
    if (rest_) {
      v_sigma_.setConstant(0.05);
    } else if (!velocities_.empty()) {
      const TimedVelocity& nearest = *std::min_element(
          velocities_.begin(), velocities_.end(),
          [this](const TimedVelocity& a, const TimedVelocity& b) {
            return std::abs(a.t - t_) < std::abs(b.t - t_);
          });
      v_n_ = nearest.v_n;
      // It is used again as a measurement, or made of fixes that are.
      v_sigma_.setConstant(3.0 * nearest.sigma +
                           3.0 * std::abs(nearest.t - t_) + 0.2);
    } else {
      v_sigma_.setConstant(10.0);
    }
    if (given().velocity_sigma) v_sigma_ = *given().velocity_sigma;
  }

  void ChoosePosition() {
    if (given().position) {
      position_e_ = EcefFromGeodetic(*given().position);
      p_sigma_ =
          given().position_sigma.value_or(Eigen::Vector3d::Constant(1.0));
      report_.position = "given";
      return;
    }
    const TimedFix& fix = fixes_.front();
    const Eigen::Vector3d& lever_arm_b =
        dataset_.streams[static_cast<std::size_t>(fix.sensor)]
            .sensor.lever_arm_b;
    const Eigen::Matrix3d C_en = NedAxes(fix.p_e);
    const Eigen::Vector3d lever_n =
        QuaternionFromEuler(euler_.x(), euler_.y(), euler_.z()) * lever_arm_b;
    position_e_ = fix.p_e - C_en * (lever_n + (fix.t - t_) * v_n_);
    const double lever = lever_arm_b.norm();
    const double swing = lever * std::min(euler_sigma_.z(), 1.0) +
                         std::abs(fix.t - t_) * v_sigma_.x();
    // The fix itself is used again as a measurement: its own sigma would count
    // it twice.
    p_sigma_ = 3.0 * fix.R_n.diagonal().cwiseSqrt();
    p_sigma_.array() += swing + 1.0;
    if (given().position_sigma) p_sigma_ = *given().position_sigma;
    report_.position = Words("position fix at t = %.2f s", fix.t);
    if (t_ - from_ > 1.0) {
      report_.position += Words(
          "; the %.1f s before it are left out, as nothing gives a position",
          t_ - from_);
    }
  }

  Start Finish() {
    Start start;
    State x = MakeState(t_, GeodeticFromEcef(position_e_), v_n_, euler_);
    x.b_g = b_g_;
    x.b_a = given().accel_bias;
    NavigationPrior prior;
    prior.position_sigma = p_sigma_;
    prior.velocity_sigma = v_sigma_;
    prior.attitude_sigma = euler_sigma_;
    prior.gyro_bias_sigma = b_g_sigma_;
    prior.accel_bias_sigma = given().accel_bias_sigma.value_or(
        Eigen::Vector3d::Constant(kDefaultAccelBiasSigma));
    prior.gyro_bias = dataset_.imu.noise.GyroBiasEvolution();
    prior.accel_bias = dataset_.imu.noise.AccelBiasEvolution();
    start.layout = BuildLayout(dataset_, prior);
    x.parameters = InitialParameters(start.layout);
    start.prior.x = x;
    start.prior.P = start.layout.InitialCovariance();
    // Roll and pitch turn about axes that heading (and pitch) have turned.
    Eigen::Matrix3d M;
    const Eigen::Quaterniond heading =
        QuaternionFromEuler(0.0, 0.0, euler_.z());
    M.col(0) = QuaternionFromEuler(0.0, euler_.y(), euler_.z()) *
               Eigen::Vector3d::UnitX();
    M.col(1) = heading * Eigen::Vector3d::UnitY();
    M.col(2) = Eigen::Vector3d::UnitZ();
    const int offset = start.layout.Find(BlockKind::kAttitude)->offset;
    start.prior.P.block(offset, offset, 3, 3) =
        M * euler_sigma_.cwiseAbs2().asDiagonal() * M.transpose();
    if (levelled_) CorrelateTiltWithAccelBias(&start);
    report_.t = t_;
    report_.state = x;
    report_.position_sigma = p_sigma_;
    report_.velocity_sigma = v_sigma_;
    report_.attitude_sigma = euler_sigma_;
    start.report = report_;
    return start;
  }

  /// Levelling turns an accelerometer bias into tilt: psi x g = -C_nb db_a, so
  /// psi_N = +db_E/g and psi_E = -db_N/g. Were the two left independent, the
  /// first zero velocity would seem to halve both.
  void CorrelateTiltWithAccelBias(Start* start) const {
    const double rest = rest_->end - rest_->begin;
    const double sway =
        std::hypot(0.05 * kDegree, dataset_.imu.noise.accel_noise_density /
                                       std::sqrt(rest) / kStandardGravity);
    const Eigen::Matrix3d C_nb =
        QuaternionFromEuler(euler_.x(), euler_.y(), euler_.z())
            .toRotationMatrix();
    Eigen::Matrix<double, 2, 3> M;
    M.row(0) = C_nb.row(1) / kStandardGravity;
    M.row(1) = -C_nb.row(0) / kStandardGravity;
    ErrorMatrix& P = start->prior.P;
    const int a = start->layout.Find(BlockKind::kAttitude)->offset;
    const int b = start->layout.Find(BlockKind::kAccelBias)->offset;
    const Eigen::Matrix3d P_b = P.block<3, 3>(b, b);
    P.block<3, 3>(a, a).setZero();
    P.block<2, 2>(a, a) = M * P_b * M.transpose();
    P.block<2, 2>(a, a).diagonal().array() += sway * sway;
    P(a + 2, a + 2) = euler_sigma_.z() * euler_sigma_.z();
    P.block<2, 3>(a, b) = M * P_b;
    P.block<3, 2>(b, a) = P.block<2, 3>(a, b).transpose();
  }

  ParameterVector InitialParameters(const ErrorLayout& layout) const {
    ParameterVector parameters =
        ParameterVector::Zero(layout.parameter_count());
    for (const Block& block : layout.blocks()) {
      if (block.key.sensor == BlockKey::kNoSensor) continue;
      const Sensor& sensor =
          dataset_.streams[static_cast<std::size_t>(block.key.sensor)].sensor;
      const int offset = block.parameter_offset;
      if (block.key.kind == BlockKind::kLeverArm) {
        parameters.segment<3>(offset) = sensor.lever_arm_b;
      } else if (block.key.kind == BlockKind::kTimeOffset) {
        parameters(offset) = sensor.time_offset;
      } else if (block.key.kind == BlockKind::kScale) {
        parameters(offset) = sensor.scale;
      }
    }
    return parameters;
  }

  const Dataset& dataset_;
  double from_;
  double to_;
  std::vector<TimedFix> fixes_;
  std::vector<TimedVelocity> velocities_;
  std::vector<TimeInterval> rests_;
  std::optional<TimeInterval> rest_;
  double t_ = 0.0;
  Eigen::Vector3d position_e_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_n_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d euler_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d b_g_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_sigma_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_sigma_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d euler_sigma_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d b_g_sigma_ = Eigen::Vector3d::Zero();
  double gyro_sigma_ = 0.0;
  bool levelled_ = false;
  StartReport report_;
};

void AddCalibration(BlockKind kind, int sensor, const std::string& name,
                    const char* unit, const Eigen::Vector3d& sigma,
                    ErrorLayout* layout) {
  Block block;
  block.key = {kind, sensor};
  block.name = name;
  block.unit = unit;
  block.evolution = Evolution::Constant();
  block.sigma0 = sigma;
  layout->Add(block);
}

}  // namespace

ErrorLayout BuildLayout(const Dataset& dataset, const NavigationPrior& prior) {
  ErrorLayout layout = NavigationLayout(prior);
  const int none = BlockKey::kNoSensor;
  if (dataset.gyro_scale_sigma) {
    AddCalibration(BlockKind::kGyroScale, none, "gyro_scale", "1",
                   *dataset.gyro_scale_sigma, &layout);
  }
  if (dataset.accel_scale_sigma) {
    AddCalibration(BlockKind::kAccelScale, none, "accel_scale", "1",
                   *dataset.accel_scale_sigma, &layout);
  }
  for (std::size_t i = 0; i < dataset.streams.size(); ++i) {
    const Sensor& sensor = dataset.streams[i].sensor;
    const int index = static_cast<int>(i);
    if (sensor.scale_sigma) {
      AddCalibration(BlockKind::kScale, index, sensor.name + "_scale", "1",
                     Eigen::Vector3d::Constant(*sensor.scale_sigma), &layout);
    }
    if (sensor.mounting_sigma) {
      AddCalibration(BlockKind::kMounting, index, sensor.name + "_mounting",
                     "rad", *sensor.mounting_sigma, &layout);
    }
    if (sensor.lever_arm_sigma) {
      AddCalibration(BlockKind::kLeverArm, index, sensor.name + "_lever_arm",
                     "m", *sensor.lever_arm_sigma, &layout);
    }
    if (sensor.time_offset_sigma) {
      AddCalibration(
          BlockKind::kTimeOffset, index, sensor.name + "_time_offset", "s",
          Eigen::Vector3d::Constant(*sensor.time_offset_sigma), &layout);
    }
  }
  return layout;
}

Start FindStart(const Dataset& dataset, double from, double to) {
  return StartFinder(dataset, from, to).Find();
}

}  // namespace hindsight
