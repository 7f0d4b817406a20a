#include "base/units.h"
#include "io/config_streams.h"

namespace hindsight {
namespace {

Eigen::Vector4d ReadDvlSigma(ConfigMap* map, Dvl::Form form) {
  if (!map->Has("sigma")) {
    map->Fail("sigma", "is missing; expected a standard deviation of a speed");
  }
  if (form == Dvl::Form::kBeams) {
    return Eigen::Vector4d::Constant(map->Positive("sigma", Quantity::kSpeed));
  }
  Eigen::Vector4d sigma = Eigen::Vector4d::Ones();
  sigma.head<3>() = *map->OptionalSigma("sigma", Quantity::kSpeed);
  return sigma;
}

void ReadCurrent(ConfigMap* map, const Dvl& dvl, Sensor* sensor) {
  if (!map->Has("current")) {
    if (dvl.water) {
      map->Fail("current",
                "is missing; water track needs it: {sigma, time or length}");
    }
    return;
  }
  ConfigMap current = map->Map("current");
  sensor->current_sigma = current.Positive("sigma", Quantity::kSpeed);
  if (current.Has("time") && current.Has("length")) {
    current.Fail("length", "does not go with time");
  }
  if (current.Has("time")) {
    sensor->current_tau = current.Positive("time", Quantity::kTime);
  } else if (current.Has("length")) {
    sensor->current_length = current.Positive("length", Quantity::kLength);
  }
  current.Finish();
}

}  // namespace

Eigen::Quaterniond ReadSensorMounting(ConfigMap* map) {
  const Eigen::Vector3d euler =
      map->Vector("mounting", Quantity::kAngle, Eigen::Vector3d::Zero());
  RequireTurns(map, "mounting", euler);
  return QuaternionFromEuler(euler.x(), euler.y(), euler.z());
}

void ReadDvl(ConfigMap* map, Sensor* sensor, Dvl* dvl) {
  constexpr double kUsualAngle = 30.0 * kDegree;
  constexpr double kUsualAzimuth = 45.0 * kDegree;
  dvl->form = map->Choice("form", {"three_axis", "beams"}, 0) == 0
                  ? Dvl::Form::kThreeAxis
                  : Dvl::Form::kBeams;
  if (dvl->form == Dvl::Form::kBeams) {
    dvl->beam_angle =
        map->Positive("beam_angle", Quantity::kAngle, kUsualAngle);
    if (dvl->beam_angle >= 0.5 * kPi) {
      map->Fail("beam_angle", "must be less than 90 deg");
    }
    dvl->beam_azimuth =
        map->Number("beam_azimuth", Quantity::kAngle, kUsualAzimuth);
  }
  dvl->sigma = ReadDvlSigma(map, dvl->form);
  dvl->water = map->Choice("track", {"bottom", "water"}, 0) == 1;
  sensor->q_sb = ReadSensorMounting(map);
  sensor->scale = ReadScale(map);
  ReadCurrent(map, *dvl, sensor);
}

void ReadAcoustic(ConfigMap* map, Sensor* sensor, AcousticFix* fix) {
  const auto transponder = ReadGeodetic(map, "transponder");
  if (!transponder) {
    map->Fail("transponder",
              "is missing; expected [latitude, longitude, height]");
  }
  fix->p_t_e = EcefFromGeodetic(*transponder);
  fix->has_range = map->Has("sigma");
  fix->has_bearing = map->Has("bearing_sigma");
  if (fix->rows() == 0) {
    map->Fail("sigma",
              "is missing; expected sigma of a range, bearing_sigma, or both");
  }
  if (fix->has_range) {
    fix->sigma_range = map->Positive("sigma", Quantity::kLength);
  }
  if (fix->has_bearing) {
    fix->sigma_bearing = map->Positive("bearing_sigma", Quantity::kAngle);
  }
  sensor->q_sb = ReadSensorMounting(map);
  sensor->scale = ReadScale(map);
}

}  // namespace hindsight
