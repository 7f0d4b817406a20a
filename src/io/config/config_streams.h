#ifndef HINDSIGHT_IO_CONFIG_CONFIG_STREAMS_H_
#define HINDSIGHT_IO_CONFIG_CONFIG_STREAMS_H_

#include <Eigen/Core>
#include <filesystem>

#include "io/config/config.h"
#include "io/config/config_help.h"
#include "io/config/config_key.h"
#include "io/config/config_map.h"
#include "io/read/reader.h"

namespace hindsight {

/// The keys that every stream has.
/// `fields` are the quantities that `columns` may name.
StreamSource ReadStreamSource(ConfigMap* map,
                              const std::filesystem::path& folder,
                              const std::vector<FieldName>& fields);

/// `time` of a stream whose file is of that format, and its documentation.
ClockMap ReadClock(ConfigMap* map, const FileFormat& format);
KeySection TimeSection();

/// `rows` of a stream whose lines stand between those of others, and its
/// documentation.
RowWord ReadRowWord(ConfigMap* map);
KeySection RowsSection();

/// `file`: a name, or those of the parts of one stream in the order of time.
std::vector<std::string> FileNames(ConfigMap* map);

/// C_bs of `axes` and `mounting`, of the imu or the truth; of either, turned by
/// what it says.
Eigen::Matrix3d ReadMounting(ConfigMap* map);
void ReadAxes(ConfigMap* map, Eigen::Matrix3d* C_bs);
void ReadTurn(ConfigMap* map, Eigen::Matrix3d* C_bs);

/// Fails for a turn by more than 360 deg: it is another unit's.
void RequireTurns(ConfigMap* map, const std::string& key,
                  const Eigen::Vector3d& angles);

/// `noise` of the imu.
ImuNoise ReadImuNoise(ConfigMap* imu);

/// What is said of the imu but for its file.
struct ImuConfig : ImuReadOptions {
  double time_offset = 0.0;  ///< [s]
  /// Of roll, pitch and yaw of `mounting` [rad].
  std::optional<Eigen::Vector3d> mounting_sigma;
  ImuNoise noise;
  std::optional<Eigen::Vector3d> gyro_scale_sigma;
  std::optional<Eigen::Vector3d> accel_scale_sigma;
};
ImuConfig ReadImuKeys(ConfigMap* map);

/// What is said of the truth but for its file.
struct TruthConfig : TruthReadOptions {
  bool clock_unknown = false;  ///< the gyros tell its time offset
  double time_offset = 0.0;    ///< [s]
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  ///< [m]
  TruthSigma sigma;
};
TruthConfig ReadTruthKeys(ConfigMap* map);

/// Of the keys that these functions read: imu, its noise and the truth; the
/// stream and its time; the start, rest, withholding and nodes; ahrs; what
/// every aiding stream has.
std::vector<KeySection> ImuSections();
KeySection TruthSection();
std::vector<KeySection> StreamSections();
std::vector<KeySection> StartSections();
KeySection AhrsSection();
KeySection AidingSection();
/// The top level (config.cc).
KeySection RecordingSection();

/// `constants`: what is taken from an earlier result.
struct ConstantsConfig {
  std::filesystem::path from;        ///< empty: nothing
  std::string method;                ///< empty: the best
  std::vector<std::string> without;  ///< names of constants
};
/// `from` in place of constants.from if it is not empty.
ConstantsConfig ReadConstantsConfig(ConfigMap* top, const std::string& from);
KeySection ConstantsSection();

/// One aiding stream's sensor and how its file is read.
struct AidingConfig {
  SensorSettings settings;
  StreamSource source;          ///< without a path, of a kind that has no file
  bool clock_of_truth = false;  ///< its time offset is the truth's
  bool clock_unknown = false;   ///< the data tell its time offset
};
AidingConfig ReadAidingConfig(const std::string& name, ConfigMap* map,
                              const std::filesystem::path& folder);

/// `gate`: off, or the probability of the chi-square gate.
std::optional<double> ReadGate(ConfigMap* map);

/// The a priori sigmas under `estimate` that the kind of the sensor allows.
void ReadCalibrationSigmas(ConfigMap* map, SensorSettings* settings);

/// Sensor axes from body axes: roll, pitch, yaw under `mounting`.
Eigen::Quaterniond ReadSensorMounting(ConfigMap* map);

AhrsSettings ReadAhrs(ConfigMap* top);
/// `from_truth`: what is absent is the truth's.
InitialState ReadInitialState(ConfigMap* top, bool* from_truth);
StationaryOptions ReadStationary(ConfigMap* top);
std::vector<Withholding> ReadWithholdings(ConfigMap* top);
std::vector<Omission> ReadOmissions(ConfigMap* top);
/// `nodes`, into Dataset::max_node_spacing.
void ReadNodes(ConfigMap* top, double* max_spacing);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_CONFIG_STREAMS_H_
