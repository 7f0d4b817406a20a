#include "imu/known_imus.h"

#include <algorithm>
#include <array>

#include "base/units.h"

namespace hindsight {
namespace {

constexpr double kDegreePerRootHour = kDegree / 60.0;  // rad/s/sqrt(Hz)
constexpr double kMetrePerRootHour = 1.0 / 60.0;       // m/s^2/sqrt(Hz)

constexpr std::array kImus = {
    KnownImu{"ADIS16448", 0.0135 * kDegree, 0.23 * kMilliG,
             "https://www.analog.com/media/en/technical-documentation/"
             "data-sheets/ADIS16448.pdf as quoted by "
             "https://github.com/ethz-asl/kalibr/issues/63"},
    KnownImu{"BMI270", 0.007 * kDegree, 160.0 * kMicroG,
             "https://www.bosch-sensortec.com/media/boschsensortec/downloads/"
             "datasheets/bst-bmi270-ds000.pdf as quoted by "
             "https://docs.luxonis.com/hardware/platform/sensors/imu/bmi270/"},
    KnownImu{"ICM-20602", 0.004 * kDegree, 100.0 * kMicroG,
             "DS-000176 revision 1.0 as quoted by "
             "https://fdocuments.in/document/sdasdi-3-icm-20602-11-icm-20602-"
             "tdk-icm-20602-high-performance-6-axis-mems-motiontrackinga.html"},
    KnownImu{"ICM-42605", 0.0038 * kDegree, 70.0 * kMicroG,
             "DS-000292 revision 1.5 as quoted by "
             "https://vdocument.in/icm-42605-datasheet-2020-9-16-icm-42605-"
             "datasheet-premium-performance-6-axis.html"},
    KnownImu{"ICM-42688-P", 0.0028 * kDegree, 70.0 * kMicroG,
             "the highlights of its data sheet as quoted by "
             "https://pdf.elecfans.com/TDK/EV_ICM-42688-P.html"},
    KnownImu{"IMX-5", 0.16 * kDegreePerRootHour, 0.02 * kMetrePerRootHour,
             "https://github.com/inertialsense/docs.inertialsense.com, "
             "docs/user-manual/reference/imu_specifications.md"},
    KnownImu{
        "LSM6DSV", 0.0028 * kDegree, 60.0 * kMicroG,
        "https://www.st.com/resource/en/datasheet/lsm6dsv.pdf as quoted by "
        "https://docs.luxonis.com/hardware/platform/sensors/imu/lsm6dsv.md"},
    KnownImu{"MPU-6050", 0.005 * kDegree, 400.0 * kMicroG,
             "PS-MPU-6000A-00 revision 3.4, "
             "https://www.manualshelf.com/manual/unbranded/6dof-mpu-6050-"
             "gyroscope-and-accelerometer-module/data-sheet-english/"
             "page-12.html and page-13.html"},
    KnownImu{"MPU-9250", 0.01 * kDegree, 300.0 * kMicroG,
             "PS-MPU-9250A-01 revision 1.0, "
             "https://www.manualshelf.com/manual/sparkfun-electronics/"
             "sen-13762/data-sheet-english/page-8.html"},
    KnownImu{"MTi-300", 0.01 * kDegree, 60.0 * kMicroG,
             "https://cdn.shopify.com/s/files/1/0716/3048/7831/files/"
             "MTi-300.pdf"},
    KnownImu{"OpenIMU300ZA", 0.3 * kDegreePerRootHour, 0.05 * kMetrePerRootHour,
             "upper limits, https://github.com/Aceinna/docs_openrtk, "
             "300ZA/imu-sensors.rst"},
    KnownImu{"STIM300", 0.15 * kDegreePerRootHour, 0.06 * kMetrePerRootHour,
             "https://safran-navigation-timing.com/portal/download/"
             "stim300-datasheets/?version=r9 as quoted by "
             "https://is4s.github.io/NavToolkit/api-exhale/"
             "function_namespacenavtk_1_1filtering_"
             "1aba1bca27b920b3734a49c13cdc663e90.html"},
};

constexpr double kGyroWalk = 2e-3;   // of the density, 1/s
constexpr double kAccelWalk = 4e-3;  // likewise

}  // namespace

std::span<const KnownImu> KnownImus() { return kImus; }

const KnownImu* FindKnownImu(std::string_view name) {
  const auto found =
      std::find_if(kImus.begin(), kImus.end(),
                   [&](const KnownImu& imu) { return imu.name == name; });
  return found == kImus.end() ? nullptr : &*found;
}

double UsualGyroBiasWalk(double noise_density) {
  return kGyroWalk * noise_density;
}
double UsualAccelBiasWalk(double noise_density) {
  return kAccelWalk * noise_density;
}

ImuNoise NoiseOf(const KnownImu& imu) {
  ImuNoise noise;
  noise.gyro_noise_density = imu.gyro_noise_density;
  noise.accel_noise_density = imu.accel_noise_density;
  noise.gyro_bias_walk = UsualGyroBiasWalk(imu.gyro_noise_density);
  noise.accel_bias_walk = UsualAccelBiasWalk(imu.accel_noise_density);
  return noise;
}

}  // namespace hindsight
