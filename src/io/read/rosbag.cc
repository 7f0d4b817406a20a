#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>

#include "base/error.h"
#include "base/units.h"
#include "io/read/bag_file.h"
#include "io/read/file_formats.h"
#include "io/read/open_text.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// Takes the fields of a serialized message one after the other.
class RosMessage {
 public:
  explicit RosMessage(std::string_view bytes) : rest_(bytes) {}

  template <typename T>
  T Take() {
    T value{};
    if (rest_.size() < sizeof(T)) {
      whole_ = false;
      return value;
    }
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
    return value;
  }
  template <std::size_t n>
  std::array<double, n> Numbers() {
    return Take<std::array<double, n>>();
  }
  void SkipText() {
    const std::size_t size = Take<std::uint32_t>();
    whole_ = whole_ && size <= rest_.size();
    rest_.remove_prefix(std::min(size, rest_.size()));
  }
  /// Sequence number, stamp and frame; the stamp, UTC since 1970.
  Stamp Header() {
    Take<std::uint32_t>();
    const auto seconds = Take<std::uint32_t>();
    const auto nanoseconds = Take<std::uint32_t>();
    SkipText();
    return GpsFromUnix({std::int64_t{seconds}, 1e-9 * nanoseconds});
  }
  /// Nothing was missing and nothing is left.
  bool IsWhole() const { return whole_ && rest_.empty(); }

 private:
  std::string_view rest_;
  bool whole_ = true;
};

struct ImuMessage {
  static constexpr const char* kType = "sensor_msgs/Imu";
  std::uint64_t received = 0;
  Stamp stamp;
  std::array<double, 3> rate;
  std::array<double, 3> force;
};

struct FixMessage {
  static constexpr const char* kType = "sensor_msgs/NavSatFix";
  std::uint64_t received = 0;
  Stamp stamp;
  int status = 0;
  std::array<double, 3> position;    ///< latitude, longitude [deg], height
  std::array<double, 9> covariance;  ///< east, north, up, row by row
  int covariance_type = 0;           ///< 0: unknown
};

bool Parse(std::string_view bytes, ImuMessage* imu) {
  RosMessage message(bytes);
  imu->stamp = message.Header();
  message.Numbers<4 + 9>();  // orientation
  imu->rate = message.Numbers<3>();
  message.Numbers<9>();
  imu->force = message.Numbers<3>();
  message.Numbers<9>();
  return message.IsWhole();
}

bool Parse(std::string_view bytes, FixMessage* fix) {
  RosMessage message(bytes);
  fix->stamp = message.Header();
  fix->status = +message.Take<std::int8_t>();
  message.Take<std::uint16_t>();  // systems in use
  fix->position = message.Numbers<3>();
  fix->covariance = message.Numbers<9>();
  fix->covariance_type = message.Take<std::uint8_t>();
  return message.IsWhole();
}

double SignedRoot(double covariance) {
  return std::copysign(std::sqrt(std::abs(covariance)), covariance);
}

void SetValues(const ImuMessage& imu, RowBuffer* rows) {
  constexpr std::array kRates = {"gyro_x", "gyro_y", "gyro_z"};
  constexpr std::array kForces = {"accel_x", "accel_y", "accel_z"};
  for (std::size_t i = 0; i < 3; ++i) {
    rows->Set(kRates[i], imu.rate[i]);
    rows->Set(kForces[i], imu.force[i]);
  }
}

void SetValues(const FixMessage& fix, RowBuffer* rows) {
  rows->Set("lat", fix.position[0] * kDegree);
  rows->Set("lon", fix.position[1] * kDegree);
  rows->Set("h", fix.position[2]);
  rows->Set("quality", fix.status);
  const auto& P = fix.covariance;
  rows->Set("sigma_n", std::sqrt(P[4]));
  rows->Set("sigma_e", std::sqrt(P[0]));
  rows->Set("sigma_d", std::sqrt(P[8]));
  rows->Set("sigma_h", std::sqrt(P[8]));
  rows->Set("sd_ne", SignedRoot(P[1]));
  rows->Set("sd_ed", SignedRoot(-P[2]));
  rows->Set("sd_dn", SignedRoot(-P[5]));
}

