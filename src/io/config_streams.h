#ifndef HINDSIGHT_IO_CONFIG_STREAMS_H_
#define HINDSIGHT_IO_CONFIG_STREAMS_H_

#include <Eigen/Core>
#include <filesystem>

#include "io/config_map.h"
#include "io/reader.h"

namespace hindsight {

/// The keys that every stream has; keys are listed in io/config.h.
/// `fields` are the quantities that `columns` may name.
StreamSource ReadStreamSource(ConfigMap* map,
                              const std::filesystem::path& folder,
                              const std::vector<FieldName>& fields);

/// C_bs of `axes` and `mounting`, of the imu or the truth.
Eigen::Matrix3d ReadMounting(ConfigMap* map);

/// Fails for a turn by more than 360 deg: it is another unit's.
void RequireTurns(ConfigMap* map, const std::string& key,
                  const Eigen::Vector3d& angles);

/// `scale`, measured = (1 + scale) true; 0.
double ReadScale(ConfigMap* map);

/// latitude, longitude, height under `key`; nothing if it is absent.
std::optional<Geodetic> ReadGeodetic(ConfigMap* map, const std::string& key);

/// The frame of a truth's p_x ..., v_x ... and q_w ...
TruthFrame ReadTruthFrame(ConfigMap* truth);

/// `noise` of the imu.
ImuNoise ReadImuNoise(ConfigMap* imu);

/// One aiding stream's sensor and how its file is read.
struct AidingConfig {
  Sensor sensor;
  StreamSource source;
  AidingReadOptions options;
  /// There is no file: one measurement each 1/rate over the IMU's record [Hz].
  std::optional<double> generated_rate;
  bool clock_of_truth = false;  ///< its time offset is the truth's
  bool clock_unknown = false;   ///< the data tell its time offset
  /// Standard deviation of the vehicle's mean roll about zero [rad].
  std::optional<double> level_sigma;
};
AidingConfig ReadAidingConfig(const std::string& name, ConfigMap* map,
                              const std::filesystem::path& folder);

/// The keys of a DVL that a recording and a scenario share: form, beam_angle,
/// beam_azimuth, sigma, track, mounting, scale, current.
void ReadDvl(ConfigMap* map, Sensor* sensor, Dvl* dvl);

/// The keys of an acoustic range or bearing: transponder, sigma, bearing_sigma,
/// mounting, scale.
void ReadAcoustic(ConfigMap* map, Sensor* sensor, AcousticFix* fix);

/// `gate`: off, or the probability of the chi-square gate.
std::optional<double> ReadGate(ConfigMap* map);

/// The a priori sigmas under `estimate` that the type of the sensor allows.
void ReadCalibrationSigmas(ConfigMap* map, Sensor* sensor);

/// Sensor axes from body axes: roll, pitch, yaw under `mounting`.
Eigen::Quaterniond ReadSensorMounting(ConfigMap* map);

AhrsSettings ReadAhrs(ConfigMap* top);
/// `from_truth`: what is absent is the truth's.
InitialState ReadInitialState(ConfigMap* top, bool* from_truth);
StationaryOptions ReadStationary(ConfigMap* top);
std::vector<Withholding> ReadWithholdings(ConfigMap* top);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_STREAMS_H_
