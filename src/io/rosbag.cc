#include "io/rosbag.h"

#include "base/error.h"

#ifdef HINDSIGHT_ROSBAG

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/NavSatFix.h>

#include <cmath>
#include <set>

namespace hindsight {
namespace {

/// base/units.h is C++20, which the message headers do not compile with.
constexpr double kDegree = M_PI / 180.0;

/// The topic asked for, or the only one whose messages are of `type`.
std::string FindTopic(const rosbag::Bag& bag, const std::string& path,
                      const std::string& wanted, const std::string& type) {
  rosbag::View view(bag);
  std::set<std::string> topics;
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    if (connection->datatype == type &&
        (wanted.empty() || connection->topic == wanted)) {
      topics.insert(connection->topic);
    }
  }
  if (topics.size() == 1) return *topics.begin();
  std::string list;
  for (const std::string& topic : topics) list += " " + topic;
  throw InputError(path, 0,
                   topics.empty() ? "holds no topic" +
                                        (wanted.empty() ? "" : " " + wanted) +
                                        " of " + type
                                  : "holds several topics of " + type + ":" +
                                        list + "; expected `topic`");
}

Stamp GpsStamp(const ros::Time& time) {
  return GpsFromUnix({std::int64_t{time.sec}, 1e-9 * time.nsec});
}

double SignedRoot(double covariance) {
  return std::copysign(std::sqrt(std::abs(covariance)), covariance);
}

void Take(const sensor_msgs::Imu& message, RowBuffer* rows) {
  rows->Set("gyro_x", message.angular_velocity.x);
  rows->Set("gyro_y", message.angular_velocity.y);
  rows->Set("gyro_z", message.angular_velocity.z);
  rows->Set("accel_x", message.linear_acceleration.x);
  rows->Set("accel_y", message.linear_acceleration.y);
  rows->Set("accel_z", message.linear_acceleration.z);
}

void Take(const sensor_msgs::NavSatFix& message, RowBuffer* rows) {
  rows->Set("lat", message.latitude * kDegree);
  rows->Set("lon", message.longitude * kDegree);
  rows->Set("h", message.altitude);
  rows->Set("quality", message.status.status);
  // East, north, up, row by row.
  const auto& P = message.position_covariance;
  rows->Set("sigma_n", std::sqrt(P[4]));
  rows->Set("sigma_e", std::sqrt(P[0]));
  rows->Set("sigma_d", std::sqrt(P[8]));
  rows->Set("sigma_h", std::sqrt(P[8]));
  rows->Set("sd_ne", SignedRoot(P[1]));
  rows->Set("sd_ed", SignedRoot(-P[2]));
  rows->Set("sd_dn", SignedRoot(-P[5]));
}

/// Counts what the rows must not hold.
bool IsLeftOut(const sensor_msgs::Imu&) { return false; }
bool IsLeftOut(const sensor_msgs::NavSatFix& message) {
  return message.status.status == sensor_msgs::NavSatStatus::STATUS_NO_FIX;
}

bool HasSigmas(const sensor_msgs::Imu&) { return false; }
bool HasSigmas(const sensor_msgs::NavSatFix& message) {
  return message.position_covariance_type !=
         sensor_msgs::NavSatFix::COVARIANCE_TYPE_UNKNOWN;
}

template <typename Message>
void ReadMessages(const rosbag::Bag& bag, const std::string& topic,
                  RowBuffer* rows) {
  long left_out = 0;
  long number = 0;
  bool sigmas = true;
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& instance : view) {
    ++number;
    const auto message = instance.instantiate<Message>();
    if (!message) continue;
    if (IsLeftOut(*message)) {
      ++left_out;
      continue;
    }
    rows->Append(GpsStamp(message->header.stamp), number);
    Take(*message, rows);
    sigmas = sigmas && HasSigmas(*message);
  }
  rows->LeaveOut("no fix", left_out);
  if (!sigmas) return;
  for (const char* field : {"sigma_n", "sigma_e", "sigma_d", "sigma_h", "sd_ne",
                            "sd_ed", "sd_dn"}) {
    rows->Declare(field);
  }
}

}  // namespace

RowBuffer ReadRosbag(const std::string& path, const std::string& topic,
                     const std::vector<FieldName>& fields) {
  const bool imu = &fields == &ImuFields();
  RowBuffer rows(path, fields, false);
  try {
    const rosbag::Bag bag(path);
    const std::string found = FindTopic(
        bag, path, topic, imu ? "sensor_msgs/Imu" : "sensor_msgs/NavSatFix");
    if (imu) {
      for (std::size_t i = 0; i < 6; ++i) rows.Declare(i);
      ReadMessages<sensor_msgs::Imu>(bag, found, &rows);
    } else {
      for (const char* field : {"lat", "lon", "h", "quality"}) {
        rows.Declare(field);
      }
      ReadMessages<sensor_msgs::NavSatFix>(bag, found, &rows);
    }
  } catch (const rosbag::BagException& error) {
    throw InputError(
        path, 0, std::string("cannot be read as a ROS 1 bag: ") + error.what());
  } catch (const ros::serialization::StreamOverrunException& error) {
    throw InputError(path, 0, "holds a damaged message");
  }
  if (rows.size() == 0) throw InputError(path, 0, "the topic holds no rows");
  return rows;
}

}  // namespace hindsight

#else

namespace hindsight {

RowBuffer ReadRosbag(const std::string& path, const std::string&,
                     const std::vector<FieldName>&) {
  throw InputError(path, 0,
                   "is a ROS 1 bag, which this build cannot read; expected a "
                   "build with librosbag-storage-dev and libsensor-msgs-dev");
}

}  // namespace hindsight

#endif  // HINDSIGHT_ROSBAG