bool IsLeftOut(const ImuMessage&) { return false; }
bool IsLeftOut(const FixMessage& fix) { return fix.status == -1; }

bool HasSigmas(const ImuMessage&) { return false; }
bool HasSigmas(const FixMessage& fix) { return fix.covariance_type != 0; }

/// The connections of the topic asked for, or of the only one of this type.
std::set<std::uint32_t> FindTopic(const BagFile& bag, const std::string& wanted,
                                  const std::string& type) {
  std::set<std::string> topics;
  std::set<std::uint32_t> connections;
  for (const BagConnection& connection : bag.connections()) {
    if (connection.type != type) continue;
    if (!wanted.empty() && connection.topic != wanted) continue;
    topics.insert(connection.topic);
    connections.insert(connection.id);
  }
  if (topics.size() == 1) return connections;
  if (topics.empty()) {
    throw InputError(bag.path(), 0,
                     "holds no topic" + (wanted.empty() ? "" : " " + wanted) +
                         " of " + type);
  }
  std::string list;
  for (const std::string& topic : topics) list += " " + topic;
  throw InputError(
      bag.path(), 0,
      "holds several topics of " + type + ":" + list + "; expected `topic`");
}

/// The topic's messages in the order in which they were received.
template <typename T>
std::vector<T> ReadMessages(const BagFile& bag, const std::string& topic) {
  const std::set<std::uint32_t> wanted = FindTopic(bag, topic, T::kType);
  std::vector<T> messages;
  bag.Visit([&](std::uint32_t connection, std::uint64_t received,
                std::string_view bytes) {
    if (!wanted.contains(connection)) return;
    T& message = messages.emplace_back();
    message.received = received;
    if (!Parse(bytes, &message)) bag.Fail("it holds a damaged message");
  });
  std::stable_sort(
      messages.begin(), messages.end(),
      [](const T& a, const T& b) { return a.received < b.received; });
  return messages;
}

template <typename T>
void AppendMessages(const std::vector<T>& messages, RowBuffer* rows) {
  long left_out = 0;
  long number = 0;
  bool sigmas = true;
  for (const T& message : messages) {
    ++number;
    if (IsLeftOut(message)) {
      ++left_out;
      continue;
    }
    rows->Append(message.stamp, number);
    SetValues(message, rows);
    sigmas = sigmas && HasSigmas(message);
  }
  rows->LeaveOut("no fix", left_out);
  if (!sigmas) return;
  for (const char* field : {"sigma_n", "sigma_e", "sigma_d", "sigma_h", "sd_ne",
                            "sd_ed", "sd_dn"}) {
    rows->Declare(field);
  }
}

RowBuffer ReadTopic(const TableRequest& request) {
  RowBuffer rows(request.path, request.fields, false);
  const auto given = request.format.values.find("topic");
  const std::string topic =
      given == request.format.values.end() ? "" : given->second;
  const BagFile bag(request.path);
  if (request.IsImu()) {
    for (std::size_t i = 0; i < 6; ++i) rows.Declare(i);
    AppendMessages(ReadMessages<ImuMessage>(bag, topic), &rows);
  } else {
    for (const char* field : {"lat", "lon", "h", "quality"}) {
      rows.Declare(field);
    }
    AppendMessages(ReadMessages<FixMessage>(bag, topic), &rows);
  }
  if (rows.size() == 0) {
    throw InputError(request.path, 0, "the topic holds no rows");
  }
  return rows;
}

std::optional<FoundStream> RecogniseBag(const std::filesystem::path& path) {
  if (path.extension() != ".bag") return std::nullopt;
  FoundStream found = FoundAiding({&PositionKind()});
  found.imu = true;
  return found;
}

}  // namespace

const FileFormat& RosbagFormat() {
  static const FileFormat kFormat = {
      .name = "rosbag",
      .help =
          "ROS 1 bag 2.0, plain, bz2 or lz4: sensor_msgs/Imu, "
          "sensor_msgs/NavSatFix",
      .streams = "imu, position, height",
      .whole_recordings = true,
      .keys = {{"topic", "the topic to read", "the only one that fits"}},
      .open =
          [](const TableRequest& request) {
            return OpenBuffer(ReadTopic(request), true);
          },
      .recognise_name = RecogniseBag};
  return kFormat;
}

}  // namespace hindsight
