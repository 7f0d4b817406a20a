#include "problems/field_survey.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

const Eigen::Vector3d kField_n(18.0, -3.0, 44.0);

std::vector<SurveyedField> Readings(const Eigen::Vector3d& hard_iron_b) {
  Random random(7);
  std::vector<SurveyedField> readings;
  for (int k = 0; k < 400; ++k) {
    const Eigen::Quaterniond q = Exp(2.0 * random.NormalVector3());
    readings.push_back({0.05 * k, q,
                        q.conjugate() * kField_n + hard_iron_b +
                            0.5 * random.NormalVector3()});
  }
  return readings;
}

TEST(FieldSurvey, InventsNoHardIron) {
  const FieldSurvey survey = SurveyField(Readings(Eigen::Vector3d::Zero()));
  EXPECT_LT((survey.field_n - kField_n).norm(), 0.2);
  EXPECT_LT(survey.hard_iron_b.norm(), 0.2);
}

TEST(FieldSurvey, FindsAMagnetThatTravelsAlong) {
  const Eigen::Vector3d magnet(80.0, -120.0, 40.0);
  const FieldSurvey survey = SurveyField(Readings(magnet));
  EXPECT_LT((survey.field_n - kField_n).norm(), 0.3);
  EXPECT_LT((survey.hard_iron_b - magnet).norm(), 0.3);
}

TEST(FieldSurvey, PassesOverAMagnetThatOnlyAThirdComesNear) {
  std::vector<SurveyedField> readings = Readings(Eigen::Vector3d::Zero());
  for (std::size_t k = 0; k < readings.size(); k += 3) {
    readings[k].field_b +=
        readings[k].q_nb.conjugate() * Eigen::Vector3d(30.0, 40.0, 10.0);
  }
  const FieldSurvey survey = SurveyField(readings);
  EXPECT_LT((survey.field_n - kField_n).norm(), 0.3);
  EXPECT_LT(survey.trust[0], 0.01);
  EXPECT_GT(survey.trust[1], 0.5);
}

/// 8 uT are nothing in a field that differs by as much from place to place,
/// and a magnet in one that is even.
TEST(FieldSurvey, LearnsHowEvenTheFieldIs) {
  for (const bool even : {true, false}) {
    Random random(11);
    std::vector<SurveyedField> readings = Readings(Eigen::Vector3d::Zero());
    for (std::size_t k = 0; k < readings.size(); ++k) {
      if (!even) readings[k].field_b += 6.0 * random.NormalVector3();
      if (k % 10 == 0) {
        readings[k].field_b +=
            readings[k].q_nb.conjugate() * Eigen::Vector3d(0.0, 8.0, 0.0);
      }
    }
    const FieldSurvey survey = SurveyField(readings);
    int disturbed = 0;
    for (std::size_t k = 0; k < readings.size(); k += 10) {
      if (survey.IsDisturbed(k)) ++disturbed;
    }
    if (even) {
      EXPECT_EQ(disturbed, 40);
      // The sensor's 0.5 uT lie below the least scale.
      EXPECT_EQ(survey.scale, 1.0);
      EXPECT_LT((survey.field_n - kField_n).norm(), 0.3);
    } else {
      // Of 40, those beyond three sigmas.
      EXPECT_LE(disturbed, 3);
      EXPECT_NEAR(survey.scale, 6.0, 1.0);
    }
  }
}

TEST(FieldSurvey, ManyReadingsAtRestAreOne) {
  EXPECT_NEAR(IndependentPart(0.05, 0.0), 0.001, 1e-12);
  EXPECT_NEAR(IndependentPart(0.05, 0.005), 0.011, 1e-12);
  EXPECT_NEAR(IndependentPart(0.05, 3.0), 0.051, 1e-12);
  EXPECT_EQ(IndependentPart(100.0, 3.0), 1.0);
}

}  // namespace
}  // namespace hindsight
