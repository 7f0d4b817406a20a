#include "alignment/start_layout.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "measurements/noise_kind.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// `count` receivers with 7 values each.
Dataset Receivers(int count) {
  Dataset dataset;
  for (int i = 0; i < count; ++i) {
    AidingStream& stream = dataset.streams.emplace_back();
    stream.sensor.name = "gnss_" + std::to_string(i);
    stream.sensor.lever_arm_sigma = Eigen::Vector3d::Ones();
    stream.sensor.time_offset_sigma = 0.1;
    stream.sensor.noise.kind = &GaussMarkovNoise();
  }
  return dataset;
}

TEST(RequireCapacity, AcceptsWhatTheLayoutHolds) {
  Dataset dataset = Receivers(4);
  AidingStream& course = dataset.streams.emplace_back();
  course.sensor.name = "log";
  course.sensor.kind = &SpeedCourseKind();
  course.sensor.time_offset_sigma = 0.1;
  AidingStream& depth = dataset.streams.emplace_back();
  depth.sensor.name = "depth";
  depth.sensor.kind = &DepthKind();
  depth.sensor.offset_sigma = 0.1;
  dataset.gyro_scale_sigma = Eigen::Vector3d::Ones();
  EXPECT_EQ(BuildLayout(dataset, {}).parameter_count(), kMaxParameters);
  EXPECT_NO_THROW(RequireCapacity(dataset, "a.yaml"));
}

TEST(RequireCapacity, NamesTheLimitAndWhatEverySensorAdds) {
  Dataset dataset = Receivers(4);
  dataset.gyro_scale_sigma = Eigen::Vector3d::Ones();
  dataset.accel_scale_sigma = Eigen::Vector3d::Ones();
  try {
    RequireCapacity(dataset, "a.yaml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "a.yaml: 34 values to estimate beside position, velocity, "
                 "attitude and biases; expected at most 33: imu.estimate 6, "
                 "aiding.gnss_0 7, aiding.gnss_1 7, aiding.gnss_2 7, "
                 "aiding.gnss_3 7");
  }
}

}  // namespace
}  // namespace hindsight
