#ifndef HINDSIGHT_IO_READ_FOUND_STREAM_H_
#define HINDSIGHT_IO_READ_FOUND_STREAM_H_

#include <optional>
#include <string>
#include <vector>

#include "io/read/fix_guess.h"
#include "io/read/imu_guess.h"
#include "io/read/stamp_guess.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

struct FileFormat;

/// One line of a configuration: a key, which is indented by as much as its map
/// is deep, its value, and why.
struct KeyLine {
  std::string key;
  std::string value;
  std::string comment = {};
};

/// Replaces the line of that key, or adds it.
void SetLine(KeyLine line, std::vector<KeyLine>* lines);

/// The line of that key; nullptr if there is none.
const KeyLine* FindLine(const std::vector<KeyLine>& lines,
                        const std::string& key);

/// Of a wheel whose radius only the motion tells [m].
inline constexpr double kUsualWheelRadius = 0.3;

/// A stream that was found in a file or folder.
struct FoundStream {
  std::string file = {};  ///< its name, which is the caller's to set
  /// Further files of the stream, in the order of time, and how that is known.
  std::vector<std::string> more_files = {};
  std::string joined_by = {};
  const FileFormat* format = nullptr;  ///< set by RecogniseFormat
  bool imu = false;                    ///< holds one
  bool truth = false;  ///< is or holds one, by its name or its format
  bool pose = false;   ///< holds attitudes, and does not say that they are true
  bool sigmas = true;  ///< states those of `kinds`, where the format can
  /// What it can serve as besides, in the order of SensorKinds.
  std::vector<const SensorKind*> kinds = {};
  std::vector<KeyLine> lines = {};  ///< of its configuration, behind `format`
  /// Of columns that no configuration declared: how they become times.
  std::optional<StampGuess> stamps = {};
  std::optional<ImuGuess> imu_guess = {};
  /// Of an IMU on a wheel: the axis about which it spins, 0 to 2.
  std::optional<int> spin_axis = {};
  /// Of an odometer that reads the rate of a wheel, times kUsualWheelRadius.
  bool wheel_rate = false;
  bool speed_unit_told = true;            ///< of an odometer: its title says it
  std::vector<std::string> remarks = {};  ///< what was odd
  std::vector<std::string> assumptions = {};  ///< what may be otherwise
  double top_speed = 0.0;                     ///< of positions [m/s]
  /// Of positions: false where the unit, or which column is the latitude, is a
  /// guess, which the motion may contradict.
  bool place_unit_told = true;
  bool place_order_told = true;
  std::optional<RoughPlace> place = {};  ///< of positions in columns
};

/// The columns of what it is: an IMU, the first of its kinds, or a truth.
const std::vector<FieldName>& FieldsOf(const FoundStream& found);

/// Streams of formats that hold nothing else.
FoundStream FoundImu();
FoundStream FoundTruth();
FoundStream FoundAiding(std::vector<const SensorKind*> kinds);

/// Whether a file is called truth or reference, or `gt` or `ref` by a word of
/// its name.
bool IsNamedTruth(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_FOUND_STREAM_H_
