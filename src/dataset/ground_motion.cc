#include "dataset/ground_motion.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace hindsight {
namespace {

double HorizontalSigma(const Eigen::Matrix3d& R_n) {
  return std::sqrt(0.5 * R_n.topLeftCorner<2, 2>().trace());
}

/// Calls use(t, model, stream number) for each measurement of one model that is
/// not withheld and lies in [from, to].
template <typename Model, typename Use>
void ForEach(const Dataset& dataset, double from, double to, const Use& use) {
  for (std::size_t i = 0; i < dataset.streams.size(); ++i) {
    const AidingStream& stream = dataset.streams[i];
    for (const Measurement& z : stream.measurements) {
      const double t = z.t + stream.sensor.time_offset;
      const auto* model = std::get_if<Model>(&z.model);
      if (model == nullptr || z.withheld || t < from || t > to) continue;
      use(t, *model, static_cast<int>(i));
    }
  }
}

std::vector<TimedVelocity> Differences(const std::vector<TimedFix>& fixes) {
  std::vector<TimedVelocity> out;
  std::size_t first = 0;
  for (std::size_t k = 1; k < fixes.size(); ++k) {
    const double sigma = std::hypot(fixes[k].sigma, fixes[first].sigma);
    const double need = std::clamp(sigma / 0.3, 0.2, 5.0);
    while (first + 1 < k && fixes[k].t - fixes[first + 1].t >= need) ++first;
    const double dt = fixes[k].t - fixes[first].t;
    if (dt < need || dt > 10.0) continue;
    const Eigen::Matrix3d C_ne = NedAxes(fixes[k].p_e).transpose();
    out.push_back({0.5 * (fixes[k].t + fixes[first].t),
                   C_ne * (fixes[k].p_e - fixes[first].p_e) / dt, sigma / dt});
  }
  return out;
}

}  // namespace

std::vector<TimedFix> PositionFixes(const Dataset& dataset, double from,
                                    double to) {
  std::vector<TimedFix> fixes;
  ForEach<PositionFix>(
      dataset, from, to, [&](double t, const PositionFix& fix, int sensor) {
        fixes.push_back(
            {t, fix.p_e, fix.R_n, HorizontalSigma(fix.R_n), sensor});
      });
  std::stable_sort(
      fixes.begin(), fixes.end(),
      [](const TimedFix& a, const TimedFix& b) { return a.t < b.t; });
  return fixes;
}

std::vector<TimedVelocity> GroundVelocities(const Dataset& dataset, double from,
                                            double to) {
  std::vector<TimedVelocity> out;
  ForEach<VelocityFix>(dataset, from, to,
                       [&](double t, const VelocityFix& fix, int) {
                         out.push_back({t, fix.v_n, HorizontalSigma(fix.R_n)});
                       });
  if (out.empty()) return Differences(PositionFixes(dataset, from, to));
  std::stable_sort(
      out.begin(), out.end(),
      [](const TimedVelocity& a, const TimedVelocity& b) { return a.t < b.t; });
  return out;
}

namespace {

/// Of what was received, in the log's axes and as measured; nothing where less
/// than three components were.
std::optional<Eigen::Vector3d> VelocityOf(const Dvl& dvl) {
  if (dvl.rows() < 3) return std::nullopt;
  Eigen::Matrix<double, Eigen::Dynamic, 3> B(dvl.rows(), 3);
  Eigen::VectorXd z(dvl.rows());
  for (int i = 0, row = 0; i < dvl.components(); ++i) {
    if (!dvl.valid[static_cast<std::size_t>(i)]) continue;
    B.row(row) = dvl.Direction(i).transpose();
    z(row++) = dvl.speed(i);
  }
  return Eigen::Vector3d(B.colPivHouseholderQr().solve(z));
}

}  // namespace

