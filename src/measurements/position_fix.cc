#include "measurements/position_fix.h"

#include <cmath>

#include "base/text.h"
#include "base/units.h"
#include "earth/local_frame.h"
#include "earth/utm.h"
#include "earth/wgs84.h"
#include "measurements/point_motion.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

void PositionFix::Evaluate(const ModelContext& context,
                           LinearizedMeasurement* out) const {
  const PointMotion motion = MotionOfSensor(context);
  const Eigen::Matrix3d C_ne = NedAxes(p_e).transpose();
  out->Resize(rows(), context.layout.dim());
  out->residual = C_ne * (p_e - motion.p_e);
  AddPositionColumns(context, motion, C_ne, &out->H);
  out->R = WhiteCovariance(context, R_n);
}

namespace {

/// Of Sensor::own. `frame`: geodetic coordinates, the name of FrameAxes one less, or
/// UTM, of which the others tell the zone.
enum Own : std::size_t { kFrame = 0, kZone = 1, kSouth = 2 };
constexpr double kUtm = 5.0;

/// Where the columns of a frame start.
constexpr std::size_t kLocal = 9;

bool IsLocal(const Sensor& sensor) { return sensor.own[kFrame] > 0.0; }

FrameAxes AxesOf(const Sensor& sensor) {
  return static_cast<FrameAxes>(static_cast<int>(sensor.own[kFrame]) - 1);
}

bool IsUtm(const Sensor& sensor) { return sensor.own[kFrame] == kUtm; }

bool HasZone(const SensorSettings& settings) { return IsUtm(settings.sensor); }

UtmZone ZoneOf(const Sensor& sensor) {
  return {static_cast<int>(sensor.own[kZone]), sensor.own[kSouth] == 0.0};
}

bool HasOrigin(const SensorSettings& settings) {
  return IsLocal(settings.sensor) && !IsUtm(settings.sensor) &&
         AxesOf(settings.sensor) != FrameAxes::kEcef;
}

/// Sensor::own_vector is the origin, but of UTM, whose axes are those at p_e.
LocalFrame FrameOf(const Sensor& sensor, const Eigen::Vector3d& p_e) {
  return IsUtm(sensor) ? UtmAxesAt(GeodeticFromEcef(p_e), ZoneOf(sensor))
                       : FrameAt(AxesOf(sensor), sensor.own_vector);
}

Eigen::Vector3d EcefFromLocal(const Eigen::Vector3d& p_l,
                              const Sensor& sensor) {
  if (IsUtm(sensor)) {
    return EcefFromGeodetic(GeodeticFromUtm(p_l, ZoneOf(sensor)));
  }
  const LocalFrame frame = FrameAt(AxesOf(sensor), sensor.own_vector);
  return frame.origin_e + frame.C_el * p_l;
}

Eigen::Vector3d LocalFromEcef(const Eigen::Vector3d& p_e,
                              const Sensor& sensor) {
  if (IsUtm(sensor)) {
    return UtmFromGeodetic(GeodeticFromEcef(p_e), ZoneOf(sensor));
  }
  const LocalFrame frame = FrameAt(AxesOf(sensor), sensor.own_vector);
  return frame.C_el.transpose() * (p_e - frame.origin_e);
}

void RequireUtm(const MeasuredRow& row, const Eigen::Vector3d& p) {
  constexpr double kWidest = 1e6;        // from the central meridian [m]
  constexpr double kFalseEasting = 5e5;  // [m]
  constexpr double kLongest = 1e7;       // from the equator to a pole [m]
  if (std::abs(p.x() - kFalseEasting) > kWidest || p.y() < -kLongest ||
      p.y() > 1.01 * kLongest) {
    row.Fail("easting " + FormatNumber(p.x()) + " m, northing " +
             FormatNumber(p.y()) + " m are in no zone of UTM");
  }
}

PositionFix LocalPosition(const MeasuredRow& row,
                          const SensorSettings& settings) {
  constexpr double kFarFromEarth = 1e8;  // [m]
  const Eigen::Vector3d p_l(row.Value(kLocal), row.Value(kLocal + 1),
                            row.Value(kLocal + 2));
  if (IsUtm(settings.sensor)) RequireUtm(row, p_l);
  const Eigen::Vector3d p_e = EcefFromLocal(p_l, settings.sensor);
  const double radius = p_e.norm();
  if (radius < 0.9 * kEarthSemiMajorAxis || radius > kFarFromEarth) {
    row.Fail("the position lies " + FormatNumber(radius) +
             " m from the centre of the Earth; expected it near the surface");
  }
  // `sigma` is along north, east and down whatever the frame.
  if (settings.sigma) return {.p_e = p_e, .R_n = row.Covariance()};
  const Eigen::Matrix3d C_nl =
      NedAxes(p_e).transpose() * FrameOf(settings.sensor, p_e).C_el;
  return {.p_e = p_e, .R_n = C_nl * row.Covariance() * C_nl.transpose()};
}

/// Columns of what a receiver says of itself.
enum Column : std::size_t { kQuality = 18, kSatellites = 19 };

PositionFix GeodeticPosition(const MeasuredRow& row) {
  const Geodetic place{row.Value(0), row.Value(1), row.Value(2)};
  if (const auto why = WhyNotNearEarth(place)) row.Fail(*why);
  return {.p_e = EcefFromGeodetic(place), .R_n = row.Covariance()};
}

std::optional<MeasurementModel> ReadPosition(const MeasuredRow& row,
                                             const SensorSettings& settings) {
  const bool local = IsLocal(settings.sensor);
  // What receivers write before their first fix.
  if (!local && row.Value(0) == 0.0 && row.Value(1) == 0.0) return std::nullopt;
  PositionFix fix =
      local ? LocalPosition(row, settings) : GeodeticPosition(row);
  if (row.Has(kQuality)) fix.quality = row.Value(kQuality);
  if (row.Has(kSatellites)) fix.satellites = row.Value(kSatellites);
  return fix;
}

std::vector<WrittenColumn> PositionColumns(const MeasurementModel&,
                                           const Sensor& sensor) {
  if (!IsLocal(sensor)) {
    return {{"lat", "deg", kDegree, 13}, {"lon", "deg", kDegree, 13},
            {"h", "m", 1.0, 7},          {"sigma_n", "m", 1.0, -12},
            {"sigma_e", "m", 1.0, -12},  {"sigma_d", "m", 1.0, -12}};
  }
  return {{"p_x", "m", 1.0, 7},       {"p_y", "m", 1.0, 7},
          {"p_z", "m", 1.0, 7},       {"sigma_x", "m", 1.0, -12},
          {"sigma_y", "m", 1.0, -12}, {"sigma_z", "m", 1.0, -12},
          {"sd_xy", "m", 1.0, -12},   {"sd_yz", "m", 1.0, -12},
          {"sd_zx", "m", 1.0, -12}};
}

std::vector<double> WriteLocal(const PositionFix& fix, const Sensor& sensor) {
  const Eigen::Vector3d p_l = LocalFromEcef(fix.p_e, sensor);
  const Eigen::Matrix3d C_ln =
      FrameOf(sensor, fix.p_e).C_el.transpose() * NedAxes(fix.p_e);
  const Eigen::Matrix3d R = C_ln * fix.R_n * C_ln.transpose();
  const auto root = [&](int i, int j) {
    return std::copysign(std::sqrt(std::abs(R(i, j))), R(i, j));
  };
  return {p_l.x(),    p_l.y(),    p_l.z(),    root(0, 0), root(1, 1),
          root(2, 2), root(0, 1), root(1, 2), root(2, 0)};
}

std::vector<double> WritePosition(const MeasurementModel& z,
                                  const Sensor& sensor) {
  const auto& fix = std::get<PositionFix>(z);
  if (IsLocal(sensor)) return WriteLocal(fix, sensor);
  const Geodetic g = GeodeticFromEcef(fix.p_e);
  const Eigen::Vector3d sigma = UncorrelatedSigma(fix.R_n);
  return {g.latitude, g.longitude, g.height, sigma.x(), sigma.y(), sigma.z()};
}

SensorKeys PositionKeys() {
  return {
      {.name = "frame",
       .value = SensorKey::Word{
           {"geodetic", "ecef", "ned", "enu", "nwu", "utm"},
           [](const SensorSettings& s) {
             return static_cast<std::size_t>(s.sensor.own[kFrame]);
           },
           [](SensorSettings& s, std::size_t word) {
             s.sensor.own[kFrame] = static_cast<double>(word);
           }},
       .help = "of the file: lat, lon, h, or p_x, p_y, p_z in these axes, of "
               "utm easting, northing and height"},
      {.name = "zone",
       .value =
           SensorKey::Whole{
               [](SensorSettings& s) { return &s.sensor.own[kZone]; }, 1, 60},
       .help = "of UTM, 1 to 60",
       .applies = HasZone,
       .when = "frame: utm",
       .needed = HasZone,
       .missing = "is missing; expected the zone of UTM, 1 to 60"},
      {.name = "hemisphere",
       .value = SensorKey::Word{{"north", "south"},
                                [](const SensorSettings& s) {
                                  return s.sensor.own[kSouth] == 0.0
                                             ? std::size_t{0}
                                             : std::size_t{1};
                                },
                                [](SensorSettings& s, std::size_t word) {
                                  s.sensor.own[kSouth] =
                                      static_cast<double>(word);
                                }},
       .help = "northings of the south count from 10 000 km",
       .applies = HasZone,
       .when = "frame: utm"},
      {.name = "origin",
       .value = SensorKey::Place{[](SensorSettings& s) {
         return &s.sensor.own_vector;
       }},
       .help = "[lat, lon, h] where p_x, p_y, p_z are zero and their axes "
               "stand level",
       .applies = HasOrigin,
       .when = "frame: ned, enu, nwu",
       .needed = HasOrigin,
       .missing = "is missing; expected the latitude, longitude and height of "
                  "the zero of local axes"},
      SigmaKey(Quantity::kLength, false,
               "replaces the file's: one, or north, east, down"),
      LeverArmKey(),
      LeverArmSigmaKey()};
}

std::optional<MeasurementModel> PerfectPosition(const SensorSettings& settings,
                                                const Motion& motion) {
  return PositionFix{
      .p_e = motion.p_e + motion.q_eb * settings.sensor.lever_arm_b,
      .R_n = settings.sigma->cwiseAbs2().asDiagonal()};
}

void DisturbPositions(const SensorSettings& settings, Random* random,
                      std::vector<Measurement>* measurements) {
  for (Measurement& z : *measurements) {
    auto& fix = std::get<PositionFix>(z.model);
    const Eigen::Vector3d error_n =
        settings.sigma->cwiseProduct(random->NormalVector3());
    fix.p_e += NedAxes(fix.p_e) * error_n;
  }
}

}  // namespace

