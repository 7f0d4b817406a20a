#include "dataset/truth_start.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/units.h"

namespace hindsight {
namespace {

/// Heading east, turning to the right at 0.1 rad/s; the truth speaks of a point
/// 2 m ahead, which the turn moves to the south at 0.2 m/s. Its second point is
/// the first inside the record.
Dataset TurningOnTheSpot() {
  Dataset dataset;
  for (int k = 0; k <= 200; ++k) {
    dataset.imu.samples.push_back(
        {0.01 * k, {0.0, 0.0, 0.1}, {0.0, 0.0, -kStandardGravity}});
  }
  for (const double t : {-0.5, 0.5, 1.5}) {
    TruthPoint point;
    point.t = t;
    point.p_e = EcefFromGeodetic({0.6, 0.2, -15.0});
    point.v_n = Eigen::Vector3d(-0.2, 1.0, t);
    point.q_nb = QuaternionFromEuler(0.0, 0.0, 90.0 * kDegree);
    dataset.truth.push_back(point);
  }
  dataset.truth_lever_arm_b = {2.0, 0.0, 0.0};
  return dataset;
}

TEST(TruthStart, StartIsTheImusAtTheFirstPointInside) {
  Dataset dataset = TurningOnTheSpot();
  StartFromTruth(&dataset);
  const InitialState& initial = dataset.initial;
  EXPECT_EQ(initial.t, 0.5);
  const Eigen::Vector3d p_e = *dataset.truth[1].p_e;
  const Eigen::Vector3d d_n =
      NedAxes(p_e).transpose() * (EcefFromGeodetic(*initial.position) - p_e);
  EXPECT_LT((d_n - Eigen::Vector3d(0.0, -2.0, 0.0)).norm(), 1e-6);
  EXPECT_LT((*initial.v_n - Eigen::Vector3d(0.0, 1.0, 0.5)).norm(), 1e-9);
  EXPECT_NEAR(initial.euler->z(), 90.0 * kDegree, 1e-12);
}

TEST(TruthStart, WhatIsGivenStays) {
  Dataset dataset = TurningOnTheSpot();
  dataset.initial.t = 1.0;
  dataset.initial.heading = 1.5;
  dataset.initial.v_n = Eigen::Vector3d(1.0, 2.0, 3.0);
  StartFromTruth(&dataset);
  EXPECT_EQ(dataset.initial.t, 1.5);
  EXPECT_EQ(*dataset.initial.v_n, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_FALSE(dataset.initial.euler);
  EXPECT_TRUE(dataset.initial.position);
  dataset.initial.t = 1.8;
  EXPECT_THROW(StartFromTruth(&dataset), InputError);
}

}  // namespace
}  // namespace hindsight
