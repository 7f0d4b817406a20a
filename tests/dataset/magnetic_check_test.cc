#include "dataset/magnetic_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "dataset/checks.h"
#include "earth/geomagnetic_dipole.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A field of the given dip and 48 uT, measured to 0.5 uT on a drive with turns
/// and ramps at a latitude [deg].
Dataset Drive(double latitude_deg, double dip_deg) {
  Scenario scenario = FindScenario("short_drive");
  scenario.start.latitude = latitude_deg * kDegree;
  AidingModel compass(MagnetometerKind());
  compass.sensor.name = "compass";
  compass.sensor.magnetic.horizontal = 48.0 * std::cos(dip_deg * kDegree);
  compass.sensor.magnetic.down = 48.0 * std::sin(dip_deg * kDegree);
  compass.rate_hz = 10.0;
  compass.sigma.emplace().setConstant(0.5);
  PatternOf<MagneticField>(compass).form = MagneticField::Form::kVector;
  scenario.aiding.push_back(compass);
  return Simulate(scenario, 3);
}

Dataset Arranged(Dataset dataset, const Eigen::Matrix3d& read_from) {
  for (Measurement& z : dataset.streams.back().measurements.Edited()) {
    auto& field = std::get<MagneticField>(z.model);
    field.field_b = (read_from * field.field_b).eval();
  }
  return dataset;
}

Dataset Scaled(const Dataset& dataset, const Eigen::Vector3d& factors) {
  return Arranged(dataset, factors.asDiagonal());
}

TEST(CheckMagnetometers, HasNothingAgainstARightOneOnEitherHemisphere) {
  EXPECT_THAT(CheckMagnetometers(Drive(48.0, 65.0)), IsEmpty());
  EXPECT_THAT(CheckMagnetometers(Drive(-35.0, -60.0)), IsEmpty());
  EXPECT_THAT(CheckMagnetometers(Drive(-8.0, 2.0)), IsEmpty());
}

TEST(CheckMagnetometers, NamesTheFlippedAxis) {
  for (const double side : {1.0, -1.0}) {
    const Dataset dataset = Drive(side * 48.0, side * 65.0);
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d signs = Eigen::Vector3d::Ones();
      signs(axis) = -1.0;
      const auto warnings = CheckMagnetometers(Scaled(dataset, signs));
      ASSERT_EQ(warnings.size(), 1u) << axis;
      // On a level road, turned about the vertical, x and y differ by half a
      // turn of the heading alone.
      const char* expected[] = {"axis x, or y looks flipped",
                                "axis y, or x looks flipped",
                                "axis z looks flipped"};
      if (axis == 2) {
        EXPECT_THAT(warnings[0], HasSubstr(expected[2]));
        EXPECT_THAT(warnings[0], HasSubstr(side > 0 ? "points up by 6"
                                                    : "points down by 6"));
        EXPECT_THAT(warnings[0], HasSubstr("latitude"));
      } else {
        EXPECT_THAT(warnings[0], ::testing::AnyOf(HasSubstr(expected[0]),
                                                  HasSubstr(expected[1])));
      }
    }
    const auto rotated = CheckMagnetometers(Scaled(dataset, {1, -1, -1}));
    ASSERT_EQ(rotated.size(), 1u);
    EXPECT_THAT(rotated[0], HasSubstr("y and z"));
  }
}

