#ifndef HINDSIGHT_TESTS_IO_SAMPLE_FOLDER_H_
#define HINDSIGHT_TESTS_IO_SAMPLE_FOLDER_H_

#include <string>

#include "io/recording_folder.h"

namespace hindsight {

/// Loads the samples of tests/data through configurations of a test's own.
class SampleFolder : public RecordingFolder {
 protected:
  static std::string Sample(const std::string& name) {
    return std::string(HINDSIGHT_SOURCE_DIR) + "/tests/data/" + name;
  }

  /// Lines of the imu without its noise; the rest of the configuration.
  Dataset LoadSample(const std::string& folder, const std::string& imu,
                     const std::string& rest = "") const {
    WriteConfig(folder, imu, rest);
    return Load();
  }
  std::string SampleError(const std::string& folder, const std::string& imu,
                          const std::string& rest = "") const {
    WriteConfig(folder, imu, rest);
    return LoadError();
  }

 private:
  void WriteConfig(const std::string& folder, const std::string& imu,
                   const std::string& rest) const {
    Write("config.yaml",
          "folder: \"" + Sample(folder) + "\"\nimu:\n" + imu +
              "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n" +
              rest);
  }
};

/// Rates of two samples, 20 ms apart, of a body at rest, at t = 0 and on.
inline constexpr const char* kRestingImu =
    "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],accel_x[m/s^2],"
    "accel_y[m/s^2],accel_z[m/s^2]\n"
    "0.00,0,0,0,0,0,-9.8\n0.02,0,0,0,0,0,-9.8\n0.04,0,0,0,0,0,-9.8\n";

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_IO_SAMPLE_FOLDER_H_
