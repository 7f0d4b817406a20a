#include "attitude/attitude_samples.h"

#include <algorithm>

#include "attitude/inertial_low_pass.h"
#include "geometry/so3.h"
#include "imu/preintegration.h"

namespace hindsight {
namespace {

Eigen::Matrix<double, 6, 6> AttitudeAndBias(const Solution& nodes,
                                            std::size_t k) {
  const int a = nodes.layout.Find(BlockKind::kAttitude)->offset;
  const int b = nodes.layout.Find(BlockKind::kGyroBias)->offset;
  const ErrorMatrix full = nodes.covariances.Get(k);
  Eigen::Matrix<double, 6, 6> P;
  P << full.block<3, 3>(a, a), full.block<3, 3>(a, b), full.block<3, 3>(b, a),
      full.block<3, 3>(b, b);
  return P;
}

}  // namespace

Solution NodesAtSamples(const Solution& nodes, const ImuStream& imu,
                        const ErrorLayout& layout) {
  Solution out = WithoutSeries(nodes);
  out.layout = layout;
  const std::size_t count = imu.samples.size();
  out.states.reserve(count);
  out.covariances = CovarianceSeries(6, count);
  ImuIntegrator path(imu);
  std::vector<Eigen::Quaterniond> turned;
  std::size_t i = 0;
  Eigen::Matrix<double, 6, 6> P_end = AttitudeAndBias(nodes, 0);
  for (std::size_t k = 0; k + 1 < nodes.states.size(); ++k) {
    const State& begin = nodes.states[k];
    const State& end = nodes.states[k + 1];
    const Eigen::Matrix<double, 6, 6> P_begin = P_end;
    P_end = AttitudeAndBias(nodes, k + 1);
    const bool last = k + 2 == nodes.states.size();
    turned.clear();
    Eigen::Quaterniond q = begin.q_eb;
    double t = begin.t;
    const auto advance = [&](double to) {
      q = q * path.Turn(t, to, begin.b_g);
      t = to;
    };
    const std::size_t first = i;
    for (; i < count && (last || imu.samples[i].t < end.t); ++i) {
      advance(std::clamp(imu.samples[i].t, t, end.t));
      turned.push_back(q);
    }
    advance(end.t);
    const Eigen::Vector3d miss = Log(q.conjugate() * end.q_eb);
    for (std::size_t j = first; j < i; ++j) {
      State x = begin;
      x.t = imu.samples[j].t;
      const double part = (x.t - begin.t) / (end.t - begin.t);
      x.q_eb = (turned[j - first] * Exp(part * miss)).normalized();
      out.states.push_back(x);
      out.covariances.Set(j, part < 0.5 ? P_begin : P_end);
    }
  }
  return out;
}

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

std::vector<Eigen::Vector3d> AveragedForce(
    const ImuStream& imu, const std::vector<Eigen::Quaterniond>& q_nb,
    double tau) {
  const double dt = MedianInterval(imu);
  std::vector<Eigen::Vector3d> f_n(q_nb.size());
  InertialLowPass forward(tau, dt);
  for (std::size_t k = 0; k < f_n.size(); ++k) {
    f_n[k] = forward.Filter(q_nb[k] * imu.samples[k].accel);
  }
  InertialLowPass backward(tau, dt);
  for (std::size_t k = f_n.size(); k-- > 0;) f_n[k] = backward.Filter(f_n[k]);
  return f_n;
}

}  // namespace hindsight
