#include "alignment/start.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "alignment/alignment.h"
#include "alignment/backward_extension.h"
#include "alignment/clock_slack.h"
#include "alignment/given.h"
#include "alignment/levelling.h"
#include "alignment/start_covariance.h"
#include "base/error.h"
#include "dataset/excluded_motion.h"
#include "dataset/rest.h"
#include "state/euler_error.h"

namespace hindsight {
namespace {

/// Works through the steps of FindStart; each fills its part of the report.
class StartFinder {
 public:
  StartFinder(const Dataset& dataset, double from, double to,
              const RestMemo& rests)
      : dataset_(dataset),
        known_rests_(rests),
        from_(std::max(from, dataset.imu.t_begin())),
        to_(std::min(to, dataset.imu.t_end())),
        clock_sigma_(ClockSigma(dataset)) {}

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
    rests_ = known_rests_.Of(dataset_).at_rest;
    ChooseTime();
    ChooseGyroBias();
    ChooseAttitude();
    ChooseVelocity();
    ChoosePosition();
    return Finish();
  }

 private:
  const InitialState& given() const { return dataset_.initial; }

  void ChooseTime() {
    if (!given().position && fixes_.empty()) {
      throw NoInitialPosition(
          "no initial position: expected initial.position, initial.from: truth "
          "or a stream under aiding of type position, with fixes inside the "
          "interval of --from and --to that are not withheld");
    }
    if (given().t || given().position || given().v_n || given().euler ||
        given().heading) {
      t_ = GivenStartTime(dataset_, from_, to_);
    } else {
      t_ = fixes_.front().t;
      for (const TimeInterval& rest : rests_) {
        if (rest.begin <= from_ + 1.0 && rest.end >= t_) t_ = from_;
      }
    }
    rest_ = RestFrom(t_, rests_);
  }

  /// The rest makes the start value and the sigma with which the gyros carry
  /// heading; the a priori sigma is left as it was where zero-rate measurements
  /// will use the same data.
  void ChooseGyroBias() {
    b_g_ = given().gyro_bias;
    b_g_sigma_ = GyroBiasSigma(given());
    gyro_sigma_ = b_g_sigma_.maxCoeff();
    if (!rest_) return;
    const GyroBiasPrior resting = GyroBiasAtRest(dataset_, *rest_);
    b_g_ = resting.b_g;
    gyro_sigma_ = resting.sigma.maxCoeff();
    if (!dataset_.stationary.enabled) b_g_sigma_ = resting.sigma;
  }

  void ChooseAttitude() {
    AlignmentInput input{.dataset = dataset_,
                         .t = t_,
                         .to = to_,
                         .p_e = given().position
                                    ? EcefFromGeodetic(*given().position)
                                    : fixes_.front().p_e,
                         .fixes = fixes_,
                         .velocities = velocities_,
                         .rest = rest_,
                         .b_g = b_g_,
                         .b_a = given().accel_bias,
                         .gyro_sigma = gyro_sigma_};
    AlignmentChoice choice = Align(input);
    attitude_ = std::move(choice.attitude);
    euler_ = EulerFromQuaternion(attitude_.q_nb);
    if (given().attitude_sigma) {
      attitude_.P = AttitudeCovariance(euler_, *given().attitude_sigma);
      attitude_.P_bias.setZero();
      attitude_.reuse = 1.0;
    }
    if (choice.kind == AlignmentKind::kVelocity) {
      const Eigen::Vector3d turn_n =
          TurnWithin(clock_sigma_, dataset_.imu, t_, attitude_.q_nb, b_g_);
      attitude_.P += turn_n * turn_n.transpose();
    }
    if (attitude_.b_g) {
      b_g_ = *attitude_.b_g;
      b_g_sigma_ = b_g_sigma_.cwiseMin(attitude_.reuse * attitude_.b_g_sigma);
    }
    report_.alignment = AlignmentName(choice.kind);
    report_.why = choice.why;
    report_.attitude = attitude_.attitude;
    report_.heading = attitude_.heading;
    report_.gyro_bias_walk = attitude_.gyro_bias_walk;
  }

  void ChooseVelocity() {
    if (given().v_n) {
      v_n_ = *given().v_n;
      v_sigma_ =
          given().velocity_sigma.value_or(Eigen::Vector3d::Constant(0.1));
      return;
    }
    if (rest_) {
      constexpr double kUsual = 0.05;
      const double possible = ExcludedMotion(dataset_).PossibleSpeed(*rest_);
      v_sigma_.setConstant(std::isfinite(possible) ? std::max(kUsual, possible)
                                                   : kUsual);
    } else {
      v_sigma_.setConstant(kNoVelocity);
      if (!velocities_.empty()) {
        const TimedVelocity& v = Nearest(velocities_);
        TakeVelocity(v.v_n, v.sigma, v.t);
      }
      const auto bottom = BottomVelocities(dataset_, from_, to_);
      if (!bottom.empty()) {
        const BottomVelocity& v = Nearest(bottom);
        const double turned =
            std::min(std::sqrt(attitude_.P.trace()), 1.0) * v.v_b.norm();
        TakeVelocity(attitude_.q_nb * v.v_b, v.sigma + turned, v.t);
      }
      if (v_sigma_.x() == kNoVelocity) {
        v_sigma_.setConstant(given().speed_spread);
      }
    }
    if (given().velocity_sigma) v_sigma_ = *given().velocity_sigma;
  }

