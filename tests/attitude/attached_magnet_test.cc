#include "attitude/attached_magnet.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr double kSigmaOfField = 2.0;  // [uT]
const Eigen::Vector3d kReference(18.0, 0.0, 44.0);

/// Two minutes in motion, readings 0.1 s apart, 1 uT an axis.
std::vector<SurveyedField> TwoMinutes() {
  Random random(21);
  std::vector<SurveyedField> readings;
  for (int k = 0; k < 1200; ++k) {
    const Eigen::Quaterniond q = Exp(2.0 * random.NormalVector3());
    readings.push_back({0.1 * k, q,
                        q.conjugate() * kReference + random.NormalVector3(),
                        0.1, false});
  }
  return readings;
}

std::vector<AttachedMagnet> Find(const std::vector<SurveyedField>& readings) {
  FieldSurvey survey;
  survey.horizontal = kReference.x();
  survey.down = kReference.z();
  return FindAttachedMagnets(readings, survey, kSigmaOfField);
}

TEST(AttachedMagnet, IsNotInvented) { EXPECT_TRUE(Find(TwoMinutes()).empty()); }

TEST(AttachedMagnet, HasABeginningAndAnEnd) {
  const Eigen::Vector3d magnet(-3.0, 2.0, -12.0);
  std::vector<SurveyedField> readings = TwoMinutes();
  for (SurveyedField& reading : readings) {
    const bool first = reading.t > 30.05 && reading.t < 60.05;
    if (first || reading.t > 100.05) reading.field_b += magnet;
  }
  const std::vector<AttachedMagnet> found = Find(readings);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].begin, 30.1, 0.5);
  EXPECT_NEAR(found[0].end, 60.0, 0.5);
  EXPECT_NEAR(found[1].begin, 100.1, 0.5);
  EXPECT_NEAR(found[1].end, 119.9, 0.5);
  EXPECT_LT((found[0].field_b - magnet).norm(), 0.5);
}

/// As strong, but it stays where it is; or it comes and goes.
TEST(AttachedMagnet, IsNoneIfItDoesNotTurnWithTheBody) {
  std::vector<SurveyedField> readings = TwoMinutes();
  for (SurveyedField& reading : readings) {
    if (reading.t < 30.05 || reading.t > 60.05) continue;
    reading.field_b +=
        reading.q_nb.conjugate() * Eigen::Vector3d(-3.0, 2.0, -12.0);
  }
  EXPECT_TRUE(Find(readings).empty());
  Random random(22);
  for (SurveyedField& reading : readings) {
    reading.field_b += 15.0 * random.NormalVector3();
  }
  EXPECT_TRUE(Find(readings).empty());
}

TEST(AttachedMagnet, IsNoneIfItIsThereForAMoment) {
  std::vector<SurveyedField> readings = TwoMinutes();
  for (std::size_t k = 300; k < 340; ++k) {
    readings[k].field_b += Eigen::Vector3d(-3.0, 2.0, -27.0);
  }
  EXPECT_TRUE(Find(readings).empty());
}

}  // namespace
}  // namespace hindsight
