#include "attitude/field_survey.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/random.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

const Eigen::Vector3d kSurveyField(18.0, -3.0, 44.0);
constexpr double kSpacing = 0.1;

/// `count` readings in a field, `noise` [uT] an axis, in motion or at rest.
void Append(const Eigen::Vector3d& field_n, int count, bool at_rest,
            double noise, Random* random,
            std::vector<SurveyedField>* readings) {
  for (int k = 0; k < count; ++k) {
    const Eigen::Quaterniond q = at_rest ? Eigen::Quaterniond::Identity()
                                         : Exp(2.0 * random->NormalVector3());
    readings->push_back(
        {kSpacing * static_cast<double>(readings->size()), q,
         q.conjugate() * field_n + noise * random->NormalVector3(), kSpacing,
         at_rest});
  }
}

std::vector<SurveyedField> InMotion(const Eigen::Vector3d& hard_iron_b,
                                    int count) {
  Random random(7);
  std::vector<SurveyedField> readings;
  Append(kSurveyField, count, false, 0.5, &random, &readings);
  for (SurveyedField& reading : readings) reading.field_b += hard_iron_b;
  return readings;
}

double Total(const FieldSurvey& survey) {
  return std::accumulate(survey.weight.begin(), survey.weight.end(), 0.0);
}

TEST(FieldSurvey, AnEvenFieldIsKnownAsWellInMotionAsAtRest) {
  Random random(3);
  std::vector<SurveyedField> readings;
  Append(kSurveyField, 300, true, 0.5, &random, &readings);
  Append(kSurveyField, 900, false, 0.5, &random, &readings);
  const FieldSurvey survey = SurveyField(readings, {});
  EXPECT_NEAR(survey.horizontal, kSurveyField.head<2>().norm(), 0.2);
  EXPECT_NEAR(survey.down, kSurveyField.z(), 0.2);
  EXPECT_LT(survey.memory, 3.0);
  // One in a second, of 120 s.
  EXPECT_GT(Total(survey), 40.0);
}

/// Where the hand moves the field is another one than where it rests: a minute
/// there is hardly more than one reading.
TEST(FieldSurvey, OneFieldOfTheMotionIsOneReading) {
  Random random(3);
  std::vector<SurveyedField> readings;
  Append(kSurveyField, 300, true, 0.5, &random, &readings);
  Append(kSurveyField + Eigen::Vector3d(1.5, 2.0, 2.0), 600, false, 0.5,
         &random, &readings);
  const FieldSurvey survey = SurveyField(readings, {});
  EXPECT_NEAR(survey.horizontal, kSurveyField.head<2>().norm(), 0.2);
  EXPECT_NEAR(survey.down, kSurveyField.z(), 0.2);
  EXPECT_GT(survey.memory, 30.0);
  const double at_rest =
      std::accumulate(survey.weight.begin(), survey.weight.begin() + 300, 0.0);
  EXPECT_GT(at_rest, 25.0);
  EXPECT_LT(Total(survey) - at_rest, 2.0);
}

TEST(FieldSurvey, NeedsNoRest) {
  const FieldSurvey survey =
      SurveyField(InMotion(Eigen::Vector3d::Zero(), 600), {});
  EXPECT_NEAR(survey.horizontal, kSurveyField.head<2>().norm(), 0.2);
  EXPECT_NEAR(survey.down, kSurveyField.z(), 0.2);
  EXPECT_GT(Total(survey), 20.0);
}

TEST(FieldSurvey, PassesOverAMagnetThatComesNear) {
  std::vector<SurveyedField> readings = InMotion(Eigen::Vector3d::Zero(), 600);
  for (std::size_t k = 0; k < readings.size(); k += 3) {
    readings[k].field_b +=
        readings[k].q_nb.conjugate() * Eigen::Vector3d(30.0, 40.0, 10.0);
  }
  FieldSurvey survey = SurveyField(readings, {});
  EXPECT_EQ(survey.weight[0], 0.0);
  EXPECT_GT(survey.weight[1], 0.0);
  survey = SurveyField(readings, {.reject = false});
  EXPECT_EQ(survey.weight[0], survey.weight[1]);
}

TEST(FieldSurvey, PutsNorthInTheMiddleOfTwoPlaces) {
  FieldSurvey survey;
  survey.turn = 0.06;
  // Field at rest and in motion lie alike on both sides of it.
  EXPECT_DOUBLE_EQ(RestAzimuth(survey), -0.03);
  EXPECT_DOUBLE_EQ(RestAzimuth(survey) + survey.turn, 0.03);
  EXPECT_DOUBLE_EQ(NorthSigma(survey), 0.03);
}

/// Two readings of north with variances s^2 + v and s^2, s^2 = turn^2 / 2.
TEST(FieldSurvey, TrustsAFieldInMotionMoreIfIronTravelsAlong) {
  FieldSurvey survey;
  survey.turn = 0.06;
  survey.iron_variance = 0.0054;
  const double place = 0.0018;
  const double rest = place + survey.iron_variance;
  const double weight = (1.0 / place) / (1.0 / place + 1.0 / rest);
  EXPECT_NEAR(RestAzimuth(survey), -0.06 * weight, 1e-15);
  EXPECT_NEAR(NorthSigma(survey), std::sqrt(1.0 / (1.0 / place + 1.0 / rest)),
              1e-15);
  survey.turn = 0.0;
  EXPECT_EQ(RestAzimuth(survey), 0.0);
  EXPECT_EQ(NorthSigma(survey), 0.0);
}

/// Whatever the scale of the readings.
TEST(FieldSurvey, ADipThatIsNotTheStatedOneTurnsNorthAsMuch) {
  constexpr double kDip = 1.1;
  constexpr double kOff = 0.05;
  const auto of_dip = [](double dip) {
    MagneticSurroundings stated;
    stated.horizontal = 45.0 * std::cos(dip);
    stated.down = 45.0 * std::sin(dip);
    return stated;
  };
  for (const double norm : {45.0, 4.5}) {
    FieldSurvey survey;
    survey.horizontal = norm * std::cos(kDip + kOff);
    survey.down = norm * std::sin(kDip + kOff);
    const double across = norm * std::sin(kOff);
    EXPECT_NEAR(PlaceSigma(survey, of_dip(kDip)), across / survey.horizontal,
                1e-12);
    EXPECT_NEAR(PlaceSigma(survey, of_dip(kDip + kOff)), 0.0, 1e-12);
  }
}

TEST(FieldSurvey, SpreadsIronOverThreeAxes) {
  const FieldSurvey survey =
      SurveyField(InMotion(Eigen::Vector3d::Zero(), 100), {.weak_iron = 3.0});
  const double part = 3.0 / survey.horizontal;
  EXPECT_NEAR(survey.iron_variance, part * part / 3.0, 1e-12);
}

}  // namespace
}  // namespace hindsight