const SensorKind& PositionKind() {
  static const SensorKind kKind = {
      .name = "position",
      .help = "positions of a point: GNSS, reference points, acoustic nets",
      .components = {"north", "east", "down"},
      .residual_unit = "m",
      .is_position = true,
      .places = true,
      .moves = true,
      .coloured = Quantity::kLength,
      .states_sigma = true,
      .columns =
          {{"lat", Quantity::kAngle},      {"lon", Quantity::kAngle},
           {"h", Quantity::kLength},       {"sigma_n", Quantity::kLength},
           {"sigma_e", Quantity::kLength}, {"sigma_d", Quantity::kLength},
           {"sd_ne", Quantity::kLength},   {"sd_ed", Quantity::kLength},
           {"sd_dn", Quantity::kLength},   {"p_x", Quantity::kLength},
           {"p_y", Quantity::kLength},     {"p_z", Quantity::kLength},
           {"sigma_x", Quantity::kLength}, {"sigma_y", Quantity::kLength},
           {"sigma_z", Quantity::kLength}, {"sd_xy", Quantity::kLength},
           {"sd_yz", Quantity::kLength},   {"sd_zx", Quantity::kLength},
           {"quality", Quantity::kRatio},  {"satellites", Quantity::kRatio}},
      .measured =
          [](const SensorSettings& settings) {
            return MeasuredColumns{IsLocal(settings.sensor) ? kLocal : 0, 3, 3};
          },
      .keys = PositionKeys(),
      .blocks = {LeverArmBlock(), TimeOffsetBlock(),
                 NoiseBlock(BlockKind::kColouredNoise, "m")},
      .prepare = [](SensorSettings* s) { s->pattern = PositionFix(); },
      .read = ReadPosition,
      .unread = "latitude and longitude zero: no fix",
      .written = PositionColumns,
      .write = WritePosition,
      .perfect = PerfectPosition,
      .disturb = DisturbPositions,
  };
  return kKind;
}

}  // namespace hindsight
