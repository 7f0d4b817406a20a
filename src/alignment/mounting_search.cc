#include "alignment/mounting_search.h"

#include <fmt/core.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "dataset/ground_motion.h"
#include "imu/sample_search.h"

namespace hindsight {
namespace {

constexpr double kSlowest = 2.0;      // [m/s]
constexpr double kShortest = 0.8;     // of a pair's window [s]
constexpr double kLongest = 2.5;      // [s]
constexpr double kFarthestLag = 1.0;  // [s]
constexpr double kLagStep = 0.05;     // [s]
constexpr double kWorstYaw = 15.0 * kDegree;
constexpr std::size_t kFewestChanges = 10;

/// How the velocity changed over a window, seen by somebody who looks along
/// the course.
struct Change {
  double begin = 0.0;
  double end = 0.0;
  Eigen::Vector3d f_o;  ///< a_o - g_o [m/s^2]
};

std::vector<Change> Changes(const std::vector<TimedVelocity>& velocities) {
  std::vector<Change> changes;
  for (std::size_t i = 0, j = 0; i < velocities.size(); i = j) {
    j = i + 1;
    while (j < velocities.size() &&
           velocities[j].t - velocities[i].t < kShortest) {
      ++j;
    }
    if (j == velocities.size()) break;
    const TimedVelocity& a = velocities[i];
    const TimedVelocity& b = velocities[j];
    const double dt = b.t - a.t;
    const Eigen::Vector2d mean = (a.v_n + b.v_n).head<2>() / 2.0;
    if (dt > kLongest || a.v_n.head<2>().norm() < kSlowest ||
        b.v_n.head<2>().norm() < kSlowest || mean.norm() < kSlowest) {
      continue;
    }
    const Eigen::Vector2d u = mean.normalized();
    const Eigen::Vector3d a_n = (b.v_n - a.v_n) / dt;
    changes.push_back({a.t,
                       b.t,
                       {u.dot(a_n.head<2>()), u.x() * a_n.y() - u.y() * a_n.x(),
                        a_n.z() - kStandardGravity}});
  }
  return changes;
}

/// Integral of the specific force from the first sample on, body axes. Within a
/// window of a second the body turns little about the mean of its own axes.
class ForceIntegral {
 public:
  explicit ForceIntegral(const ImuStream& imu) : imu_(imu) {
    sums_.assign(imu.samples.size(), Eigen::Vector3d::Zero());
    for (std::size_t k = 1; k < sums_.size(); ++k) {
      const double dt = imu.samples[k].t - imu.samples[k - 1].t;
      Eigen::Vector3d mean = imu.samples[k].accel;
      if (imu.kind == ImuStream::Kind::kRates) {
        mean = 0.5 * (mean + imu.samples[k - 1].accel) * dt;
      }
      sums_[k] = sums_[k - 1] + mean;
    }
  }

  bool Covers(double begin, double end) const {
    return begin >= imu_.t_begin() && end <= imu_.t_end();
  }
  Eigen::Vector3d Mean(double begin, double end) const {
    return (At(end) - At(begin)) / (end - begin);
  }

 private:
  Eigen::Vector3d At(double t) const {
    const auto& samples = imu_.samples;
    const std::size_t k = std::clamp<std::size_t>(FirstSampleAfter(imu_, t), 1,
                                                  samples.size() - 1);
    const double part =
        (t - samples[k - 1].t) / (samples[k].t - samples[k - 1].t);
    return sums_[k - 1] + part * (sums_[k] - sums_[k - 1]);
  }

