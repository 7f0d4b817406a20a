#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "imu/pair.h"
#include "imu/preintegration.h"
#include "imu/rotation_summary.h"
#include "imu/sample_search.h"

namespace hindsight {

std::size_t ImuIntegrator::FindInterval(double t) {
  const auto& samples = stream_->samples;
  // So many are walked along sooner than one is sought.
  constexpr std::size_t kNear = 8;
  const std::size_t last = samples.size() - 1;
  std::size_t k = std::min(hint_, last);
  if (samples[k - 1].t > t || k + kNear < last) {
    const bool near =
        samples[k - 1].t <= t && samples[std::min(k + kNear, last)].t > t;
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
  return RatesBetween(k < 2 ? nullptr : &samples[k - 2], samples[k - 1],
                      samples[k]);
}

LinearRates ImuIntegrator::RatesBetween(const ImuSample* previous,
                                        const ImuSample& a,
                                        const ImuSample& b) const {
  const double dt = b.t - a.t;
  if (stream_->kind == ImuStream::Kind::kRates) {
    return {dt, a.gyro, b.gyro, a.accel, b.accel};
  }
  if (stream_->IsDropOut(dt)) {
    // The increments of the missing intervals are lost; the sample at the end
    // holds those of one usual interval.
    const double scale = 1.0 / stream_->nominal_dt;
    return {dt, scale * a.gyro, scale * b.gyro, scale * a.accel,
            scale * b.accel};
  }
  double dt_previous = previous == nullptr ? dt : a.t - previous->t;
  if (stream_->IsDropOut(dt_previous)) dt_previous = stream_->nominal_dt;
  return RatesFromIncrements(dt_previous, a.gyro, a.accel, dt, b.gyro, b.accel);
}

Kinematics ImuIntegrator::BendOfInterval(std::size_t k) const {
  constexpr double kShortest = 0.5;
  Kinematics bend = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  if (stream_->kind != ImuStream::Kind::kRates || IsDropOut(k)) return bend;
  const auto& samples = stream_->samples;
  const double dt = samples[k].t - samples[k - 1].t;
  int count = 0;
  // About the sample in the middle of three.
  const auto add = [&](std::size_t middle) {
    const ImuSample& a = samples[middle - 1];
    const ImuSample& b = samples[middle];
    const ImuSample& c = samples[middle + 1];
    const double before = b.t - a.t;
    const double after = c.t - b.t;
    if (std::min(before, after) < kShortest * dt) return;
    const double scale = 2.0 / (before + after);
    bend.w_ib_b +=
        scale * ((c.gyro - b.gyro) / after - (b.gyro - a.gyro) / before);
    bend.f_b +=
        scale * ((c.accel - b.accel) / after - (b.accel - a.accel) / before);
    ++count;
  };
  if (k >= 2 && !IsDropOut(k - 1)) add(k - 1);
  if (k + 1 < samples.size() && !IsDropOut(k + 1)) add(k);
  if (count == 0) return bend;
  const double factor = -dt * dt / 12.0 / count;
  bend.w_ib_b *= factor;
  bend.f_b *= factor;
  return bend;
}

namespace {

/// The part of an interval from fraction a to b of it, along the parabola that
/// adds `bend` in the mean: 6 s (1 - s) times it.
LinearRates PartOf(const LinearRates& whole, const Kinematics& bend, double a,
                   double b) {
  const Eigen::Vector3d dw = whole.w1 - whole.w0;
  const Eigen::Vector3d df = whole.f1 - whole.f0;
  const double share = 3.0 * (a + b) - 2.0 * (a * a + a * b + b * b);
  const Eigen::Vector3d w = whole.w0 + share * bend.w_ib_b;
  const Eigen::Vector3d f = whole.f0 + share * bend.f_b;
  return {(b - a) * whole.dt, w + a * dw, w + b * dw, f + a * df, f + b * df};
}

LinearRatesOf<Pair> Both(const LinearRates& a, const LinearRates& b) {
  const auto both = [](const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
    return Eigen::Matrix<Pair, 3, 1>(Pair(x(0), y(0)), Pair(x(1), y(1)),
                                     Pair(x(2), y(2)));
  };
  return {Pair(a.dt, b.dt), both(a.w0, b.w0), both(a.w1, b.w1),
          both(a.f0, b.f0), both(a.f1, b.f1)};
}

}  // namespace

bool ImuIntegrator::IsDropOut(std::size_t k) const {
  return stream_->IsDropOut(stream_->samples[k].t - stream_->samples[k - 1].t);
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
  const bool bends = stream_->kind == ImuStream::Kind::kRates;
  std::size_t k = FindInterval(t_i);
  const ImuSample* previous = k < 2 ? nullptr : &samples[k - 2];
  const ImuSample* a = &samples[k - 1];
  const ImuSample* b = &samples[k];
  double t = t_i;
  while (t < t_j) {
    const double to = k + 1 == samples.size() ? t_j : std::min(b->t, t_j);
    const LinearRates whole = RatesBetween(previous, *a, *b);
    const LinearRates* bridged =
        stream_->IsDropOut(whole.dt) ? &whole : nullptr;
    const bool part = t > a->t || to < b->t;
    if (part || bends) {
      LinearRates rates =
          PartOf(whole, BendOfInterval(k), part ? (t - a->t) / whole.dt : 0.0,
                 part ? (to - a->t) / whole.dt : 1.0);
      rates.dt = part ? to - t : whole.dt;
      if (rates.dt > 0.0) use(rates, bridged);
    } else if (whole.dt > 0.0) {
      use(whole, bridged);
    }
    t = to;
    if (k + 1 == samples.size()) continue;
    previous = std::exchange(a, b);
    b = &samples[++k];
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

std::array<ImuSummary, 2> ImuIntegrator::SummarizePair(
    const std::array<double, 3>& times, const ImuCalibration& calibration) {
  std::array<std::vector<LinearRates>, 2>& rates = pair_rates_;
  bool bridged = false;
  for (std::size_t i = 0; i < 2; ++i) {
    rates[i].clear();
    Walk(times[i], times[i + 1],
         [&](const LinearRates& each, const LinearRates* drop_out) {
           rates[i].push_back(each);
           bridged = bridged || drop_out != nullptr;
         });
  }
  if (bridged || rates[0].size() != rates[1].size()) {
    return {Summarize(times[0], times[1], calibration),
            Summarize(times[1], times[2], calibration)};
  }
  PreintegratorOf<Pair> integrator(stream_->noise, with_scale_jacobians_);
  integrator.Start({times[0], times[1]}, calibration);
  for (std::size_t k = 0; k < rates[0].size(); ++k) {
    integrator.Add(Both(rates[0][k], rates[1][k]));
  }
  std::array<ImuSummary, 2> summaries = {integrator.Finish(0),
                                         integrator.Finish(1)};
  summaries[0].t_j = times[1];
  summaries[1].t_j = times[2];
  return summaries;
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
