#include "dataset/truth_start.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "imu/preintegration.h"

namespace hindsight {
namespace {

constexpr double kSearchRange = 2.0;  // [s]
constexpr double kSearchStep = 0.02;  // of the search [s]
constexpr double kLongestTurn = 5.0;  // between two attitudes [s]
constexpr double kKnownClock = 0.02;  // an offset known worse is not known [s]
constexpr std::size_t kFewestTurns = 20;

/// Attitude of the body at any time of the record, against its first.
class IntegratedGyro {
 public:
  explicit IntegratedGyro(const ImuStream& imu)
      : samples_(imu.samples), integrator_(imu) {
    q_.reserve(samples_.size());
    q_.push_back(Eigen::Quaterniond::Identity());
    for (std::size_t k = 1; k < samples_.size(); ++k) {
      q_.push_back(q_.back() * Turn(samples_[k - 1].t, samples_[k].t));
    }
  }

  Eigen::Quaterniond At(double t) {
    const auto it = std::lower_bound(
        samples_.begin() + 1, samples_.end() - 1, t,
        [](const ImuSample& s, double time) { return s.t < time; });
    const auto k = static_cast<std::size_t>(it - samples_.begin());
    return q_[k - 1] * Turn(samples_[k - 1].t, t);
  }

 private:
  Eigen::Quaterniond Turn(double from, double to) {
    return integrator_.Turn(from, to, Eigen::Vector3d::Zero());
  }

  const std::vector<ImuSample>& samples_;
  ImuIntegrator integrator_;
  std::vector<Eigen::Quaterniond> q_;
};

/// What an inertial body would see turn from one attitude of the truth to the
/// next.
struct TrueTurn {
  double from = 0.0;
  double to = 0.0;
  Eigen::Quaterniond q;
};

std::vector<TrueTurn> TrueTurns(const std::vector<TruthPoint>& truth) {
  std::vector<TrueTurn> turns;
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const TruthPoint& a = truth[k - 1];
    const TruthPoint& b = truth[k];
    const double dt = b.t - a.t;
    if (!a.q_nb || !b.q_nb || dt > kLongestTurn) continue;
    Eigen::Quaterniond q = a.q_nb->conjugate() * *b.q_nb;
    if (a.p_e) {
      const Eigen::Vector3d earth_n =
          NedAxes(*a.p_e).transpose() * EarthRate_e();
      q = Exp(a.q_nb->conjugate() * (dt * earth_n)) * q;
    }
    turns.push_back({a.t, b.t, q});
  }
  return turns;
}

/// Mean square of the misfit about its mean, an axis [rad^2]; infinite where
/// the IMU covers too few turns.
double Misfit(const ImuStream& imu, const std::vector<TrueTurn>& turns,
              double offset, IntegratedGyro* gyro) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0.0;
  std::size_t count = 0;
  for (const TrueTurn& turn : turns) {
    const double from = turn.from + offset;
    const double to = turn.to + offset;
    if (from < imu.t_begin() || to > imu.t_end()) continue;
    const Eigen::Vector3d r =
        Log(turn.q.conjugate() * gyro->At(from).conjugate() * gyro->At(to));
    sum += r;
    squares += r.squaredNorm();
    ++count;
  }
  if (count < kFewestTurns) return std::numeric_limits<double>::infinity();
  const auto n = static_cast<double>(count);
  return (squares - sum.squaredNorm() / n) / (3.0 * n);
}

/// Mean angular rate within 50 ms of t [rad/s].
Eigen::Vector3d RateAt(const ImuStream& imu, double t) {
  constexpr double kHalf = 0.05;
  const double from = std::max(t - kHalf, imu.t_begin());
  const double to = std::min(t + kHalf, imu.t_end());
  const Eigen::Quaterniond turn =
      ImuIntegrator(imu).Turn(from, to, Eigen::Vector3d::Zero());
  return Log(turn) / (to - from);
}

}  // namespace

std::optional<TruthClock> FindTruthClock(const ImuStream& imu,
                                         const std::vector<TruthPoint>& truth) {
  if (imu.empty()) return std::nullopt;
  IntegratedGyro gyro(imu);
  const std::vector<TrueTurn> turns = TrueTurns(truth);
  const auto misfit = [&](double offset) {
    return Misfit(imu, turns, offset, &gyro);
  };
  const int steps = static_cast<int>(std::lround(kSearchRange / kSearchStep));
  int best = -steps;
  double least = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  int count = 0;
  for (int i = -steps; i <= steps; ++i) {
    const double here = misfit(i * kSearchStep);
    if (!std::isfinite(here)) continue;
    sum += here;
    ++count;
    if (here < least) {
      least = here;
      best = i;
    }
  }
  // Noise alone has a best offset too, but not one much better than others.
  if (std::abs(best) == steps || count * least > 0.25 * sum) {
    return std::nullopt;
  }
  constexpr int kBits = 20;
  const auto [offset, at_best] = boost::math::tools::brent_find_minima(
      misfit, (best - 1) * kSearchStep, (best + 1) * kSearchStep, kBits);
  const double curvature = (misfit(offset - kSearchStep) +
                            misfit(offset + kSearchStep) - 2.0 * at_best) /
                           (kSearchStep * kSearchStep);
  const double n = 3.0 * static_cast<double>(turns.size());
  const TruthClock clock{offset, std::sqrt(2.0 * at_best / (n * curvature))};
  if (!(clock.sigma < kKnownClock)) return std::nullopt;
  return clock;
}

void StartFromTruth(Dataset* dataset) {
  InitialState& initial = dataset->initial;
  const ImuStream& imu = dataset->imu;
  const double from =
      std::max(initial.t.value_or(imu.t_begin()), imu.t_begin());
  for (const TruthPoint& point : dataset->truth) {
    if (point.t < from || point.t >= imu.t_end()) continue;
    if (!point.p_e || !point.v_n || !point.q_nb) continue;
    const Eigen::Vector3d& l_b = dataset->truth_lever_arm_b;
    const Eigen::Vector3d w_b = RateAt(imu, point.t) - initial.gyro_bias;
    initial.t = point.t;
    if (!initial.position) {
      const Eigen::Matrix3d C_en = NedAxes(*point.p_e);
      initial.position =
          GeodeticFromEcef(*point.p_e - C_en * (*point.q_nb * l_b));
    }
    if (!initial.v_n) initial.v_n = *point.v_n - *point.q_nb * w_b.cross(l_b);
    if (!initial.euler && !initial.heading) {
      initial.euler = EulerFromQuaternion(*point.q_nb);
    }
    return;
  }
  throw InputError(
      "no point of the truth inside the IMU's record has position, velocity "
      "and attitude");
}

}  // namespace hindsight
