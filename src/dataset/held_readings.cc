#include "dataset/held_readings.h"

#include <cmath>
#include <variant>

#include "earth/wgs84.h"

namespace hindsight {
namespace {

constexpr double kEarthRadius = 6.37e6;  // [m], for lengths of degrees

/// The readings of a stream in time order.
class StreamReader {
 public:
  /// Nothing of a measurement that is no reading.
  std::optional<RowReading> Read(const Measurement& z) {
    return std::visit([this](const auto& model) { return Of(model); }, z.model);
  }

 private:
  static RowReading Plain(double a, double b = 0.0, double c = 0.0,
                          double d = 0.0) {
    const Eigen::Vector4d value(a, b, c, d);
    return {.row = value, .value = value};
  }
  static RowReading Plain(const Eigen::Vector3d& v) {
    return Plain(v.x(), v.y(), v.z());
  }

  std::optional<RowReading> Of(const PositionFix& z) {
    const Geodetic place = GeodeticFromEcef(z.p_e);
    if (!cosine_) cosine_ = std::cos(place.latitude);
    RowReading reading =
        Plain(kEarthRadius * place.latitude,
              kEarthRadius * *cosine_ * place.longitude, place.height);
    reading.position_sigma = z.R_n.diagonal().cwiseSqrt();
    return reading;
  }
  std::optional<RowReading> Of(const VelocityFix& z) { return Plain(z.v_n); }
  std::optional<RowReading> Of(const HeightFix& z) { return Plain(z.height); }
  std::optional<RowReading> Of(const MagneticField& z) {
    return Plain(z.field_b);
  }
  std::optional<RowReading> Of(const Odometer& z) {
    if (z.form == Odometer::Form::kNonHolonomic) return std::nullopt;
    return z.form == Odometer::Form::kIncrements ? Plain(z.distance)
                                                 : Plain(z.speed);
  }
  std::optional<RowReading> Of(const Dvl& z) {
    RowReading reading;
    for (int i = 0; i < z.components(); ++i) {
      if (z.valid[static_cast<std::size_t>(i)]) reading.row(i) = z.speed(i);
    }
    reading.value = reading.row;
    return reading;
  }
  std::optional<RowReading> Of(const SpeedCourse& z) {
    RowReading reading = Plain(z.speed);
    if (z.has_course) reading.row(1) = z.course;
    return reading;
  }
  std::optional<RowReading> Of(const AcousticFix& z) {
    if (!z.has_range) return std::nullopt;
    RowReading reading = Plain(z.range);
    reading.row.tail<2>() << z.azimuth, z.depression;
    return reading;
  }
  template <typename Model>
  std::optional<RowReading> Of(const Model&) {
    return std::nullopt;
  }

  std::optional<double> cosine_;  ///< of the first latitude
};

}  // namespace

HeldSeries HeldReadings(const AidingStream& stream) {
  HeldSeries all;
  std::optional<HeldReading> held;
  StreamReader reader;
  for (const Measurement& z : stream.measurements) {
    const std::optional<RowReading> reading = reader.Read(z);
    if (!reading) continue;
    if (held && held->reading.row == reading->row) {
      ++held->rows;
      held->t_end = z.t;
      continue;
    }
    if (held) all.push_back(*held);
    held = {*reading, z.t, z.t, 1};
  }
  if (held) all.push_back(*held);
  return all;
}

bool ReadsSpeed(const Measurement& z) {
  return std::holds_alternative<VelocityFix>(z.model) ||
         std::holds_alternative<Odometer>(z.model) ||
         std::holds_alternative<SpeedCourse>(z.model) ||
         std::holds_alternative<Dvl>(z.model);
}

}  // namespace hindsight
