#include "evaluation/state_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "earth/wgs84.h"

namespace hindsight {
namespace {

constexpr double kSigma = 0.5;

/// At rest, with truth of all that a layout can have, or of what attitude alone
/// has.
Dataset TruthAt(const std::vector<double>& times, bool attitude_alone = false) {
  Dataset dataset;
  for (const double t : times) {
    TruthPoint point;
    point.t = t;
    point.q_nb = Eigen::Quaterniond::Identity();
    point.b_g = Eigen::Vector3d::Zero();
    if (!attitude_alone) {
      point.p_e = EcefFromGeodetic({0.8, 0.2, 100.0});
      point.v_n = Eigen::Vector3d::Zero();
      point.b_a = Eigen::Vector3d::Zero();
    }
    dataset.truth.push_back(point);
  }
  return dataset;
}

/// A state whose truth is north by that distance [m], and turned about down.
State Off(double t, double north, double yaw) {
  State x = MakeState(t, {0.8, 0.2, 100.0}, Eigen::Vector3d::Zero(),
                      {0.0, 0.0, -yaw});
  x.p_e -= x.C_en() * Eigen::Vector3d(north, 0.0, 0.0);
  return x;
}

/// Every component known to kSigma.
Solution Estimate(const ErrorLayout& layout, const std::vector<State>& states) {
  Solution solution;
  solution.layout = layout;
  solution.states = states;
  const int dim = layout.dim();
  solution.covariances = CovarianceSeries(dim, states.size());
  for (std::size_t k = 0; k < states.size(); ++k) {
    solution.covariances.Set(
        k, ErrorMatrix(kSigma * kSigma * ErrorMatrix::Identity(dim, dim)));
  }
  return solution;
}

TEST(StateErrors, AreTruthLessEstimateAgainstTheirCovariance) {
  const ErrorLayout layout = NavigationLayout({});
  const std::vector<State> states = {Off(0.0, 1.0, 0.0), Off(1.0, 3.0, 0.1),
                                     Off(2.0, 0.0, 0.0)};
  const StateErrors errors =
      ErrorsOf(TruthAt({0.0, 1.0, 2.0}), Estimate(layout, states));
  ASSERT_EQ(errors.t.size(), 3u);
  EXPECT_EQ(errors.states, layout.dim());
  EXPECT_NEAR(errors.position.Component(0)[1], 3.0, 1e-6);
  EXPECT_NEAR(errors.position.Component(1)[1], 0.0, 1e-6);
  EXPECT_NEAR(errors.position.Norms()[0], 1.0, 1e-6);
  EXPECT_NEAR(errors.position.nees[0], 4.0, 1e-5);
  EXPECT_NEAR(errors.attitude.Component(2)[1], 0.1, 1e-6);
  EXPECT_NEAR(errors.yaw[1], 0.1, 1e-6);
  EXPECT_NEAR(errors.nees[1], (9.0 + 0.01) / (kSigma * kSigma), 1e-4);
  // 3 m are six sigmas, one component of nine.
  EXPECT_NEAR(errors.position.ShareInside(5.0), 8.0 / 9.0, 1e-12);
  EXPECT_NEAR(errors.ShareBeyond(5.0), 1.0 / 3.0, 1e-12);
}

TEST(StateErrors, OfALayoutWithoutHeightAreHorizontal) {
  const ErrorLayout full = NavigationLayout({});
  ErrorLayout layout;
  for (Block block : full.blocks()) {
    if (block.key.kind == BlockKind::kPosition) block.active[2] = false;
    layout.Add(block);
  }
  const StateErrors errors =
      ErrorsOf(TruthAt({0.0}), Estimate(layout, {Off(0.0, 1.0, 0.0)}));
  EXPECT_TRUE(errors.position.e.empty());
  EXPECT_NEAR(errors.horizontal.Component(0)[0], 1.0, 1e-6);
  EXPECT_NEAR(errors.horizontal.nees[0], 4.0, 1e-5);
  EXPECT_EQ(errors.attitude.e.size(), 1u);
}

TEST(StateErrors, AreOfTheStatesThatAreAsked) {
  const ErrorLayout layout = NavigationLayout({});
  const Solution solution = Estimate(
      layout, {Off(0.0, 1.0, 0.0), Off(1.0, 2.0, 0.0), Off(2.0, 3.0, 0.0)});
  const Dataset truth = TruthAt({0.0, 2.0});
  EXPECT_NEAR(ErrorsOf(truth, solution, 2).position.Norms()[1], 3.0, 1e-6);
  EXPECT_TRUE(ErrorsOf(truth, solution, std::vector<std::size_t>{}).t.empty());
  EXPECT_THROW(ErrorsOf(truth, solution), InputError);
}

/// Of attitude alone nobody need know the place.
TEST(StateErrors, NeedNoTruthOfWhatIsNotEstimated) {
  const ErrorLayout all = NavigationLayout({});
  ErrorLayout layout;
  layout.Add(*all.Find(BlockKind::kAttitude));
  layout.Add(*all.Find(BlockKind::kGyroBias));
  const StateErrors errors =
      ErrorsOf(TruthAt({0.0}, true), Estimate(layout, {Off(0.0, 1.0, 0.2)}));
  EXPECT_TRUE(errors.position.e.empty());
  EXPECT_NEAR(errors.attitude.Norms()[0], 0.2, 1e-6);
  EXPECT_NEAR(errors.nees[0], 0.04 / (kSigma * kSigma), 1e-5);
}

}  // namespace
}  // namespace hindsight
