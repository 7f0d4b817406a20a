#include "dataset/clock_comparison.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/median.h"
#include "base/units.h"
#include "dataset/clock_misfit.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr double kFineEnough = 0.3;  // noise of an acceleration [m/s^2]
constexpr double kFineTurn = 0.01;   // noise of a turn [rad/s]

/// Over which the gyros' bias turns the held axes by some 3 deg.
double PieceLength(const InitialState& initial) {
  constexpr double kUsualBias = 0.2 * kDegree;
  constexpr double kTurn = 0.05;
  const double bias = initial.gyro_bias_sigma
                          ? initial.gyro_bias_sigma->maxCoeff()
                          : kUsualBias;
  return std::clamp(kTurn / bias, 5.0, 15.0);
}

/// Time over which noise falls to what is fine enough, of a value that is
/// differenced once or twice.
double WindowLength(double sigma, bool twice) {
  const double length = twice ? std::sqrt(std::sqrt(6.0) * sigma / kFineEnough)
                              : std::sqrt(2.0) * sigma / kFineEnough;
  return std::clamp(length, kShortestClockWindow, kLongestClockWindow);
}

double FieldWindowLength(const TimedRows& rows) {
  double norm = 0.0;
  for (const Eigen::Vector3d& field : rows.value) norm += field.norm();
  norm /= static_cast<double>(rows.value.size());
  return std::clamp(std::sqrt(2.0) * Median(rows.sigma) / (kFineTurn * norm),
                    kShortestClockWindow, kLongestClockWindow);
}

/// The specific force in a window of the IMU's record, as its rows would show it.
Eigen::Vector3d ForceIn(const HeldMotion& motion, double begin, double length,
                        bool triples) {
  if (!triples) {
    return (motion.At(begin + length).v - motion.At(begin).v) / length;
  }
  return (motion.At(begin + 2.0 * length).p -
          2.0 * motion.At(begin + length).p + motion.At(begin).p) /
         (length * length);
}

/// The distances of vectors from the median, by component, of those of their
/// piece.
std::vector<double> DeviationsOf(const std::vector<Eigen::Vector3d>& a,
                                 const std::vector<int>& pieces) {
  std::vector<double> out(a.size());
  for (std::size_t begin = 0, end = 0; begin < a.size(); begin = end) {
    while (end < a.size() && pieces[end] == pieces[begin]) ++end;
    Eigen::Vector3d middle;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> along;
      for (std::size_t i = begin; i < end; ++i) along.push_back(a[i](axis));
      middle(axis) = Median(std::move(along));
    }
    for (std::size_t i = begin; i < end; ++i) out[i] = (a[i] - middle).norm();
  }
  return out;
}

/// The most by which the specific force in windows differs from the median of a
/// piece, at any time of the IMU's record.
double LargestDeviation(const ImuStream& imu, const HeldMotion& motion,
                        double length, bool triples, double piece) {
  const double step = 0.25 * length;
  const double span = triples ? 2.0 * length : length;
  std::vector<Eigen::Vector3d> force;
  std::vector<int> pieces;
  for (double t = imu.t_begin(); t + span < imu.t_end(); t += step) {
    force.push_back(ForceIn(motion, t, length, triples));
    pieces.push_back(static_cast<int>((t - imu.t_begin()) / piece));
  }
  const std::vector<double> all = DeviationsOf(force, pieces);
  return all.empty() ? kNoMisfit : *std::max_element(all.begin(), all.end());
}

/// Leaves out the windows whose acceleration no such window of the IMU's record
/// comes near: a fix in them errs, and would hide the motion that the others
/// show. All stay if these are most: then the records differ in scale.
void LeaveOutJumps(const ImuStream& imu, double piece, double noise,
                   bool positions, ClockSeries* c) {
  constexpr double kMargin = 1.5;
  constexpr double kOfNoise = 5.0;
  const std::vector<Eigen::Vector3d> a = Accelerations(*c, positions);
  std::vector<int> pieces;
  for (const ClockWindows::Window& w : c->windows.windows) {
    pieces.push_back(w.piece);
  }
  const std::vector<double> deviation = DeviationsOf(a, pieces);
  const double limit =
      kMargin * LargestDeviation(imu, c->motion, c->windows.length, positions,
                                 piece) +
      kOfNoise * noise;
  std::vector<ClockWindows::Window> near;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (deviation[i] <= limit) near.push_back(c->windows.windows[i]);
  }
  if (2 * near.size() > a.size()) c->windows.windows = std::move(near);
}

ClockComparison Finish(const std::shared_ptr<const ClockSeries>& c,
                       std::string compared, double components,
                       std::function<double(double)> misfit) {
  return {.misfit = std::move(misfit),
          .first = c->rows.t.front(),
          .last = c->rows.t.back(),
          .resolution = c->windows.length,
          .freedom = components * c->windows.IndependentWindows(c->rows.t),
          .compared = std::move(compared)};
}

}  // namespace

std::optional<ClockComparison> CompareStream(const ImuStream& imu,
                                             const InitialState& initial,
                                             const AidingStream& stream) {
  constexpr std::size_t kFewestRows = 10;
  if (imu.empty() || stream.measurements.empty()) return std::nullopt;
  const MeasurementModel model = stream.measurements.front().model;
  const bool positions = std::holds_alternative<PositionFix>(model);
  const bool heights = std::holds_alternative<HeightFix>(model);
  const bool fields = std::holds_alternative<MagneticField>(model);
  const bool in_body = std::holds_alternative<Dvl>(model) ||
                       std::holds_alternative<Odometer>(model);
  const bool generated = stream.sensor.kind->generated;
  TimedRows rows = RowsOf(stream);
  if (generated || rows.t.size() < kFewestRows) return std::nullopt;
  const bool twice = positions || heights;
  const double length = fields ? FieldWindowLength(rows)
                               : WindowLength(Median(rows.sigma), twice);
  ClockWindows windows =
      MakeWindows(rows.t, length, twice, PieceLength(initial));
  if (windows.windows.empty()) return std::nullopt;
  const double sigma = Median(rows.sigma);
  ClockSeries series{HeldMotion(imu, initial.gyro_bias), std::move(rows),
                     std::move(windows)};
  if (!fields && !in_body && !heights) {
    const double l = series.windows.length;
    const double noise = positions ? std::sqrt(6.0) * sigma / (l * l)
                                   : std::sqrt(2.0) * sigma / l;
    LeaveOutJumps(imu, PieceLength(initial), noise, positions, &series);
  }
  const auto c = std::make_shared<const ClockSeries>(std::move(series));
  if (fields) {
    return Finish(c, "turns", 2.0,
                  [c](double offset) { return FieldMisfit(*c, offset); });
  }
  if (in_body) {
    return Finish(c, "accelerations", 1.0, [c](double offset) {
      return BodyVelocityMisfit(*c, offset);
    });
  }
  if (heights) {
    const std::vector<double> up = VerticalAccelerations(*c);
    return Finish(c, "vertical accelerations", 1.0, [c, up](double offset) {
      return HeightMisfit(*c, up, offset);
    });
  }
  const auto a = Accelerations(*c, positions);
  return Finish(c, "accelerations", 3.0, [c, a, positions](double offset) {
    return ForceMisfit(*c, a, positions, offset);
  });
}

}  // namespace hindsight