  const ImuStream& imu_;
  std::vector<Eigen::Vector3d> sums_;
};

struct Fit {
  Eigen::Matrix3d C_ob;
  double misfit = 0.0;       ///< sum of squares, horizontal [m^2/s^4]
  double information = 0.0;  ///< sum of squared horizontal accelerations
  std::size_t count = 0;
};

/// Wahba's rotation at one lag.
Fit FitAt(double lag, const std::vector<Change>& changes,
          const ForceIntegral& force) {
  Eigen::Matrix3d B = Eigen::Matrix3d::Zero();
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> pairs;
  for (const Change& change : changes) {
    if (!force.Covers(change.begin + lag, change.end + lag)) continue;
    const Eigen::Vector3d f_b =
        force.Mean(change.begin + lag, change.end + lag);
    pairs.emplace_back(change.f_o, f_b);
    B += change.f_o * f_b.transpose();
  }
  Fit fit;
  fit.count = pairs.size();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
      B, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  fit.C_ob = svd.matrixU() * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() *
             svd.matrixV().transpose();
  for (const auto& [f_o, f_b] : pairs) {
    fit.misfit += (f_o - fit.C_ob * f_b).head<2>().squaredNorm();
    fit.information += f_o.head<2>().squaredNorm();
  }
  return fit;
}

}  // namespace

std::optional<FoundMounting> FindMounting(const Dataset& dataset, double from,
                                          double to) {
  const std::vector<Change> changes =
      Changes(GroundVelocities(dataset, from, to));
  if (changes.size() < kFewestChanges) return std::nullopt;
  const ForceIntegral force(dataset.imu);
  Fit best;
  double best_lag = 0.0;
  const int steps = static_cast<int>(std::lround(kFarthestLag / kLagStep));
  for (int i = -steps; i <= steps; ++i) {
    const Fit fit = FitAt(i * kLagStep, changes, force);
    if (fit.count < kFewestChanges) continue;
    if (best.count > 0 && fit.misfit >= best.misfit) continue;
    best = fit;
    best_lag = i * kLagStep;
  }
  // Noise alone is not explained by turning it.
  constexpr double kUnexplained = 0.5;
  if (best.count < kFewestChanges ||
      !(best.misfit < kUnexplained * best.information)) {
    return std::nullopt;
  }
  FoundMounting found;
  found.q_ob = Eigen::Quaterniond(best.C_ob);
  found.lag = best_lag;
  found.yaw_sigma = std::sqrt(best.misfit / best.information /
                              static_cast<double>(best.count));
  if (found.yaw_sigma > kWorstYaw) return std::nullopt;
  return found;
}

namespace {

bool NeedsSearch(const Sensor& sensor) {
  constexpr double kVague = 15.0 * kDegree;
  return sensor.mounting_unknown ||
         (sensor.mounting_sigma && sensor.mounting_sigma->maxCoeff() > kVague);
}

std::string Describe(const std::string& name, const FoundMounting& found) {
  const Eigen::Vector3d euler = EulerFromQuaternion(found.q_ob) / kDegree;
  return fmt::format(
      "{}: mounting found from accelerations against changes of "
      "velocity: roll {:.1f}, pitch {:.1f}, yaw {:.1f} deg",
      name, euler.x(), euler.y(), euler.z());
}

void TakeMounting(const FoundMounting& found, std::size_t vehicle,
                  Dataset* dataset) {
  constexpr double kFoundSigma = 10.0 * kDegree;
  Sensor& sensor = dataset->streams[vehicle].sensor;
  sensor.q_sb = found.q_ob;
  sensor.mounting_unknown = false;
  const Eigen::Vector3d most = Eigen::Vector3d::Constant(kFoundSigma);
  sensor.mounting_sigma = sensor.mounting_sigma.value_or(most).cwiseMin(most);
  for (AidingStream& other : dataset->streams) {
    if (other.sensor.vehicle == static_cast<int>(vehicle)) {
      other.sensor.q_sb = found.q_ob;
    }
  }
}

}  // namespace

void ResolveMountings(Dataset* dataset) {
  const double infinity = std::numeric_limits<double>::infinity();
  std::optional<FoundMounting> found;
  bool searched = false;
  for (std::size_t i = 0; i < dataset->streams.size(); ++i) {
    const Sensor& sensor = dataset->streams[i].sensor;
    if (!NeedsSearch(sensor)) continue;
    if (!searched) found = FindMounting(*dataset, -infinity, infinity);
    searched = true;
    if (found) {
      dataset->notes.push_back(Describe(sensor.name, *found));
      TakeMounting(*found, i, dataset);
    } else if (sensor.mounting_unknown) {
      throw EstimationError(
          "the mounting of the IMU in the vehicle of '" + sensor.name +
          "' is unknown and the motion does not show it; expected velocities "
          "or position fixes with starts, stops and turns above 2 m/s");
    }
  }
}

}  // namespace hindsight
