#include "filters/side_agreement.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "base/chi_square.h"
#include "filters/forward_filter.h"
#include "filters/rts.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

TestProblem Ride(std::uint64_t seed) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.errors = true;
  return MakeProblem(options, seed);
}

LinearTape TapeAbout(const TestProblem& problem) {
  Problem posed = problem.Pose();
  return RunLinearizedFilter(problem.truth, &posed);
}

std::vector<SideAgreement> SidesOf(const LinearTape& tape,
                                   std::span<const std::size_t> onsets) {
  const ShiftColumns none{[](std::size_t, const TapeMeasurement&) {
    return std::vector<ShiftColumns::Columns>();
  }};
  return AgreementOfSides(tape, ScoreShifts(tape, none, onsets).states);
}

/// sqrt(d' C^-1 d) of a block.
double Distance(const Eigen::VectorXd& d, const Eigen::MatrixXd& C,
                const Block& block) {
  const auto at = Eigen::seqN(block.offset, block.dim);
  const Eigen::VectorXd own = d(at);
  const Eigen::MatrixXd covariance = C(at, at);
  return std::sqrt(own.dot(covariance.inverse() * own));
}

TEST(SideAgreement, IsThatOfTheSmootherAndWhatTheBackwardFilterKnows) {
  const TestProblem problem = Ride(2);
  const LinearTape tape = TapeAbout(problem);
  const SmoothedTrajectory smoothed = SmoothRts(TapeAbout(problem));
  const std::vector<std::size_t> onsets = {0, 9};
  int compared = 0;
  for (const SideAgreement& one : SidesOf(tape, onsets)) {
    ASSERT_EQ(one.epoch, 9u);
    ASSERT_EQ(one.dof, 3);
    const Block& block = *tape.layout().Find(one.block);
    const Eigen::MatrixXd P = tape.P_minus(9);
    const Eigen::MatrixXd P_s = smoothed.P.Get(9);
    const Eigen::VectorXd x_s = smoothed.d[9] - tape.epoch(9).dx_minus;
    if (one.of == SideAgreement::Of::kFilterAndSmoother) {
      const double expected = Distance(x_s, P - P_s, block);
      EXPECT_NEAR(one.distance, expected, 1e-4 * expected);
    } else {
      // P_s^-1 = P^-1 + P_b^-1, P_s^-1 x_s = P_b^-1 x_b about the prediction.
      const Eigen::MatrixXd information = P_s.inverse() - P.inverse();
      const Eigen::MatrixXd P_b = information.inverse();
      const Eigen::VectorXd x_b = P_b * (P_s.inverse() * x_s);
      const double expected = Distance(x_b, P + P_b, block);
      EXPECT_NEAR(one.distance, expected, 1e-3 * expected);
    }
    ++compared;
  }
  EXPECT_EQ(compared, 6);
}

TEST(SideAgreement, OfARightSystemIsChiSquare) {
  constexpr int kRuns = 60;
  const std::vector<std::size_t> onsets = {0, 5, 12};
  std::vector<double> squares(12);
  for (int run = 0; run < kRuns; ++run) {
    const std::vector<SideAgreement> all =
        SidesOf(TapeAbout(Ride(300 + static_cast<unsigned>(run))), onsets);
    ASSERT_EQ(all.size(), squares.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_EQ(all[i].dof, 3);
      squares[i] += all[i].distance * all[i].distance;
    }
  }
  const double tail = 0.005 / static_cast<double>(squares.size());
  for (const double sum : squares) {
    EXPECT_GT(sum, ChiSquareQuantile(tail, 3.0 * kRuns));
    EXPECT_LT(sum, ChiSquareQuantile(1.0 - tail, 3.0 * kRuns));
  }
}

/// The last fix but one knows what none after it does.
TEST(SideAgreement, LeavesOutWhatTheOtherSideDoesNotKnow) {
  TestProblem problem = Ride(4);
  const double last = problem.nodes[10].t + 1e-9;
  std::erase_if(problem.measurements,
                [last](const Measurement& z) { return z.t > last; });
  for (Node& node : problem.nodes) {
    if (node.t > last) node.measurement_count = 0;
  }
  const std::vector<std::size_t> onsets = {0, 15};
  EXPECT_TRUE(SidesOf(TapeAbout(problem), onsets).empty());
}

}  // namespace
}  // namespace hindsight
