#include "dataset/ground_motion.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "dataset/timeline_builder.h"

namespace hindsight {
namespace {

double HorizontalSigma(const Eigen::Matrix3d& R_n) {
  return std::sqrt(0.5 * R_n.topLeftCorner<2, 2>().trace());
}

/// Calls use(t, model, stream number) for each measurement of one model that is
/// not withheld and lies in [from, to] but for kSameTime, at a time inside.
template <typename Model, typename Use>
void ForEach(const Dataset& dataset, double from, double to, const Use& use) {
  for (std::size_t i = 0; i < dataset.streams.size(); ++i) {
    const AidingStream& stream = dataset.streams[i];
    // One sensor's measurements are of one model.
    if (stream.measurements.empty() ||
        !std::holds_alternative<Model>(stream.measurements.front().model)) {
      continue;
    }
    for (const Measurement& z : stream.measurements) {
      const double t = z.t + stream.sensor.time_offset;
      const auto* model = std::get_if<Model>(&z.model);
      if (model == nullptr || z.withheld || t < from - kSameTime ||
          t > to + kSameTime) {
        continue;
      }
      use(std::clamp(t, from, to), *model, static_cast<int>(i));
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

std::optional<BottomVelocity> BottomVelocityOf(const Dvl& dvl,
                                               const Sensor& sensor, double t) {
  const auto v_d = VelocityOf(dvl);
  if (dvl.water || !v_d) return std::nullopt;
  // The horizontal part of a Janus head's velocity is known to
  // sigma / (sqrt(2) sin a).
  const double beams = dvl.form == Dvl::Form::kThreeAxis
                           ? 1.0
                           : std::sqrt(2.0) * std::sin(dvl.beam_angle);
  return BottomVelocity{t,
                        sensor.q_sb.conjugate() * *v_d / (1.0 + sensor.scale),
                        dvl.sigma(0) / beams};
}

std::vector<BottomVelocity> BottomVelocities(const Dataset& dataset,
                                             double from, double to) {
  std::vector<BottomVelocity> out;
  ForEach<Dvl>(dataset, from, to, [&](double t, const Dvl& dvl, int i) {
    const auto velocity = BottomVelocityOf(
        dvl, dataset.streams[static_cast<std::size_t>(i)].sensor, t);
    if (velocity) out.push_back(*velocity);
  });
  std::stable_sort(out.begin(), out.end(),
                   [](const BottomVelocity& a, const BottomVelocity& b) {
                     return a.t < b.t;
                   });
  return out;
}

}  // namespace hindsight
