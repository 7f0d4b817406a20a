#include "attitude/attitude_run.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "attitude/rest_detector.h"
#include "base/error.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

using Source = AttitudeInnovation::Source;

/// Feeds the samples to a filter and records its updates.
class AttitudeRunner {
 public:
  AttitudeRunner(const ImuStream& imu, const AttitudeReadings& readings,
                 const AttitudeFilterOptions& options,
                 const AttitudeState& start, bool to_be_smoothed)
      : imu_(imu),
        magnetic_(readings.magnetic),
        headings_(readings.headings),
        velocities_(readings.velocities),
        forces_(readings.forces),
        options_(options),
        sample_interval_(MedianInterval(imu)),
        layout_(AttitudeLayout(imu.noise, start)),
        q_en_(NedAxes(options.place.p_e)),
        filter_(options, imu.noise, start, sample_interval_) {
    constexpr std::size_t kUpdates = 8;  // scalar ones of a node
    const double spacing = std::max(options.update_interval, sample_interval_);
    const auto nodes =
        static_cast<std::size_t>((imu.t_end() - imu.t_begin()) / spacing) + 2;
    run_.samples.reserve(imu.samples.size());
    run_.nodes.reserve(nodes);
    if (!velocities_.empty()) integrator_.emplace(imu, true);
    if (!to_be_smoothed) return;
    run_.updates.reserve(kUpdates * nodes);
    filter_.RecordUpdates(&run_.updates);
  }

