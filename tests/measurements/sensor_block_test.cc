#include "measurements/sensor_block.h"

#include <gtest/gtest.h>

#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// Whether it is one.
bool SetSigma(const SensorKey& key, SensorSettings* settings) {
  if (const auto* number = std::get_if<SensorKey::OptionalNumber>(&key.value)) {
    *number->at(*settings) = 0.5;
    return true;
  }
  if (const auto* three = std::get_if<SensorKey::OptionalSigmas>(&key.value)) {
    three->at(*settings)->emplace().setConstant(0.5);
    return true;
  }
  return false;
}

TEST(SensorBlock, ComesOfEachKeyOfEstimateAndOfEachClock) {
  for (const SensorKind* kind : SensorKinds()) {
    SensorSettings settings = SettingsOf(*kind);
    std::size_t expected = 0;
    for (const SensorKey& key : kind->keys) {
      if (!key.name.starts_with("estimate.")) continue;
      if (SetSigma(key, &settings)) ++expected;
    }
    if (kind->has_clock) {
      settings.sensor.time_offset_sigma = 0.5;
      ++expected;
    }
    std::size_t found = 0;
    for (const SensorBlock& block : kind->blocks) {
      const auto sigma = block.sigma(settings.sensor, nullptr);
      if (!sigma) continue;
      EXPECT_EQ(*sigma, Eigen::Vector3d::Constant(0.5)) << block.name;
      ++found;
    }
    EXPECT_EQ(found, expected) << kind->name;
  }
}

}  // namespace
}  // namespace hindsight
