#include "problems/exchanged_places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "base/units.h"
#include "earth/wgs84.h"
#include "measurements/sensor_kind.h"
#include "problems/reconstruction.h"
#include "simulation/scenario.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;

/// A straight drive by positions alone, its heading unknown at first, near a place
/// of equal latitude and longitude: exchanged they are a drive as good but for
/// what the accelerometers feel of it.
Scenario Straight(double heading) {
  Scenario s;
  s.name = "straight";
  s.start = {33.0 * kDegree, 34.0 * kDegree, 50.0};
  s.start_heading = heading;
  s.imu_rate_hz = 100.0;
  s.imu.noise.gyro_noise_density = 0.01 * kDegree;
  s.imu.noise.accel_noise_density = 2e-3;
  s.imu.gyro_bias_sigma.setConstant(0.1 * kDegree);
  s.imu.accel_bias_sigma.setConstant(0.1);
  s.segments = {Segment::Stop(10.0),
                Segment::Accelerate(12.0, 1.5),
                Segment::Turn(20.0 * kDegree, 0.1),
                Segment::Straight(30.0),
                Segment::Turn(-15.0 * kDegree, 0.1),
                Segment::Straight(20.0)};
  AidingModel gnss(PositionKind());
  gnss.sensor.name = "gnss";
  gnss.rate_hz = 1.0;
  gnss.sigma.emplace().setConstant(1.0);
  s.aiding = {gnss};
  return s;
}

Dataset WithPlacesExchanged(Dataset dataset) {
  for (Measurement& z : dataset.streams.front().measurements.Edited()) {
    auto& fix = std::get<PositionFix>(z.model);
    Geodetic place = GeodeticFromEcef(fix.p_e);
    std::swap(place.latitude, place.longitude);
    fix.p_e = EcefFromGeodetic(place);
  }
  return dataset;
}

TEST(ExchangedPlaces, AreTold) {
  const Dataset dataset =
      WithPlacesExchanged(Simulate(Straight(20.0 * kDegree), 5));
  const Solution solution = Reconstruction(dataset, {}).Run("batch");
  EXPECT_NE(solution.grade, Grade::kUsable) << solution.verdict;
  EXPECT_THAT(solution.rivals,
              Contains(Field(&RivalSolution::description,
                             HasSubstr("latitude and longitude of gnss"))));
}

TEST(ExchangedPlaces, AreNoneOfHealthyData) {
  const int seeds = testing::SeedCount(10, 300);
  int told = 0;
  for (int i = 0; i < seeds; ++i) {
    const double heading = 2.0 * kPi * i / seeds;
    const Dataset dataset =
        Simulate(Straight(heading), 61000 + static_cast<std::uint64_t>(i));
    const Solution solution = Reconstruction(dataset, {}).Run("batch");
    told += solution.rivals.empty() ? 0 : 1;
  }
  EXPECT_LE(told, seeds > 100 ? 4 : 0);
}

}  // namespace
}  // namespace hindsight
