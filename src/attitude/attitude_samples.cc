#include "attitude/attitude_samples.h"

#include "geometry/so3.h"

namespace hindsight {
Solution SampleAttitude(const Solution& solution, const ImuStream& imu,
                        const std::vector<double>& times) {
  Solution out = WithoutSeries(solution);
  if (solution.attitude) out.attitude.emplace();
  out.states.reserve(times.size());
  out.covariances =
      CovarianceSeries(solution.covariances.dim(),
                       solution.covariances.empty() ? 0 : times.size());
  std::size_t k = 0;
  std::size_t s = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    while (k + 1 < solution.states.size() &&
           solution.states[k + 1].t <= times[i]) {
      ++k;
    }
    while (s + 1 < imu.samples.size() &&
           imu.samples[s + 1].t <= solution.states[k].t) {
      ++s;
    }
    State x = solution.states[k];
    const Eigen::Vector3d w = imu.samples[s].gyro - x.b_g;
    x.q_eb = (x.q_eb * Exp((times[i] - x.t) * w)).normalized();
    x.t = times[i];
    out.states.push_back(x);
    if (!solution.covariances.empty()) {
      out.covariances.Set(i, solution.covariances.Get(k));
    }
    if (solution.attitude) {
      out.attitude->accel_sigma.push_back(solution.attitude->accel_sigma[k]);
      out.attitude->magnetic.push_back(solution.attitude->magnetic[k]);
    }
  }
  return out;
}

std::vector<BiasedForce> AveragedForce(
    const ImuStream& imu, const std::vector<Eigen::Quaterniond>& q_nb,
    double tau) {
  const double dt = MedianInterval(imu);
  std::vector<BiasedForce> force(q_nb.size());
  InertialLowPass forward(tau, dt);
  for (std::size_t k = 0; k < force.size(); ++k) {
    force[k] = forward.Filter(q_nb[k].toRotationMatrix() *
                              ForceAsRead(imu.samples[k].accel));
  }
  InertialLowPass backward(tau, dt);
  for (std::size_t k = force.size(); k-- > 0;) {
    force[k] =
        q_nb[k].toRotationMatrix().transpose() * backward.Filter(force[k]);
  }
  return force;
}

}  // namespace hindsight
