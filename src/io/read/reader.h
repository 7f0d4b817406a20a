#ifndef HINDSIGHT_IO_READ_READER_H_
#define HINDSIGHT_IO_READ_READER_H_

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "earth/local_frame.h"
#include "io/read/file_digest.h"
#include "io/read/text_format.h"
#include "io/read/time_scale.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

/// How the stamps of a file become seconds since the data set's epoch.
struct ClockMap {
  enum class Scale {
    kDataset,  ///< seconds since the epoch as they stand
    kGps,      ///< since 1980-01-06, GPS time
    kUnix,     ///< since 1970, UTC without leap seconds
  };
  Scale scale = Scale::kDataset;
  std::optional<int> week;  ///< stamps are seconds of this GPS week
  /// The first row is at this time, the others as far behind it as their
  /// stamps say.
  std::optional<Stamp> start_date;  ///< GPS time since 1980-01-06
  std::optional<double> start;      ///< since the epoch [s]
  /// The last row lies this much behind the first; stamps in between are
  /// stretched linearly [s].
  std::optional<double> duration;
  std::optional<double> rate;  ///< stamps are row number / rate [Hz]
  double stretch = 1.0;        ///< factor on the time since the first row
  /// Times 1024 weeks are added to dates of receivers whose week number has
  /// started again from zero.
  int week_rollovers = 0;
  /// Only rows this much behind the first are used [s].
  double from = -std::numeric_limits<double>::infinity();
  double until = std::numeric_limits<double>::infinity();
  double offset = 0.0;  ///< added at last [s]

  /// Whether the configuration says where the rows stand in time, and no clock.
  bool placed() const { return start_date || start || rate; }
};

enum class DuplicatePolicy { kError, kDropFirst, kDropLast };

/// One file as the configuration declares it.
struct StreamSource {
  std::string name;  ///< key in the configuration, for messages and counts
  std::string path;
  /// Further files, in the order of time, that go on where it ends.
  std::vector<std::string> more_paths = {};
  TextFormat format;
  ClockMap clock;
  DuplicatePolicy on_duplicate = DuplicatePolicy::kError;
  bool sort = false;  ///< rows may stand in any order
  bool allow_truncated_tail = false;
  bool drop_text = false;  ///< rows of text between those of numbers
  /// Of an aiding sensor: a row whose measured values are those of the row
  /// before is no measurement.
  bool drop_repeats = false;
  bool absent_values = false;  ///< empty and NaN values are absent
  std::string config_path;
  long config_line = 0;
  /// Whether nobody wants the rows any more: reading ends by Interrupted then. May be
  /// null.
  const std::atomic<bool>* abandoned = nullptr;
  /// What digests of its files go to when they were read; may be null.
  ReadDigests* digests = nullptr;

  /// All of them.
  std::vector<std::string> Paths() const;
};

/// Stamps of a stream just read: rows carry the time since `first`.
struct StreamClock {
  Stamp first;
  bool dated = false;  ///< `first` is GPS time since 1980-01-06
  double last = 0.0;   ///< of the last row since `first` [s]
};

/// t = offset + scale (time since the first row).
struct TimeLine {
  double offset = 0.0;
  double scale = 1.0;
  double operator()(double since_first) const {
    return offset + scale * since_first;
  }
};

/// Throws InputError if the stream is dated and the data set is not.
TimeLine MapClock(const StreamSource& source, const StreamClock& clock,
                  std::optional<std::int64_t> epoch_gps_ns);

/// GPS time of the first row, if the stream knows it.
std::optional<Stamp> FirstGpsTime(const StreamSource& source,
                                  const StreamClock& clock);

struct ImuReadOptions {
  /// Of rates, the accelerometers' own file, on the gyros' clock.
  std::optional<StreamSource> accelerometer = {};
  Eigen::Matrix3d C_bs = Eigen::Matrix3d::Identity();  ///< sensor to body
  std::optional<ImuStream::Kind> kind;  ///< absent: as the columns say
  bool stamp_at_start = false;          ///< of increments
  double max_gap = 0.5;                 ///< [s]
  /// Where the samples' times are, asked for once the first row is known, when
  /// StreamClock::last is not yet; absent: they are since the first row.
  std::function<TimeLine(const StreamClock&)> place = {};
};

/// Reads an IMU file. Accelerometers of their own file are interpolated linearly at the gyros' stamps; a row of the
/// gyros before their first reading, behind their last, or in a gap of more than
/// 3.5 of their median intervals is dropped, and counted. Throws InputError for
/// everything that makes a record unusable: see TextTable, and stamps that run
/// backwards or repeat, and gaps longer than max_gap.
ImuStream ReadImu(const StreamSource& source, const ImuReadOptions& options,
                  StreamClock* clock, std::vector<PolicyCount>* policies);

/// Reads the measurements of an aiding sensor, the data set's stream `sensor`;
/// times since the first row. Throws InputError as ReadImu does, and for a
/// standard deviation that is not positive, a covariance that is not positive
/// definite, and what the kind of the sensor refuses. Velocities that are all
/// zero with zero standard deviations are absent in .pos files and left out.
MeasurementSeries ReadAiding(const StreamSource& source,
                             const SensorSettings& settings, int sensor,
                             StreamClock* clock,
                             std::vector<PolicyCount>* policies);

/// The axes of p_x ..., v_x ... and q_w ... in a reference trajectory.
struct TruthFrame {
  FrameAxes axes = FrameAxes::kEcef;
  /// Where the local axes stand: NED, ENU or NWU there.
  std::optional<Geodetic> origin;
  /// The quaternion turns the frame's components to the body's, not the body's
  /// to the frame's.
  bool frame_to_body = false;
};

struct TruthReadOptions {
  TruthFrame frame;
  Eigen::Matrix3d C_bs = Eigen::Matrix3d::Identity();  ///< its axes to body
};

/// Reads a reference trajectory: any of position, velocity and attitude.
TruthSeries ReadTruth(const StreamSource& source,
                      const TruthReadOptions& options, StreamClock* clock,
                      std::vector<PolicyCount>* policies);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_READER_H_
