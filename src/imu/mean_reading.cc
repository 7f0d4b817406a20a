#include "imu/mean_reading.h"

#include <algorithm>
#include <cstddef>

#include "base/parallel.h"
#include "imu/sample_search.h"

namespace hindsight {

namespace {

/// Integrals over intervals.
struct Integrals {
  Kinematics sum;
  double duration = 0.0;

  /// Of the interval that ends at sample k.
  void Add(const ImuStream& imu, std::size_t k, const ImuSample& before,
           const ImuSample& sample) {
    const double dt = sample.t - before.t;
    duration += dt;
    if (imu.kind == ImuStream::Kind::kIncrements && !imu.IsDropOut(dt)) {
      sum.w_ib_b += sample.gyro;
      sum.f_b += sample.accel;
      return;
    }
    const LinearRates rates = ImuIntegrator(imu).RatesOfInterval(k);
    sum.w_ib_b += 0.5 * dt * (rates.w0 + rates.w1);
    sum.f_b += 0.5 * dt * (rates.f0 + rates.f1);
  }
};

}  // namespace

Kinematics MeanReading(const ImuStream& imu, double begin, double end) {
  constexpr double kRounding = 1e-6;  // of stamps [s]
  const std::size_t last = imu.samples.size() - 1;
  std::size_t first = FirstSampleAt(imu, begin - kRounding) + 1;
  std::size_t to = FirstSampleAt(imu, end + kRounding);
  if (first >= to) {
    first = std::clamp<std::size_t>(FirstSampleAt(imu, 0.5 * (begin + end)), 1,
                                    last);
    to = first + 1;
  }
  Integrals all;
  std::size_t k = first;
  WalkSamples(imu, first, to,
              [&](const ImuSample& before, const ImuSample& sample) {
                all.Add(imu, k++, before, sample);
                return true;
              });
  all.sum.w_ib_b /= all.duration;
  all.sum.f_b /= all.duration;
  return all.sum;
}

std::vector<Kinematics> MeanReadings(const ImuStream& imu,
                                     const std::vector<double>& times) {
  constexpr std::size_t kTimesOfThread = 256;
  std::vector<Kinematics> means(times.size());
  const auto read = [&](std::size_t k) {
    const double before = times[k == 0 ? k : k - 1];
    const double after = times[std::min(k + 1, times.size() - 1)];
    return MeanReading(imu, 0.5 * (before + times[k]),
                       0.5 * (times[k] + after));
  };
  ForRanges(times.size(), kTimesOfThread,
            [&](std::size_t begin, std::size_t end) {
              for (std::size_t k = begin; k < end; ++k) means[k] = read(k);
            });
  return means;
}

Kinematics WithoutErrors(Kinematics mean, const ImuCalibration& calibration) {
  const ImuCalibration& c = calibration;
  const Eigen::Vector3d one = Eigen::Vector3d::Ones();
  mean.w_ib_b = (mean.w_ib_b - c.b_g).cwiseQuotient(one + c.s_g);
  mean.f_b = (mean.f_b - c.b_a).cwiseQuotient(one + c.s_a);
  return mean;
}

}  // namespace hindsight
