#include "evaluation/broad_metric.h"

#include <gtest/gtest.h>

#include "base/units.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

TEST(BroadMetric, SeparatesHeadingFromInclination) {
  const Eigen::Quaterniond reference = QuaternionFromEuler(0.3, -0.8, 2.0);
  const BroadError heading =
      BroadErrorOf(Exp(Eigen::Vector3d(0.0, 0.0, 0.1)) * reference, reference);
  EXPECT_NEAR(heading.total, 0.1, 1e-12);
  EXPECT_NEAR(heading.heading, 0.1, 1e-12);
  EXPECT_NEAR(heading.inclination, 0.0, 1e-7);
  const BroadError tilt = BroadErrorOf(
      Exp(Eigen::Vector3d(0.03, -0.04, 0.0)) * reference, reference);
  EXPECT_NEAR(tilt.total, 0.05, 1e-12);
  EXPECT_NEAR(tilt.heading, 0.0, 1e-12);
  EXPECT_NEAR(tilt.inclination, 0.05, 1e-12);
}

TEST(BroadMetric, DoesNotDependOnTheSignOfTheQuaternion) {
  const Eigen::Quaterniond q = Exp(Eigen::Vector3d(0.1, 0.2, 0.3));
  const Eigen::Quaterniond minus(-q.w(), -q.x(), -q.y(), -q.z());
  const Eigen::Quaterniond one = Eigen::Quaterniond::Identity();
  EXPECT_NEAR(BroadErrorOf(q, one).total, BroadErrorOf(minus, one).total,
              1e-12);
  EXPECT_NEAR(BroadErrorOf(q, one).heading, BroadErrorOf(minus, one).heading,
              1e-12);
}

TEST(BroadMetric, CountsOnlyMotionWithAReference) {
  SolutionTable table;
  TruthSeries truth;
  for (int k = 0; k < 10; ++k) {
    table.t.push_back(0.1 * k);
    table.q_eb.push_back(Exp(Eigen::Vector3d(0.0, 0.0, k < 5 ? 0.2 : 0.1)));
    TruthPoint point;
    point.t = 0.1 * k;
    point.moving = k >= 5;
    if (k != 7) point.q_nb = Eigen::Quaterniond::Identity();
    truth.push_back(point);
  }
  const BroadMetric metric = EvaluateBroad(table, truth);
  EXPECT_EQ(metric.count, 4U);
  EXPECT_NEAR(metric.rms.total, 0.1, 1e-9);
  EXPECT_NEAR(metric.rms.heading, 0.1, 1e-9);
}

}  // namespace
}  // namespace hindsight
