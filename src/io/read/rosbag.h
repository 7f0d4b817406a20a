#ifndef HINDSIGHT_IO_READ_ROSBAG_H_
#define HINDSIGHT_IO_READ_ROSBAG_H_

#include <string>
#include <vector>

#include "io/read/row_buffer.h"

namespace hindsight {

/// Reads the messages of one topic of a ROS 1 bag (io/read/bag_file.h),
/// sensor_msgs/Imu for an imu and sensor_msgs/NavSatFix for a position or
/// height, in the order in which they were received; their header's stamps, UTC
/// since 1970, become GPS time. An empty topic stands for the only one of the
/// type. IMU readings stay in the axes of the message; east-north-up
/// covariances become north-east-down ones; fixes with status -1 are left out.
/// Standard deviations are absent from messages whose covariance type is
/// unknown. Throws InputError if the bag is damaged or holds no such topic.
RowBuffer ReadRosbag(const std::string& path, const std::string& topic,
                     const std::vector<FieldName>& fields);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_ROSBAG_H_
