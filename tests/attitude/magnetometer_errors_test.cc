#include "attitude/magnetometer_errors.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

/// `count` readings 0.1 s apart of a body that turns by some rad/s, `delay` [s]
/// behind it, with 0.5 uT an axis.
std::vector<SurveyedField> TurningReadings(const Eigen::Vector3d& hard_iron_b,
                                           double delay, int count,
                                           std::uint64_t seed) {
  constexpr double kStep = 0.1;
  const Eigen::Vector3d field_n(18.0, -3.0, 44.0);
  Random random(seed);
  std::vector<SurveyedField> readings;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector3d w = 2.0 * random.NormalVector3();
    const Eigen::Quaterniond q_then = q * Exp(-delay * w);
    readings.push_back({kStep * k, q,
                        q_then.conjugate() * field_n + hard_iron_b +
                            0.5 * random.NormalVector3(),
                        kStep, false, w});
    q = q * Exp(kStep * w);
  }
  return readings;
}

std::vector<SurveyedField> TurningFreely(const Eigen::Vector3d& hard_iron_b,
                                         int count) {
  return TurningReadings(hard_iron_b, 0.0, count, 7);
}

Eigen::Vector3d HardIronOf(const std::vector<SurveyedField>& readings) {
  return FindMagnetometerErrors(readings).hard_iron_b;
}

TEST(HardIron, IsNotInvented) {
  EXPECT_TRUE(
      HardIronOf(TurningFreely(Eigen::Vector3d::Zero(), 400)).isZero(0.0));
}

TEST(HardIron, IsFoundIfItTravelsAlong) {
  const Eigen::Vector3d magnet(80.0, -120.0, 40.0);
  EXPECT_LT((HardIronOf(TurningFreely(magnet, 400)) - magnet).norm(), 0.3);
}

/// Put on for a part of the time.
TEST(HardIron, IsNoneIfItWasNotThereAllTheTime) {
  for (const double part : {0.3, 0.6, 0.8}) {
    std::vector<SurveyedField> readings =
        TurningFreely(Eigen::Vector3d::Zero(), 600);
    const auto end = static_cast<std::size_t>(part * 600.0);
    for (std::size_t k = 0; k < end; ++k) {
      readings[k].field_b += Eigen::Vector3d(-3.0, 2.0, -27.0);
    }
    EXPECT_TRUE(HardIronOf(readings).isZero(0.0)) << part;
  }
}

TEST(HardIron, CountsManyReadingsAtRestAsOne) {
  EXPECT_NEAR(IndependentPart(0.05, 0.0), 0.001, 1e-12);
  EXPECT_NEAR(IndependentPart(0.05, 0.005), 0.011, 1e-12);
  EXPECT_NEAR(IndependentPart(0.05, 3.0), 0.051, 1e-12);
  EXPECT_EQ(IndependentPart(100.0, 3.0), 1.0);
}

/// True time less that of the stamps: negative where the sensor is late.
TEST(MagnetometerTurn, IsFoundWithItsSign) {
  const Eigen::Vector3d turn(0.03, -0.05, 0.12);
  std::vector<SurveyedField> readings =
      TurningFreely(Eigen::Vector3d::Zero(), 400);
  EXPECT_TRUE(FindMagnetometerErrors(readings).turn_b.isZero(0.0));
  for (SurveyedField& reading : readings) {
    reading.field_b = Exp(turn) * reading.field_b;
  }
  // The fit is linear in the turn.
  EXPECT_LT((FindMagnetometerErrors(readings).turn_b - turn).norm(),
            turn.squaredNorm());
}

TEST(MagnetometerTurn, IsNoneBelowWhatSurroundingsImitate) {
  std::vector<SurveyedField> readings =
      TurningFreely(Eigen::Vector3d::Zero(), 400);
  for (SurveyedField& reading : readings) {
    reading.field_b =
        Exp(Eigen::Vector3d(0.9 * kLeastTurn, 0.0, 0.0)) * reading.field_b;
  }
  EXPECT_TRUE(FindMagnetometerErrors(readings).turn_b.isZero(0.0));
}

TEST(MagnetometerScatter, IsThatOfAnAxis) {
  const auto scatter =
      FindMagnetometerErrors(TurningFreely({80.0, -120.0, 40.0}, 1000)).scatter;
  ASSERT_TRUE(scatter);
  EXPECT_NEAR(*scatter, 0.5, 0.05);
}

TEST(MagnetometerScatter, IsUnknownWhereTheBodyRests) {
  std::vector<SurveyedField> readings =
      TurningFreely(Eigen::Vector3d::Zero(), 1000);
  for (SurveyedField& reading : readings) {
    reading.q_nb = readings.front().q_nb;
  }
  EXPECT_FALSE(FindMagnetometerErrors(readings).scatter);
}

TEST(MagneticTimeOffset, IsFoundWithinItsSigma) {
  constexpr double kDelay = 0.012;
  const Eigen::Vector3d magnet(8.0, -12.0, 4.0);
  for (const Eigen::Vector3d& iron : {Eigen::Vector3d(0.0, 0.0, 0.0), magnet}) {
    const MagnetometerErrors found = FindMagnetometerErrors(
        TurningReadings(iron, kDelay, 600, 11), /*time_offset_sigma=*/0.02);
    EXPECT_NEAR(found.time_offset, -kDelay, 4.0 * found.time_offset_sigma);
    EXPECT_LT(found.time_offset_sigma, 0.1 * 0.02);
    EXPECT_LT((found.hard_iron_b - iron).norm(), 0.3);
  }
}

TEST(MagneticTimeOffset, IsNotSoughtUnasked) {
  const MagnetometerErrors found = FindMagnetometerErrors(
      TurningReadings(Eigen::Vector3d::Zero(), 0.012, 600, 11));
  EXPECT_EQ(found.time_offset, 0.0);
  EXPECT_EQ(found.time_offset_sigma, 0.0);
}

/// What the recording does not tell stays as it was known.
TEST(MagneticTimeOffset, StaysAsKnownAtRest) {
  std::vector<SurveyedField> readings =
      TurningFreely(Eigen::Vector3d::Zero(), 100);
  for (SurveyedField& reading : readings) {
    reading = readings.front();
    reading.w_b.setZero();
  }
  const MagnetometerErrors found = FindMagnetometerErrors(readings, 0.02);
  EXPECT_NEAR(found.time_offset, 0.0, 1e-12);
  EXPECT_NEAR(found.time_offset_sigma, 0.02, 1e-12);
}

}  // namespace
}  // namespace hindsight