  template <typename Velocity>
  const Velocity& Nearest(const std::vector<Velocity>& velocities) const {
    return *std::min_element(velocities.begin(), velocities.end(),
                             [this](const Velocity& a, const Velocity& b) {
                               return std::abs(a.t - t_) < std::abs(b.t - t_);
                             });
  }

  static constexpr double kNoVelocity = std::numeric_limits<double>::infinity();

  /// Unless a better one is there.
  void TakeVelocity(const Eigen::Vector3d& v_n, double sigma, double t) {
    // It is used again as a measurement, or made of fixes that are.
    const double loose =
        3.0 * sigma + 3.0 * (std::abs(t - t_) + clock_sigma_) + 0.2;
    if (loose >= v_sigma_.x()) return;
    v_n_ = v_n;
    v_sigma_.setConstant(loose);
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
    const Eigen::Vector3d lever_n = attitude_.q_nb * lever_arm_b;
    position_e_ = fix.p_e - C_en * (lever_n + (fix.t - t_) * v_n_);
    const double lever = lever_arm_b.norm();
    const double swing = lever * std::min(std::sqrt(attitude_.P.trace()), 1.0) +
                         std::abs(fix.t - t_) * v_sigma_.x() +
                         clock_sigma_ * (v_n_.norm() + v_sigma_.x());
    // The fix itself is used again as a measurement: its own sigma would count
    // it twice.
    p_sigma_ = 3.0 * fix.R_n.diagonal().cwiseSqrt();
    p_sigma_.array() += swing + 1.0;
    if (given().position_sigma) {
      p_sigma_ = *given().position_sigma;
    } else {
      position_sensor_ = fix.sensor;
    }
    report_.position = fmt::format("position fix at t = {:.2f} s", fix.t);
  }

  NavigationPrior BuildPrior() const {
    NavigationPrior prior;
    prior.position_sigma = p_sigma_;
    prior.velocity_sigma = v_sigma_;
    prior.attitude_sigma = attitude_.P.diagonal().cwiseSqrt();
    prior.gyro_bias_sigma = b_g_sigma_;
    prior.accel_bias_sigma = AccelBiasSigma(given());
    prior.gyro_bias = dataset_.imu.noise.GyroBiasEvolution();
    prior.accel_bias = dataset_.imu.noise.AccelBiasEvolution();
    return prior;
  }

  Start Finish() {
    Start start;
    State x = MakeState(t_, GeodeticFromEcef(position_e_), v_n_, euler_);
    x.b_g = b_g_;
    x.b_a = given().accel_bias;
    start.layout = BuildLayout(dataset_, BuildPrior());
    x.parameters =
        InitialParameters(dataset_, start.layout, attitude_.travel_b);
    Prior known{x, StartCovariance(dataset_, start.layout, attitude_, 1.0)};
    start.prior = {x, PriorCovariance(dataset_, start.layout, attitude_)};
    if (t_ > from_ && !given().t) {
      ExtendBackward(start.layout, dataset_.imu, from_, &start.prior);
      ExtendBackward(start.layout, dataset_.imu, start.prior.x.t, &known);
    }
    Report(start.layout, known);
    start.report = report_;
    start.position_sensor = position_sensor_;
    return start;
  }

  void Report(const ErrorLayout& layout, const Prior& known) {
    const State& x = known.x;
    report_.t = x.t;
    report_.state = x;
    const Eigen::VectorXd sigma = known.P.diagonal().cwiseSqrt();
    report_.position_sigma = sigma.head<3>();
    report_.velocity_sigma = sigma.segment<3>(3);
    report_.attitude_sigma = EulerSigma(layout, x, known.P);
    if (t_ - x.t > 1.0) {
      report_.position +=
          fmt::format("; {:.1f} s back to the start by the IMU", t_ - x.t);
    }
    if (!given().t && x.t - from_ > 1.0) {
      report_.position += fmt::format(
          "; the {:.1f} s before it are left out, as nothing gives a position",
          x.t - from_);
    }
  }

  const Dataset& dataset_;
  const RestMemo& known_rests_;
  double from_;
  double to_;
  double clock_sigma_;
  std::vector<TimedFix> fixes_;
  std::vector<TimedVelocity> velocities_;
  std::vector<TimeInterval> rests_;
  std::optional<TimeInterval> rest_;
  double t_ = 0.0;
  AlignedAttitude attitude_;
  Eigen::Vector3d position_e_ = Eigen::Vector3d::Zero();
  int position_sensor_ = -1;
  Eigen::Vector3d v_n_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d euler_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d b_g_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_sigma_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_sigma_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d b_g_sigma_ = Eigen::Vector3d::Zero();
  double gyro_sigma_ = 0.0;
  StartReport report_;
};

}  // namespace

Start WithoutTrustIn(int sensor, Start start) {
  constexpr double kLargestError = 1e3;
  if (sensor < 0 || sensor != start.position_sensor) return start;
  const int p = start.layout.Find(BlockKind::kPosition)->offset;
  start.prior.P.diagonal().segment<3>(p).array() +=
      kLargestError * kLargestError;
  return start;
}

Start FindStart(const Dataset& dataset, double from, double to) {
  return FindStart(dataset, from, to, RestMemo(dataset));
}

Start FindStart(const Dataset& dataset, double from, double to,
                const RestMemo& rests) {
  return StartFinder(dataset, from, to, rests).Find();
}

}  // namespace hindsight
