#include "evaluation/distrust.h"

#include <gtest/gtest.h>

#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

class Distrust : public ::testing::Test {
 protected:
  /// A receiver and another one at 1 Hz for 100 s; of the first the weights of
  /// [begin, end) are `weight`.
  void Distrusted(int begin, int end, double weight, double nis_beside = 3.0,
                  bool with_other = false) {
    for (int t = 0; t < 100; ++t) {
      const bool distrusted = t >= begin && t < end;
      Add(t, 0, distrusted ? weight : 1.0, distrusted ? 90.0 : nis_beside);
      if (with_other) Add(t, 1, 1.0, 3.0);
    }
  }

  void Add(double t, int sensor, double weight, double nis) {
    ResidualRecord record;
    record.t = t;
    record.sensor = sensor;
    record.accepted = weight > 0.0;
    record.weight = weight;
    record.nis = nis;
    record.residual = RowVector::Zero(3);
    solution_.residuals.push_back(record);
  }

  std::vector<Evidence> Find() const {
    std::vector<Sensor> sensors(2);
    sensors[0].name = "gnss";
    sensors[1].name = "other";
    std::vector<Evidence> evidence;
    FindDistrusted({.solution = solution_, .sensors = sensors}, &evidence);
    return evidence;
  }

  Solution solution_;
};

TEST_F(Distrust, OfASensorThatAgreedBeforeAndAfterIsDoubtful) {
  solution_.modes.emplace();
  Distrusted(40, 60, 0.01);
  const std::vector<Evidence> found = Find();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].grade, Grade::kDoubtful);
  EXPECT_EQ(found[0].what,
            "20 measurements of gnss were distrusted from 40.0 s to 59.0 s, "
            "which agreed with everything else before and after");
}

TEST_F(Distrust, ByAGateIsHeardToo) {
  Distrusted(40, 60, 0.0);
  EXPECT_EQ(Find().size(), 1u);
}

TEST_F(Distrust, ForAShortTimeOrInPartIsNone) {
  Distrusted(40, 50, 0.01);
  EXPECT_TRUE(Find().empty());
  solution_.residuals.clear();
  Distrusted(40, 60, 0.2);
  EXPECT_TRUE(Find().empty());
}

TEST_F(Distrust, OfASensorThatDidNotAgreeBesideSaysNothing) {
  Distrusted(40, 60, 0.01, 20.0);
  EXPECT_TRUE(Find().empty());
  solution_.residuals.clear();
  Distrusted(0, 60, 0.01);
  EXPECT_TRUE(Find().empty());
}

TEST_F(Distrust, IsNotHeardWhereAnotherReceiverVouches) {
  Distrusted(40, 60, 0.01, 3.0, true);
  EXPECT_TRUE(Find().empty());
}

/// What passes a gate by chance does not end a stretch of distrust.
TEST_F(Distrust, WithSomeTrustedBetweenIsHeard) {
  for (int t = 0; t < 100; ++t) {
    const bool distrusted = t >= 40 && t < 60 && t % 5 < 3;
    Add(t, 0, distrusted ? 0.0 : 1.0, distrusted ? 90.0 : 3.0);
  }
  const std::vector<Evidence> found = Find();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].what,
            "12 measurements of gnss were distrusted from 40.0 s to 57.0 s, "
            "which agreed with everything else before and after");
}

/// As spikes are refused.
TEST_F(Distrust, OfLessThanHalfIsNone) {
  for (int t = 0; t < 200; ++t) {
    const bool distrusted = t >= 40 && t < 160 && t % 3 == 0;
    Add(t, 0, distrusted ? 0.0 : 1.0, distrusted ? 90.0 : 3.0);
  }
  EXPECT_TRUE(Find().empty());
}

/// A point of reference says where one is at its time, not for the rest.
TEST_F(Distrust, IsHeardWhereAnotherReceiverVouchesOnceOnly) {
  Distrusted(40, 60, 0.01);
  Add(45.0, 1, 1.0, 3.0);
  EXPECT_EQ(Find().size(), 1u);
  Add(51.0, 1, 1.0, 3.0);
  EXPECT_TRUE(Find().empty());
}

TEST_F(Distrust, IsNotHeardOfASensorWhoseErrorIsAState) {
  Distrusted(40, 60, 0.01);
  const ErrorLayout without = solution_.layout;
  for (const BlockKind kind :
       {BlockKind::kColouredNoise, BlockKind::kSensorError}) {
    Block error;
    error.key = {kind, 0};
    error.name = "gnss_error";
    solution_.layout = without;
    solution_.layout.Add(error);
    EXPECT_TRUE(Find().empty());
  }
}

}  // namespace
}  // namespace hindsight
