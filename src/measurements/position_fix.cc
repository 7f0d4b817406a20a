#include "measurements/position_fix.h"

#include <cmath>

#include "base/text.h"
#include "base/units.h"
#include "earth/local_frame.h"
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

/// `frame`: geodetic coordinates, or the name of FrameAxes one less.
constexpr std::size_t kFrame = 0;  // of Sensor::own

/// Where the columns of a frame start.
constexpr std::size_t kLocal = 9;

bool IsLocal(const Sensor& sensor) { return sensor.own[kFrame] > 0.0; }

FrameAxes AxesOf(const Sensor& sensor) {
  return static_cast<FrameAxes>(static_cast<int>(sensor.own[kFrame]) - 1);
}

bool HasOrigin(const SensorSettings& settings) {
  return IsLocal(settings.sensor) &&
         AxesOf(settings.sensor) != FrameAxes::kEcef;
}

/// Sensor::own_vector is the origin.
LocalFrame FrameOf(const Sensor& sensor) {
  return FrameAt(AxesOf(sensor), sensor.own_vector);
}

PositionFix LocalPosition(const MeasuredRow& row,
                          const SensorSettings& settings) {
  constexpr double kFarFromEarth = 1e8;  // [m]
  const LocalFrame frame = FrameOf(settings.sensor);
  const Eigen::Vector3d p_l(row.Value(kLocal), row.Value(kLocal + 1),
                            row.Value(kLocal + 2));
  const Eigen::Vector3d p_e = frame.origin_e + frame.C_el * p_l;
  const double radius = p_e.norm();
  if (radius < 0.9 * kEarthSemiMajorAxis || radius > kFarFromEarth) {
    row.Fail("the position lies " + FormatNumber(radius) +
             " m from the centre of the Earth; expected it near the surface");
  }
  // `sigma` is along north, east and down whatever the frame.
  if (settings.sigma) return {.p_e = p_e, .R_n = row.Covariance()};
  const Eigen::Matrix3d C_nl = NedAxes(p_e).transpose() * frame.C_el;
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
  const LocalFrame frame = FrameOf(sensor);
  const Eigen::Vector3d p_l =
      frame.C_el.transpose() * (fix.p_e - frame.origin_e);
  const Eigen::Matrix3d C_ln = frame.C_el.transpose() * NedAxes(fix.p_e);
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
           {"geodetic", "ecef", "ned", "enu", "nwu"},
           [](const SensorSettings& s) {
             return static_cast<std::size_t>(s.sensor.own[kFrame]);
           },
           [](SensorSettings& s, std::size_t word) {
             s.sensor.own[kFrame] = static_cast<double>(word);
           }},
       .help = "of the file: lat, lon, h, or p_x, p_y, p_z in these axes"},
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