std::vector<BottomVelocity> BottomVelocities(const Dataset& dataset,
                                             double from, double to) {
  std::vector<BottomVelocity> out;
  ForEach<Dvl>(dataset, from, to, [&](double t, const Dvl& dvl, int i) {
    const auto v_d = VelocityOf(dvl);
    if (dvl.water || !v_d) return;
    const Sensor& sensor = dataset.streams[static_cast<std::size_t>(i)].sensor;
    // The horizontal part of a Janus head's velocity is known to
    // sigma / (sqrt(2) sin a).
    const double beams = dvl.form == Dvl::Form::kThreeAxis
                             ? 1.0
                             : std::sqrt(2.0) * std::sin(dvl.beam_angle);
    out.push_back({t, sensor.q_sb.conjugate() * *v_d / (1.0 + sensor.scale),
                   dvl.sigma(0) / beams});
  });
  std::stable_sort(out.begin(), out.end(),
                   [](const BottomVelocity& a, const BottomVelocity& b) {
                     return a.t < b.t;
                   });
  return out;
}

namespace {

constexpr double kStep = 1.0;          // [s]
constexpr double kMargin = 1.0;        // of a velocity's validity [s]
constexpr double kWalking = 0.3;       // certainly moving above this [m/s]
constexpr double kResting = 0.1;       // at rest below this [m/s]
constexpr double kShortestRest = 3.0;  // seen by aiding sensors alone [s]
constexpr double kAidingGap = 2.5;     // [s]

/// Times of certain motion, in order.
std::vector<double> MotionTimes(const Dataset& dataset,
                                const std::vector<TimedVelocity>& velocities) {
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> times;
  const auto look = [&times](double t, const Eigen::Vector3d& v, double sigma) {
    if (v.head<2>().norm() > std::max(kWalking, 5.0 * sigma)) {
      times.push_back(t);
    }
  };
  for (const TimedVelocity& v : velocities) look(v.t, v.v_n, v.sigma);
  for (const BottomVelocity& v :
       BottomVelocities(dataset, -infinity, infinity)) {
    look(v.t, v.v_b, v.sigma);
  }
  std::sort(times.begin(), times.end());
  return times;
}

bool Moves(const std::vector<double>& motion, double begin, double end) {
  const auto it =
      std::lower_bound(motion.begin(), motion.end(), begin - kMargin);
  return it != motion.end() && *it <= end + kMargin;
}

void AppendRestsSeenByImu(const Dataset& dataset,
                          const std::vector<TimedVelocity>& velocities,
                          std::vector<TimeInterval>* rests) {
  const std::vector<double> motion = MotionTimes(dataset, velocities);
  for (const TimeInterval& still :
       FindStandstill(dataset.imu, dataset.stationary)) {
    bool joined = false;
    for (double t = still.begin; t < still.end; t += kStep) {
      const double end = std::min(t + kStep, still.end);
      if (Moves(motion, t, end)) {
        joined = false;
        continue;
      }
      if (joined) {
        rests->back().end = end;
      } else {
        rests->push_back({t, end});
      }
      joined = true;
    }
  }
}

void AppendRestsSeenByAiding(const std::vector<TimedVelocity>& velocities,
                             std::vector<TimeInterval>* rests) {
  TimeInterval rest;
  bool open = false;
  const auto close = [&] {
    // Half a second at either end may already be motion.
    const TimeInterval inside{rest.begin + 0.5, rest.end - 0.5};
    if (open && inside.end - inside.begin >= kShortestRest) {
      rests->push_back(inside);
    }
    open = false;
  };
  for (const TimedVelocity& v : velocities) {
    const bool rests_now =
        v.sigma < kResting &&
        v.v_n.head<2>().norm() < std::max(kResting, 2.0 * v.sigma);
    if (!rests_now || (open && v.t - rest.end > kAidingGap)) close();
    if (!rests_now) continue;
    if (!open) rest.begin = v.t;
    rest.end = v.t;
    open = true;
  }
  close();
}

}  // namespace

std::vector<TimeInterval> FindRests(const Dataset& dataset) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<TimedVelocity> velocities =
      GroundVelocities(dataset, -infinity, infinity);
  std::vector<TimeInterval> found;
  AppendRestsSeenByImu(dataset, velocities, &found);
  AppendRestsSeenByAiding(velocities, &found);
  std::sort(found.begin(), found.end(),
            [](const TimeInterval& a, const TimeInterval& b) {
              return a.begin < b.begin;
            });
  std::vector<TimeInterval> rests;
  for (const TimeInterval& rest : found) {
    if (!rests.empty() && rest.begin <= rests.back().end) {
      rests.back().end = std::max(rests.back().end, rest.end);
    } else {
      rests.push_back(rest);
    }
  }
  return rests;
}

}  // namespace hindsight