TEST(CheckMagnetometers, ATumblingBodyTellsEveryAxis) {
  Scenario scenario = FindScenario("flight");
  scenario.duration = 300.0;
  for (Segment& segment : scenario.segments) {
    if (segment.kind == Segment::Kind::kPitch) segment.angle *= 8.0;
  }
  AidingModel compass(MagnetometerKind());
  compass.sensor.name = "compass";
  compass.sensor.magnetic.horizontal = 20.0;
  compass.sensor.magnetic.down = 43.0;
  compass.rate_hz = 10.0;
  scenario.aiding.push_back(compass);
  const Dataset dataset = Simulate(scenario, 4);
  EXPECT_THAT(CheckMagnetometers(dataset), IsEmpty());
  const char* kNames[] = {"axis x looks flipped", "axis y looks flipped",
                          "axis z looks flipped"};
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d signs = Eigen::Vector3d::Ones();
    signs(axis) = -1.0;
    const auto warnings = CheckMagnetometers(Scaled(dataset, signs));
    ASSERT_EQ(warnings.size(), 1u) << axis;
    EXPECT_THAT(warnings[0], HasSubstr(kNames[axis]));
  }
  struct Case {
    Eigen::Matrix3d read_from;
    const char* words;
  };
  for (const Case& wrong :
       {Case{(Eigen::Matrix3d() << 0, 1, 0, 1, 0, 0, 0, 0, 1).finished(),
             "axes look like [y, x, z]"},
        Case{(Eigen::Matrix3d() << 0, 1, 0, -1, 0, 0, 0, 0, 1).finished(),
             "axes look like [-y, x, z]"},
        Case{(Eigen::Matrix3d() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished(),
             "axes look like [y, z, x]"}}) {
    const auto warnings =
        CheckMagnetometers(Arranged(dataset, wrong.read_from));
    ASSERT_EQ(warnings.size(), 1u) << wrong.words;
    EXPECT_THAT(warnings[0], HasSubstr(wrong.words));
  }
}

TEST(CheckMagnetometers, KnowsHowLargeTheFieldCanBe) {
  const Dataset dataset = Drive(48.0, 65.0);
  struct Case {
    double factor;
    const char* words;
  };
  // 1 uT is 10 mG, 1e3 nT, 1e-2 G, 1e-6 T.
  for (const Case& wrong :
       {Case{1e4, "gauss read as tesla"}, Case{10.0, "milligauss read as uT"},
        Case{1e3, "nanotesla"}, Case{1e-2, "gauss read as microtesla"},
        Case{1e-6, "tesla read as microtesla"}, Case{2.0, "check the unit"}}) {
    const auto warnings = CheckMagnetometers(
        Scaled(dataset, Eigen::Vector3d::Constant(wrong.factor)));
    ASSERT_EQ(warnings.size(), 1u) << wrong.factor;
    EXPECT_THAT(warnings[0], HasSubstr("the Earth's has 22 to 67 uT"));
    if (wrong.factor != 10.0) {
      EXPECT_THAT(warnings[0], HasSubstr(wrong.words));
    }
  }
}

TEST(CheckMagnetometers, KnowsTheSignOfTheConfiguredField) {
  Dataset dataset = Drive(-35.0, -60.0);
  dataset.streams.back().sensor.magnetic.down *= -1.0;
  const auto warnings = CheckMagnetometers(dataset);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("points up"));
}

TEST(CheckMagnetometers, SpeaksInTheCheckOfTheRecording) {
  const Dataset dataset = Scaled(Drive(48.0, 65.0), {1, 1, -1});
  EXPECT_THAT(CheckDataset(dataset).warnings,
              Contains(HasSubstr("axis z looks flipped")));
}

TEST(DipoleField, HasTheHemispheresAndSizesOfTheEarth) {
  const auto field = [](double latitude, double longitude) {
    return DipoleField(
        EcefFromGeodetic({latitude * kDegree, longitude * kDegree, 0.0}));
  };
  // IGRF-13, 2020: Munich 48.6 uT, dip 64 deg; Sydney 57.2 uT, -64 deg; the
  // dipole alone is off by a third in norm, by 25 deg in dip.
  const Eigen::Vector3d munich = field(48.1, 11.6);
  EXPECT_NEAR(munich.norm(), 48.6, 16.0);
  EXPECT_NEAR(std::asin(munich.z() / munich.norm()) / kDegree, 64.0, 25.0);
  const Eigen::Vector3d sydney = field(-33.9, 151.2);
  EXPECT_NEAR(sydney.norm(), 57.2, 19.0);
  EXPECT_NEAR(std::asin(sydney.z() / sydney.norm()) / kDegree, -64.0, 25.0);
  // On the dipole's axis: 2 |M|, straight down.
  const Eigen::Vector3d pole = field(80.65, -72.68);
  EXPECT_NEAR(pole.z(), 2.0 * 29.8, 1.0);
  EXPECT_LT(pole.head<2>().norm(), 0.5);
}

}  // namespace
}  // namespace hindsight
