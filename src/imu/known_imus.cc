#include "imu/known_imus.h"

#include <algorithm>
#include <array>

#include "base/units.h"

namespace hindsight {
namespace {

constexpr double kDegreePerRootHour = kDegree / 60.0;  // rad/s/sqrt(Hz)
constexpr double kMetrePerRootHour = 1.0 / 60.0;       // m/s^2/sqrt(Hz)

constexpr std::array kImus = {
    KnownImu{"BMI270", 0.007 * kDegree, 160.0 * kMicroG,
             "https://docs.luxonis.com/hardware/platform/sensors/imu/bmi270/"},
    KnownImu{
        "LSM6DSV", 0.0028 * kDegree, 60.0 * kMicroG,
        "https://docs.luxonis.com/hardware/platform/sensors/imu/lsm6dsv.md"},
    KnownImu{"MPU-9250", 0.01 * kDegree, 300.0 * kMicroG,
             "PS-MPU-9250A-01 revision 1.0, "
             "https://www.manualshelf.com/manual/sparkfun-electronics/"
             "sen-13762/data-sheet-english/page-8.html"},
    KnownImu{"MTi-300", 0.01 * kDegree, 60.0 * kMicroG,
             "https://cdn.shopify.com/s/files/1/0716/3048/7831/files/"
             "MTi-300.pdf"},
    KnownImu{
        "STIM300", 0.15 * kDegreePerRootHour, 0.06 * kMetrePerRootHour,
        "data sheet as quoted by https://is4s.github.io/NavToolkit/api-exhale/"
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
