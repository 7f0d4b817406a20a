#include "state/state.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include "base/random.h"
#include "base/units.h"
#include "state/covariance_series.h"

namespace hindsight {
namespace {

using Eigen::Vector3d;

ErrorLayout FullLayout() {
  ErrorLayout layout = NavigationLayout({});
  const auto add = [&layout](BlockKind kind, const char* name,
                             std::array<bool, 3> active) {
    Block block;
    block.key = {kind, 0};
    block.name = name;
    block.active = active;
    layout.Add(block);
  };
  add(BlockKind::kScale, "scale", {true, true, true});
  add(BlockKind::kLeverArm, "lever_arm", {true, false, true});
  add(BlockKind::kColouredNoise, "noise", {true, true, true});
  return layout;
}

/// Ordinary places, both poles to the micrometre and the date line.
std::vector<State> Places() {
  std::vector<State> states;
  for (const Geodetic& g :
       {Geodetic{0.8, 0.2, 100.0}, Geodetic{kPi / 2, 0.0, 0.0},
        Geodetic{-kPi / 2, 0.0, 3000.0}, Geodetic{kPi / 2 - 1e-12, 2.0, 0.0},
        Geodetic{-0.3, kPi - 1e-10, 0.0}, Geodetic{0.0, -kPi + 1e-10, -50.0}}) {
    State x = MakeState(0.0, g, {12.0, -7.0, 0.5}, {0.1, -0.2, 2.5});
    x.parameters.setZero(FullLayout().parameter_count());
    states.push_back(x);
  }
  return states;
}

/// An error of some metres, m/s and tenths of a radian.
ErrorVector RandomError(const ErrorLayout& layout, Random* random) {
  ErrorVector d(layout.dim());
  for (int i = 0; i < d.size(); ++i) d(i) = 5.0 * random->Normal();
  if (const Block* attitude = layout.Find(BlockKind::kAttitude)) {
    d.segment(attitude->offset, attitude->dim) *= 0.1;
  }
  return d;
}

TEST(State, MadeFromWhatPeopleUse) {
  // At latitude 0, longitude 90 deg: north is z, east is -x, down is -y.
  const State x = MakeState(3.0, {0.0, kPi / 2, 10.0}, {1.0, 2.0, 3.0},
                            {0.0, 0.0, kPi / 2});
  EXPECT_EQ(x.t, 3.0);
  EXPECT_LT((x.p_e - Vector3d(0.0, kEarthSemiMajorAxis + 10.0, 0.0)).norm(),
            2e-9);
  EXPECT_LT((x.v_e - Vector3d(-2.0, -3.0, 1.0)).norm(), 1e-14);
  // Heading east: forward is -x.
  EXPECT_LT((x.q_eb * Vector3d::UnitX() - Vector3d(-1.0, 0.0, 0.0)).norm(),
            1e-15);
  EXPECT_LT((x.v_n() - Vector3d(1.0, 2.0, 3.0)).norm(), 1e-14);
  EXPECT_LT((x.euler() - Vector3d(0.0, 0.0, kPi / 2)).norm(), 1e-15);
}

TEST(State, ErrorsReadInNorthEastDown) {
  const ErrorLayout layout = NavigationLayout({});
  const State x =
      MakeState(0.0, {0.7, 0.3, 0.0}, Vector3d::Zero(), {0.0, 0.0, 0.4});
  ErrorVector d = ErrorVector::Zero(15);
  d(0) = 10.0;  // north
  d(2) = -2.0;  // up
  d(4) = 0.5;   // eastward velocity
  d(8) = 0.01;  // clockwise from above
  d(9) = 1e-5;
  d(14) = -1e-3;
  const State y = Retract(layout, x, d);
  const Geodetic g = GeodeticFromEcef(y.p_e);
  // The tangent leaves the ellipsoid by 10^2 / 2R = 8e-6 m.
  EXPECT_NEAR((g.latitude - 0.7) * MeridianRadius(0.7), 10.0, 1e-4);
  EXPECT_NEAR(g.height, 2.0, 1e-5);
  EXPECT_NEAR(y.v_n().y(), 0.5, 1e-5);
  EXPECT_NEAR(y.euler().z(), 0.41, 2e-6);
  EXPECT_EQ(y.b_g.x(), 1e-5);
  EXPECT_EQ(y.b_a.z(), -1e-3);
}

TEST(State, LocalInvertsRetractEverywhere) {
  const ErrorLayout layout = FullLayout();
  Random random(21);
  for (const State& x : Places()) {
    for (int i = 0; i < 5; ++i) {
      const ErrorVector d = RandomError(layout, &random);
      const State y = Retract(layout, x, d);
      const ErrorVector back = Local(layout, x, y);
      // A position of 6.4e6 m rounds to 1e-9 m.
      EXPECT_LT((back - d).head(3).norm(), 4e-9);
      EXPECT_LT((back - d).tail(layout.dim() - 3).norm(), 1e-13);
      EXPECT_NEAR(y.q_eb.norm(), 1.0, 1e-15);
    }
  }
}

TEST(State, RetractReachesTheStateThatLocalSaw) {
  // From one side of 180 deg, and of the pole, to the other.
  const State east =
      MakeState(0.0, {-0.3, kPi - 1e-6, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.1, 1.0});
  const State west = MakeState(0.0, {-0.3, -kPi + 1e-6, 0.0}, {1.0, 0.0, 0.0},
                               {0.0, 0.1, 1.0});
  const State before_pole = MakeState(0.0, {kPi / 2 - 1e-6, 0.5, 0.0},
                                      {100.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  const State after_pole = MakeState(0.0, {kPi / 2 - 1e-6, 0.5 - kPi, 0.0},
                                     {-100.0, 0.0, 0.0}, {0.0, 0.0, kPi});
  const ErrorLayout navigation = NavigationLayout({});
  for (const auto& [from, to, metres] :
       {std::tuple{east, west, 2e-6 * TransverseRadius(0.3) * std::cos(0.3)},
        std::tuple{before_pole, after_pole, 2e-6 * MeridianRadius(kPi / 2)}}) {
    const ErrorVector d = Local(navigation, from, to);
    EXPECT_NEAR(d.head(3).norm(), metres, 1e-4);
    // Straight on over the pole or the line: no jump in velocity or attitude.
    EXPECT_LT(d.segment(3, 6).norm(), 1e-3);
    const State back = Retract(navigation, from, d);
    EXPECT_LT((back.p_e - to.p_e).norm(), 2e-9);
    EXPECT_LT((back.v_e - to.v_e).norm(), 1e-13);
    EXPECT_LT(Log(back.q_eb * to.q_eb.conjugate()).norm(), 1e-15);
  }
}

TEST(State, MaskedAxesStayAsTheyAre) {
  const ErrorLayout layout = FullLayout();
  State x = Places().front();
  x.parameters << 0.1, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0;
  ErrorVector d = ErrorVector::Zero(layout.dim());
  d.tail(6) << 0.5, 10.0, 20.0, 1.0, 1.0, 1.0;
  const State y = Retract(layout, x, d);
  ParameterVector expected(7);
  expected << 0.6, 11.0, 2.0, 23.0, 5.0, 6.0, 7.0;
  EXPECT_LT((y.parameters - expected).norm(), 1e-14);
  State moved = y;
  moved.parameters(2) = 99.0;
  EXPECT_LT((Local(layout, x, moved) - d).norm(), 1e-14);
}

TEST(State, TakesNoRoomForParametersThatItsLayoutDoesNotHave) {
  // A day keeps hundreds of thousands: 17 numbers, a size, a place, alignment.
  EXPECT_LE(sizeof(State), 20 * sizeof(double));
  EXPECT_EQ(State().parameters.data(), nullptr);
}

TEST(State, ParametersFallBackWhereNotEstimated) {
  const ErrorLayout layout = FullLayout();
  State x = Places().front();
  x.parameters << 0.1, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0;
  EXPECT_EQ(Parameter1(layout, x, BlockKind::kScale, 0, 9.0), 0.1);
  EXPECT_EQ(Parameter1(layout, x, BlockKind::kScale, 1, 9.0), 9.0);
  EXPECT_EQ(Parameter3(layout, x, BlockKind::kLeverArm, 0, Vector3d::Zero()),
            Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(Parameter3(layout, x, BlockKind::kHardIron, 0, Vector3d::Ones()),
            Vector3d::Ones());
}

ErrorMatrix NumericTransport(const ErrorLayout& layout, const State& from,
                             const State& to) {
  const ErrorVector there = Local(layout, from, to);
  ErrorMatrix T(layout.dim(), layout.dim());
  for (int i = 0; i < layout.dim(); ++i) {
    // Long enough that rounding of positions (1e-9 m) does not show.
    const double step = i < 3 ? 1.0 : 1e-5;
    ErrorVector d = ErrorVector::Zero(layout.dim());
    d(i) = step;
    T.col(i) = (Local(layout, to, Retract(layout, from, there + d)) -
                Local(layout, to, Retract(layout, from, there - d))) /
               (2.0 * step);
  }
  return T;
}

TEST(Transport, MatchesNumericDifference) {
  const ErrorLayout layout = FullLayout();
  Random random(23);
  for (const State& from : Places()) {
    const State to = Retract(layout, from, RandomError(layout, &random));
    const ErrorMatrix T = Transport(layout, from, to);
    EXPECT_LT((T - NumericTransport(layout, from, to)).norm(), 2e-8);
  }
}

TEST(Transport, OfAMaskedLayoutDropsTheMaskedRowsAndColumns) {
  ErrorLayout full;
  ErrorLayout heading_only;
  Block attitude;
  attitude.key.kind = BlockKind::kAttitude;
  attitude.name = "attitude";
  full.Add(attitude);
  attitude.active = {false, false, true};
  heading_only.Add(attitude);
  const State from = Places().front();
  State to = from;
  to.q_eb = Exp(Vector3d(0.2, -0.1, 0.4)) * from.q_eb;
  const ErrorMatrix T = Transport(heading_only, from, to);
  ASSERT_EQ(T.rows(), 1);
  EXPECT_EQ(T(0, 0), Transport(full, from, to)(2, 2));
}

TEST(CovarianceSeries, KeepsSymmetricMatrices) {
  CovarianceSeries series(3, 2);
  Eigen::Matrix3d A;
  A << 4, 1, 2, 1, 5, 3, 2, 3, 6;
  series.Set(0, A);
  series.Set(1, Eigen::Matrix3d(2.0 * A));
  EXPECT_EQ(series.size(), 2u);
  EXPECT_EQ(Eigen::Matrix3d(series.Get(0)), A);
  EXPECT_EQ(Eigen::Matrix3d(series.Get(1)), 2.0 * A);
}

}  // namespace
}  // namespace hindsight
