#include "imu/known_imus.h"

#include <gtest/gtest.h>

#include <set>

namespace hindsight {
namespace {

TEST(KnownImus, AreInSiUnits) {
  const ImuNoise mti = NoiseOf(*FindKnownImu("MTi-300"));
  EXPECT_NEAR(mti.gyro_noise_density, 1.7453e-4, 1e-8);
  EXPECT_NEAR(mti.accel_noise_density, 5.884e-4, 1e-7);
  EXPECT_NEAR(mti.gyro_bias_walk, 2e-3 * 1.7453e-4, 1e-10);
  // 0.15 deg/sqrt(h) and 0.06 m/s/sqrt(h).
  const ImuNoise stim = NoiseOf(*FindKnownImu("STIM300"));
  EXPECT_NEAR(stim.gyro_noise_density, 4.3633e-5, 1e-9);
  EXPECT_NEAR(stim.accel_noise_density, 1e-3, 1e-9);
  // 0.16 deg/sqrt(h), 0.02 m/s/sqrt(h); 0.0135 deg/s/sqrt(Hz), 0.23 mg/sqrt(Hz).
  const ImuNoise imx = NoiseOf(*FindKnownImu("IMX-5"));
  EXPECT_NEAR(imx.gyro_noise_density, 4.6542e-5, 1e-9);
  EXPECT_NEAR(imx.accel_noise_density, 3.3333e-4, 1e-8);
  const ImuNoise adis = NoiseOf(*FindKnownImu("ADIS16448"));
  EXPECT_NEAR(adis.gyro_noise_density, 2.3562e-4, 1e-8);
  EXPECT_NEAR(adis.accel_noise_density, 2.2555e-3, 1e-7);
  EXPECT_EQ(FindKnownImu("mti-300"), nullptr);
}

TEST(KnownImus, NameTheirSources) {
  std::set<std::string_view> names;
  for (const KnownImu& imu : KnownImus()) {
    EXPECT_TRUE(names.insert(imu.name).second) << imu.name;
    EXPECT_NE(imu.source.find("https://"), std::string_view::npos) << imu.name;
    EXPECT_GT(imu.gyro_noise_density, 1e-6) << imu.name;
    EXPECT_LT(imu.gyro_noise_density, 1e-3) << imu.name;
    EXPECT_GT(imu.accel_noise_density, 1e-5) << imu.name;
    EXPECT_LT(imu.accel_noise_density, 1e-2) << imu.name;
  }
}

}  // namespace
}  // namespace hindsight
