#include "attitude/attitude_run.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "attitude/rest_detector.h"
#include "base/error.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

/// Feeds the samples to a filter and records its updates.
class AttitudeRunner {
 public:
  AttitudeRunner(const ImuStream& imu, std::span<const MagneticSample> magnetic,
                 const AttitudeFilterOptions& options,
                 const AttitudeState& start, LinearTape* tape)
      : imu_(imu),
        magnetic_(magnetic),
        options_(options),
        sample_interval_(MedianInterval(imu)),
        q_en_(NedAxes(options.place.p_e)),
        filter_(options, imu.noise, start, sample_interval_),
        tape_(tape) {
    transition_.c = ErrorVector::Zero(AttitudeState::kDim);
    if (tape_ == nullptr) return;
    const double spacing = std::max(options.update_interval, sample_interval_);
    tape_->Reserve(
        static_cast<std::size_t>((imu.t_end() - imu.t_begin()) / spacing) + 2);
    tape_->NeglectTransport();
  }

  AttitudeRun Run(const std::function<void(std::size_t)>& poll) {
    constexpr std::size_t kPollEvery = 8192;
    AttitudeRun run;
    const std::size_t count = imu_.samples.size();
    run.epochs.resize(count);
    double updated = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < count; ++k) {
      const double t = imu_.samples[k].t;
      Feed(k);
      if (k + 1 == count ||
          t - updated > options_.update_interval - 0.5 * sample_interval_) {
        Update(t);
        updated = t;
      }
      run.epochs[k] = {filter_.state(), filter_.verdict()};
      if (k % kPollEvery == 0) {
        RequireFinite(run.epochs[k].x);
        if (poll) poll(k + 1);
      }
    }
    return run;
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
    filter_.AddForce(sample.accel);
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

  void Update(double t) {
    filter_.Predict();
    TapeEpoch epoch;
    AttitudeState::Matrix P_minus;
    if (tape_ != nullptr) {
      epoch.t = t;
      epoch.x_minus = StateOf(filter_.state());
      P_minus = filter_.P();
      filter_.FillTransition(&transition_);
    }
    filter_.UseAccelerometer();
    filter_.UseMagnetometer();
    if (options_.rest_sigma > 0.0) filter_.UseRest();
    if (tape_ != nullptr) {
      epoch.dx_minus = ErrorVector::Zero(AttitudeState::kDim);
      epoch.c = epoch.dx_minus;
      epoch.dx_plus = filter_.dx();
    }
    filter_.Reset();
    if (tape_ != nullptr) {
      epoch.reset = true;
      epoch.x_plus = StateOf(filter_.state());
      tape_->Append(std::move(epoch), transition_, P_minus, filter_.P());
    }
  }

  State StateOf(const AttitudeState& a) const {
    State x;
    x.t = a.t;
    x.p_e = options_.place.p_e;
    x.q_eb = (q_en_ * a.q_nb).normalized();
    x.b_g = a.b_g;
    x.parameters = a.s_g;
    return x;
  }

  static void RequireFinite(const AttitudeState& x) {
    if (!x.P.allFinite() || !x.q_nb.coeffs().allFinite()) {
      throw EstimationError(
          "attitude filter diverged at t = " + std::to_string(x.t) + " s");
    }
  }

  const ImuStream& imu_;
  std::span<const MagneticSample> magnetic_;
  const AttitudeFilterOptions& options_;
  double sample_interval_;
  Eigen::Quaterniond q_en_;
  AttitudeFilter filter_;
  LinearTape* tape_;
  Transition transition_;
  RestDetector detector_;
  std::size_t next_ = 0;
};

}  // namespace

AttitudeRun RunAttitudeFilter(const ImuStream& imu,
                              std::span<const MagneticSample> magnetic,
                              const AttitudeFilterOptions& options,
                              const AttitudeState& start, LinearTape* tape,
                              const std::function<void(std::size_t)>& poll) {
  return AttitudeRunner(imu, magnetic, options, start, tape).Run(poll);
}

}  // namespace hindsight
