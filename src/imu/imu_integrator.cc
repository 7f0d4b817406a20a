#include <algorithm>
#include <string>

#include "base/error.h"
#include "imu/preintegration.h"
#include "imu/rotation_summary.h"
#include "imu/sample_search.h"

namespace hindsight {

std::size_t ImuIntegrator::FindInterval(double t) {
  const auto& samples = stream_->samples;
  const std::size_t last = samples.size() - 1;
  std::size_t k = std::min(hint_, last);
  if (samples[k - 1].t > t || k + 64 < last) {
    const bool near =
        samples[k - 1].t <= t && samples[std::min(k + 64, last)].t > t;
    if (!near) {
      k = std::clamp<std::size_t>(FirstSampleAfter(*stream_, t), 1, last);
    }
  }
  while (k < last && samples[k].t <= t) ++k;
  hint_ = k;
  return k;
}

LinearRates ImuIntegrator::RatesOfInterval(std::size_t k) const {
  const auto& samples = stream_->samples;
  const double dt = samples[k].t - samples[k - 1].t;
  if (stream_->kind == ImuStream::Kind::kRates) {
    return {dt, samples[k - 1].gyro, samples[k].gyro, samples[k - 1].accel,
            samples[k].accel};
  }
  if (IsDropOut(k)) return RatesAcrossDropOut(k);
  const double dt_previous = k < 2 ? dt
                             : IsDropOut(k - 1)
                                 ? stream_->nominal_dt
                                 : samples[k - 1].t - samples[k - 2].t;
  return RatesFromIncrements(dt_previous, samples[k - 1].gyro,
                             samples[k - 1].accel, dt, samples[k].gyro,
                             samples[k].accel);
}

bool ImuIntegrator::IsDropOut(std::size_t k) const {
  return stream_->nominal_dt > 0.0 &&
         stream_->samples[k].t - stream_->samples[k - 1].t >
             ImuStream::kGapFactor * stream_->nominal_dt;
}

LinearRates ImuIntegrator::RatesAcrossDropOut(std::size_t k) const {
  // The increments of the missing intervals are lost; the sample at the end
  // holds those of one usual interval.
  const auto& samples = stream_->samples;
  const double scale = 1.0 / stream_->nominal_dt;
  return {samples[k].t - samples[k - 1].t, scale * samples[k - 1].gyro,
          scale * samples[k].gyro, scale * samples[k - 1].accel,
          scale * samples[k].accel};
}

IntervalNoise BridgeNoise(const LinearRates& rates) {
  constexpr double kRate = 0.1;
  constexpr double kForce = 1.0;
  const double w = std::max(kRate, (rates.w1 - rates.w0).norm());
  const double f = std::max(kForce, (rates.f1 - rates.f0).norm());
  return {w * w * rates.dt, f * f * rates.dt};
}

template <typename Use>
void ImuIntegrator::Walk(double t_i, double t_j, const Use& use) {
  const auto& samples = stream_->samples;
  constexpr double kTolerance = 1e-6;
  if (t_i < stream_->t_begin() - kTolerance ||
      t_j > stream_->t_end() + kTolerance || t_j < t_i) {
    throw EstimationError("IMU data do not cover the interval from " +
                          std::to_string(t_i) + " s to " + std::to_string(t_j) +
                          " s");
  }
  std::size_t k = FindInterval(t_i);
  double t = t_i;
  while (t < t_j) {
    const double t_begin = samples[k - 1].t;
    const double t_end = samples[k].t;
    const double to = k + 1 == samples.size() ? t_j : std::min(t_end, t_j);
    const LinearRates whole = RatesOfInterval(k);
    LinearRates rates = whole;
    if (t > t_begin || to < t_end) {
      const double a = (t - t_begin) / whole.dt;
      const double b = (to - t_begin) / whole.dt;
      const Eigen::Vector3d dw = whole.w1 - whole.w0;
      const Eigen::Vector3d df = whole.f1 - whole.f0;
      rates = {to - t, whole.w0 + a * dw, whole.w0 + b * dw, whole.f0 + a * df,
               whole.f0 + b * df};
    }
    if (rates.dt > 0.0) use(rates, IsDropOut(k) ? &whole : nullptr);
    t = to;
    if (k + 1 < samples.size()) ++k;
  }
  hint_ = k;
}

ImuSummary ImuIntegrator::Summarize(double t_i, double t_j,
                                    const ImuCalibration& calibration) {
  integrator_.Start(t_i, calibration);
  Walk(t_i, t_j, [this](const LinearRates& rates, const LinearRates* bridged) {
    integrator_.Add(rates, bridged ? BridgeNoise(*bridged) : IntervalNoise());
  });
  ImuSummary summary = integrator_.Finish();
  summary.t_j = t_j;
  return summary;
}

void ImuIntegrator::AppendMean(double t_j, ImuSummary* mean) {
  ImuSummary& s = *mean;
  Walk(s.t_j, t_j, [&s](const LinearRates& rates, const LinearRates*) {
    const SampleIntegral sample = Integrate(Calibrated(rates, s.calibration));
    s.dp += rates.dt * s.dv + s.dR * sample.dp;
    s.dv += s.dR * sample.dv;
    s.dR = s.dR * Exp(sample.phi);
  });
  s.dR.normalize();
  s.t_j = t_j;
  s.gyro_bias_phi = stream_->noise.GyroBiasEvolution().Phi(s.dt());
  s.accel_bias_phi = stream_->noise.AccelBiasEvolution().Phi(s.dt());
}

Eigen::Quaterniond ImuIntegrator::Turn(double t_i, double t_j,
                                       const Eigen::Vector3d& b_g) {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Walk(t_i, t_j, [&](const LinearRates& rates, const LinearRates*) {
    q = q *
        Exp(SummarizeRotation(stream_->noise, rates.dt, rates.w0, rates.w1, b_g)
                .phi);
  });
  return q.normalized();
}

Kinematics ImuIntegrator::ReadingAt(double t) {
  const std::size_t k = FindInterval(t);
  const LinearRates rates = RatesOfInterval(k);
  const double a =
      std::clamp((t - stream_->samples[k - 1].t) / rates.dt, 0.0, 1.0);
  return {rates.w0 + a * (rates.w1 - rates.w0),
          rates.f0 + a * (rates.f1 - rates.f0)};
}

}  // namespace hindsight
