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
  const auto c = std::make_shared<const ClockSeries>(ClockSeries{
      HeldMotion(imu, initial.gyro_bias), std::move(rows), std::move(windows)});
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