  AttitudeRun Run(const std::function<void(std::size_t)>& poll) {
    constexpr std::size_t kPollEvery = 8192;
    const std::size_t count = imu_.samples.size();
    double updated = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < count; ++k) {
      const double t = imu_.samples[k].t;
      Feed(k);
      const bool heading =
          next_heading_ < headings_.size() && headings_[next_heading_].t <= t;
      const bool velocity = TakeVelocities(imu_.samples[k]);
      if (k + 1 == count || heading || velocity ||
          t - updated > options_.update_interval - 0.5 * sample_interval_) {
        Update(k);
        updated = t;
      }
      run_.samples.push_back(
          {filter_.q_nb(), filter_.gyro_bias(), run_.nodes.size() - 1});
      if (k % kPollEvery == 0) {
        RequireFinite(run_.nodes.back().x);
        if (poll) poll(k + 1);
      }
    }
    return std::move(run_);
  }

 private:
  void Feed(std::size_t k) {
    const ImuSample& sample = imu_.samples[k];
    const ImuSample& before = imu_.samples[k > 0 ? k - 1 : 0];
    const double dt = sample.t - before.t;
    if (k > 0) {
      if (options_.rest_sigma > 0.0) filter_.SetResting(RestsAfter(k - 1, dt));
      filter_.Turn(dt, before.gyro, sample.gyro);
    }
    filter_.AddForce(forces_.empty() ? ForceAsRead(sample.accel) : forces_[k]);
    for (; next_ < magnetic_.size() && magnetic_[next_].t <= sample.t;
         ++next_) {
      MagneticSample reading = magnetic_[next_];
      const Eigen::Vector3d turn =
          (sample.t - reading.t) * (sample.gyro - filter_.gyro_bias());
      reading.field_b = Exp(-turn) * reading.field_b;
      filter_.AddField(reading);
    }
  }

  /// Whether the body rests from sample k, the last one fed, to the next.
  bool RestsAfter(std::size_t k, double dt) {
    if (options_.rests) return (*options_.rests)[k];
    const ImuSample& sample = imu_.samples[k];
    detector_.Add(dt, sample.gyro, sample.accel);
    return detector_.rests() && filter_.ExplainsAsBias(detector_.rate());
  }

  /// Whether there is a velocity to use at this sample, far enough from the one
  /// before.
  bool TakeVelocities(const ImuSample& sample) {
    velocity_ = nullptr;
    for (; next_velocity_ < velocities_.size() &&
           velocities_[next_velocity_].t <= sample.t;
         ++next_velocity_) {
      const VelocitySample& reading = velocities_[next_velocity_];
      const double dt = last_velocity_ == nullptr
                            ? std::numeric_limits<double>::infinity()
                            : reading.t - last_velocity_->t;
      if (dt > kLongestVelocityInterval) {
        last_velocity_ = &reading;
      } else if (dt > kLeastVelocityInterval - 0.5 * sample_interval_) {
        velocity_ = &reading;
      }
    }
    return velocity_ != nullptr;
  }

  void UseVelocity(const ImuSample& sample) {
    if (velocity_ == nullptr) return;
    const ImuCalibration calibration = {.b_g = filter_.gyro_bias(),
                                        .b_a = filter_.accel_bias(),
                                        .s_g = filter_.gyro_scale()};
    Note(sample.t, Source::kVelocity,
         filter_.UseVelocityChange(
             ChangeBetween(*last_velocity_, *velocity_, options_.place,
                           calibration, &*integrator_),
             AttitudeAt(velocity_->t, sample).toRotationMatrix()));
    last_velocity_ = velocity_;
    velocity_ = nullptr;
  }

  /// Shortly before a sample, the last one fed.
  Eigen::Quaterniond AttitudeAt(double t, const ImuSample& sample) const {
    const Eigen::Vector3d turn =
        (sample.t - t) * (sample.gyro - filter_.gyro_bias());
    return filter_.q_nb() * Exp(-turn);
  }

  void Update(std::size_t k) {
    filter_.Predict();
    if (velocities_.empty()) {
      Note(imu_.samples[k].t, Source::kForce, filter_.UseAccelerometer());
    } else {
      filter_.LeaveAccelerometer();
    }
    UseVelocity(imu_.samples[k]);
    Note(imu_.samples[k].t, Source::kField, filter_.UseMagnetometer());
    UseHeadings(imu_.samples[k]);
    if (options_.rest_sigma > 0.0) filter_.UseRest();
    AttitudeNode& node = run_.nodes.emplace_back();
    node.transition = filter_.transition();
    node.dx = filter_.dx();
    filter_.Reset();
    node.x = filter_.state();
    node.verdict = filter_.verdict();
    node.updates_end = run_.updates.size();
  }

  void UseHeadings(const ImuSample& sample) {
    for (; next_heading_ < headings_.size() &&
           headings_[next_heading_].t <= sample.t;
         ++next_heading_) {
      const HeadingSample& heading = headings_[next_heading_];
      State x;
      x.t = heading.t;
      x.p_e = options_.place.p_e;
      x.q_eb = q_en_ * AttitudeAt(heading.t, sample);
      x.parameters = Eigen::Vector3d::Zero();
      const Kinematics kinematics = {sample.gyro, sample.accel};
      LinearizedMeasurement z;
      heading.reading.Evaluate({layout_, x, kinematics, *heading.sensor}, &z);
      RowVector innovation(z.residual.size());
      for (int row = 0; row < z.residual.size(); ++row) {
        innovation(row) = filter_.UseRow(z.H.row(row).head<3>(),
                                         z.residual(row), z.R(row, row));
      }
      Note(sample.t, Source::kHeading, innovation);
    }
  }

  void Note(double t, Source source, const RowVector& rows) {
    if (rows.size() > 0) {
      run_.innovations.push_back({t, source, rows});
    }
  }

  static void RequireFinite(const AttitudeState& x) {
    if (!x.P.allFinite() || !x.q_nb.coeffs().allFinite()) {
      throw EstimationError(
          "attitude filter diverged at t = " + std::to_string(x.t) + " s");
    }
  }

  /// Between velocities that are used [s]: closer ones say, less their noise,
  /// hardly more.
  static constexpr double kLeastVelocityInterval = 1.0;
  static constexpr double kLongestVelocityInterval = 60.0;

  const ImuStream& imu_;
  std::span<const MagneticSample> magnetic_;
  std::span<const HeadingSample> headings_;
  std::span<const VelocitySample> velocities_;
  std::span<const BiasedForce> forces_;
  const AttitudeFilterOptions& options_;
  double sample_interval_;
  ErrorLayout layout_;
  Eigen::Quaterniond q_en_;
  AttitudeFilter filter_;
  AttitudeRun run_;
  RestDetector detector_;
  std::size_t next_ = 0;
  std::size_t next_heading_ = 0;
  std::size_t next_velocity_ = 0;
  const VelocitySample* velocity_ = nullptr;  ///< to be used at this sample
  const VelocitySample* last_velocity_ = nullptr;  ///< used last
  std::optional<ImuIntegrator> integrator_;        ///< for velocities
};

}  // namespace

AttitudeRun RunAttitudeFilter(const ImuStream& imu,
                              const AttitudeReadings& readings,
                              const AttitudeFilterOptions& options,
                              const AttitudeState& start, bool to_be_smoothed,
                              const std::function<void(std::size_t)>& poll) {
  return AttitudeRunner(imu, readings, options, start, to_be_smoothed)
      .Run(poll);
}

}  // namespace hindsight
