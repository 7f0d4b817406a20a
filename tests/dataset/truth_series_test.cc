#include <gtest/gtest.h>

#include "dataset/dataset.h"

namespace hindsight {
namespace {

TEST(TruthSeries, WhatIsAbsentStaysAbsent) {
  TruthSeries series;
  for (int k = 0; k < 64; ++k) {
    TruthPoint point;
    point.t = 0.1 * k;
    const Eigen::Vector3d v(0.3 * k, -k, 1e-300);
    if (k & 1) point.p_e = v;
    if (k & 2) point.v_n = v;
    if (k & 4) point.q_nb = Eigen::Quaterniond(v.x(), v.y(), v.z(), 1.0);
    if (k & 8) point.moving = (k & 1) != 0;
    if (k & 16) point.b_g = v;
    if (k & 32) point.b_a = v;
    series.push_back(point);
  }
  int k = 0;
  for (const TruthPoint& point : series) {
    const Eigen::Vector3d v(0.3 * k, -k, 1e-300);
    EXPECT_EQ(point.t, 0.1 * k);
    EXPECT_EQ(point.p_e.has_value(), (k & 1) != 0);
    EXPECT_EQ(point.v_n.has_value(), (k & 2) != 0);
    EXPECT_EQ(point.q_nb.has_value(), (k & 4) != 0);
    EXPECT_EQ(point.moving.has_value(), (k & 8) != 0);
    EXPECT_EQ(point.b_g.has_value(), (k & 16) != 0);
    EXPECT_EQ(point.b_a.has_value(), (k & 32) != 0);
    EXPECT_EQ(point.p_e.value_or(v), v);
    EXPECT_EQ(point.v_n.value_or(v), v);
    EXPECT_EQ(point.b_g.value_or(v), v);
    EXPECT_EQ(point.b_a.value_or(v), v);
    if (point.q_nb) {
      EXPECT_EQ(point.q_nb->coeffs(),
                Eigen::Vector4d(v.y(), v.z(), 1.0, v.x()));
    }
    if (point.moving) {
      EXPECT_EQ(*point.moving, (k & 1) != 0);
    }
    ++k;
  }
}

}  // namespace
}  // namespace hindsight
