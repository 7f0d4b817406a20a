#include "filters/mean_shift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/chi_square.h"
#include "filters/forward_filter.h"
#include "filters/rts.h"
#include "filters/shift_response.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

constexpr int kPositions = 0;

TestProblem Drive(std::uint64_t seed) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.errors = true;
  return MakeProblem(options, seed);
}

/// Errors of the components of what each sensor measures.
ShiftColumns Additive() {
  return {[](std::size_t, const TapeMeasurement& z) {
    return std::vector<ShiftColumns::Columns>{
        {z.sensor, Eigen::Matrix3d::Identity()}};
  }};
}

LinearTape TapeOf(const TestProblem& problem) {
  Problem posed = problem.Pose();
  return RunLinearizedFilter(problem.truth, &posed);
}

/// The fixes too far north by a metre, or by a metre more each second, from
/// epoch `onset` on.
TestProblem Shifted(TestProblem problem, std::size_t onset, bool grows) {
  const double t0 = problem.nodes[onset].t;
  for (Measurement& z : problem.measurements) {
    auto* fix = std::get_if<PositionFix>(&z.model);
    if (fix == nullptr || z.t < t0 - 1e-9) continue;
    const double size = grows ? z.t - t0 : 1.0;
    fix->p_e += NedAxes(fix->p_e) * Eigen::Vector3d(size, 0.0, 0.0);
  }
  return problem;
}

MeanShift Find(const std::vector<MeanShift>& all, std::size_t onset,
               bool grows) {
  for (const MeanShift& shift : all) {
    if (!shift.of_state && shift.group == kPositions && shift.column == 0 &&
        shift.onset == onset && shift.grows == grows) {
      return shift;
    }
  }
  throw std::out_of_range("no such shift");
}

class MeanShiftOfFixes
    : public ::testing::TestWithParam<std::pair<std::size_t, bool>> {};

TEST_P(MeanShiftOfFixes, IsWhatChangesWithTheMeasurements) {
  const auto [onset, grows] = GetParam();
  const TestProblem problem = Drive(3);
  const LinearTape before = TapeOf(problem);
  const LinearTape after = TapeOf(Shifted(problem, onset, grows));
  const std::vector<std::size_t> onsets = {0, 7, 12};
  const MeanShift was =
      Find(ScoreShifts(before, Additive(), onsets).shifts, onset, grows);
  const MeanShift is =
      Find(ScoreShifts(after, Additive(), onsets).shifts, onset, grows);
  // Its own innovations are what it adds, so that its size grows by one.
  EXPECT_NEAR(is.information, was.information, 1e-6 * was.information);
  EXPECT_NEAR(is.size() - was.size(), 1.0, 1e-5);

  const Eigen::MatrixXd correction = CorrectionFor(was, before, Additive());
  const SmoothedTrajectory a = SmoothMeans(before);
  const SmoothedTrajectory b = SmoothMeans(after);
  for (std::size_t k = 0; k < a.d.size(); ++k) {
    const ErrorVector moved = b.d[k] - a.d[k];
    EXPECT_TRUE(
        moved.isApprox(-correction.col(static_cast<Eigen::Index>(k)), 1e-5))
        << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Onsets, MeanShiftOfFixes,
                         ::testing::Values(std::pair(0, false),
                                           std::pair(0, true),
                                           std::pair(7, false),
                                           std::pair(12, true)));

/// The score and the information as they are defined: by the innovations that a
/// jump of the state causes, carried forward.
TEST(MeanShift, OfTheStateIsTheSumOverItsInnovations) {
  const LinearTape tape = TapeOf(Drive(5));
  constexpr std::size_t kOnset = 4;
  const std::vector<std::size_t> onsets = {0, kOnset};
  int compared = 0;
  for (const MeanShift& shift : ScoreShifts(tape, Additive(), onsets).shifts) {
    if (!shift.of_state) continue;
    ErrorVector e = ErrorVector::Zero(tape.dim());
    e(shift.column) = 1.0;
    double score = 0.0, information = 0.0;
    for (std::size_t k = kOnset; k < tape.size(); ++k) {
      if (k > kOnset) e = tape.Phi(k) * e;
      ErrorMatrix P = tape.P_minus(k);
      for (const TapeMeasurement& z : tape.measurements(k)) {
        const Eigen::MatrixXd S_inverse = z.S.inverse();
        const Eigen::VectorXd g = z.H * e;
        score += g.dot(S_inverse * z.innovation);
        information += g.dot(S_inverse * g);
        const Eigen::MatrixXd K = P * z.H.transpose() * S_inverse;
        e -= K * g;
        P -= K * z.H * P;
      }
    }
    EXPECT_NEAR(shift.information, information, 1e-6 * information);
    EXPECT_NEAR(shift.score, score, 1e-6 * std::sqrt(information));
    ++compared;
  }
  EXPECT_EQ(compared, tape.dim());
}

TEST(MeanShift, OfARightSystemIsNormal) {
  constexpr int kRuns = 60;
  const std::vector<std::size_t> onsets = {0, 6, 14};
  std::vector<double> squares;
  constexpr double kTail = 0.2;
  int beyond = 0;
  double whitened = 0.0, dofs = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const LinearTape tape = TapeOf(Drive(100 + static_cast<unsigned>(run)));
    const std::vector<MeanShift> all =
        ScoreShifts(tape, Additive(), onsets).shifts;
    squares.resize(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      squares[i] += all[i].z() * all[i].z();
    }
    const std::vector<int> wanted = {2, 0};
    const GroupEnergy all_energy =
        EnergiesOf(kPositions, wanted, onsets, tape, Additive());
    whitened += all_energy.whitened;
    dofs += all_energy.dof;
    for (const ShiftEnergy& energy : all_energy.columns) {
      if (energy.sum > WeightedChiSquareQuantile(energy.weights, kTail)) {
        ++beyond;
      }
    }
  }
  ASSERT_GT(squares.size(), 60u);
  // Each is chi^2 of as many degrees of freedom as runs; one of all is outside
  // once in a hundred.
  const double tail = 0.005 / static_cast<double>(squares.size());
  for (const double sum : squares) {
    EXPECT_GT(sum, ChiSquareQuantile(tail, kRuns));
    EXPECT_LT(sum, ChiSquareQuantile(1.0 - tail, kRuns));
  }
  EXPECT_DOUBLE_EQ(dofs, 2.0 * 3.0 * kRuns);
  EXPECT_GT(whitened, ChiSquareQuantile(0.005, dofs));
  EXPECT_LT(whitened, ChiSquareQuantile(0.995, dofs));
  // Binomial of 120, within three standard deviations.
  EXPECT_NEAR(beyond, 2 * kRuns * kTail,
              3.0 * std::sqrt(2 * kRuns * kTail * (1.0 - kTail)));
}

TEST(MeanShift, OfStepsIsTheSumOfItsSteps) {
  const LinearTape tape = TapeOf(Drive(9));
  const std::vector<std::size_t> onsets = {0, 7, 12};
  const std::vector<MeanShift> all =
      ScoreShifts(tape, Additive(), onsets).shifts;
  const Eigen::MatrixXd a =
      CorrectionFor(Find(all, 7, false), tape, Additive());
  const Eigen::MatrixXd b =
      CorrectionFor(Find(all, 12, false), tape, Additive());
  const std::vector<int> wanted = {0};
  const Eigen::MatrixXd steps = Eigen::Vector3d(0.0, 1.5, -2.0);
  const Eigen::MatrixXd both =
      CorrectionForSteps(kPositions, wanted, onsets, steps, tape, Additive());
  ASSERT_EQ(both.cols(), static_cast<Eigen::Index>(tape.size()));
  for (Eigen::Index k = 0; k < both.cols(); ++k) {
    const ErrorVector sum = 1.5 * a.col(k) - 2.0 * b.col(k);
    EXPECT_LT((both.col(k) - sum).norm(), 1e-9 * (1.0 + sum.norm())) << k;
  }
}

TEST(MeanShift, FindsTheStepsOfAnErrorThatGoesAgain) {
  constexpr double kError = 1.0;  // twenty sigmas of a fix [m]
  TestProblem problem = Drive(9);
  for (Measurement& z : problem.measurements) {
    auto* fix = std::get_if<PositionFix>(&z.model);
    if (fix == nullptr || z.t < problem.nodes[7].t - 1e-9 ||
        z.t > problem.nodes[12].t - 1e-9) {
      continue;
    }
    fix->p_e += NedAxes(fix->p_e) * Eigen::Vector3d(kError, 0.0, 0.0);
  }
  const std::vector<std::size_t> onsets = {0, 7, 12};
  const std::vector<int> wanted = {0};
  const GroupEnergy energy =
      EnergiesOf(kPositions, wanted, onsets, TapeOf(problem), Additive());
  EXPECT_GT(energy.columns[0].sum,
            WeightedChiSquareQuantile(energy.columns[0].weights, 1e-6));
  EXPECT_GT(energy.whitened, ChiSquareQuantile(1.0 - 1e-6, energy.dof));
  ASSERT_EQ(energy.steps.rows(), 3);
  EXPECT_NEAR(energy.steps(1, 0), kError, 0.2 * kError);
  EXPECT_NEAR(energy.steps(2, 0), -kError, 0.2 * kError);
}

/// The fixes end before the last onset: those that nothing shows are left out.
TEST(MeanShift, VariesOverTheOnsetsThatSomethingFollows) {
  TestProblem problem = Drive(7);
  const double last = problem.nodes[12].t + 1e-9;
  std::erase_if(problem.measurements, [last](const Measurement& z) {
    return z.sensor == kPositions && z.t > last;
  });
  int first = 0;
  for (Node& node : problem.nodes) {
    node.first_measurement = first;
    node.measurement_count = node.t > last ? 1 : 2;
    first += node.measurement_count;
  }
  const LinearTape tape = TapeOf(problem);
  const std::vector<int> wanted = {0};
  const std::vector<std::size_t> all = {0, 6, 16}, those = {0, 6};
  const GroupEnergy a = EnergiesOf(kPositions, wanted, all, tape, Additive());
  const GroupEnergy b = EnergiesOf(kPositions, wanted, those, tape, Additive());
  // What spans between onsets do is added up in another order.
  constexpr double kRounding = 1e-11;
  EXPECT_GT(b.columns[0].sum, 0.0);
  EXPECT_NEAR(a.columns[0].sum, b.columns[0].sum, kRounding);
  ASSERT_EQ(a.columns[0].weights.size(), b.columns[0].weights.size());
  for (std::size_t i = 0; i < b.columns[0].weights.size(); ++i) {
    EXPECT_NEAR(a.columns[0].weights[i], b.columns[0].weights[i], kRounding);
  }
  EXPECT_NEAR(a.whitened, b.whitened, kRounding);
  EXPECT_EQ(a.dof, b.dof);
  EXPECT_TRUE(a.steps.topRows(2).isApprox(b.steps));
  EXPECT_EQ(a.steps(2, 0), 0.0);
}

TEST(MeanShift, NeedsATapeAboutAFixedNominal) {
  const TestProblem problem = Drive(3);
  Problem posed = problem.Pose();
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  const std::vector<std::size_t> onsets = {0};
  EXPECT_THROW(ScoreShifts(tape, Additive(), onsets), std::logic_error);
}

TEST(MeanShift, OnsetsAreSpreadOverTheRecording) {
  const TestProblem problem = Drive(41);
  const LinearTape tape = TapeOf(problem);
  const std::vector<std::size_t> onsets = SpreadOnsets(tape, 8);
  ASSERT_EQ(onsets.size(), 8u);
  const double step = (tape.back().t - tape.t(0)) / 8.0;
  for (std::size_t i = 0; i < onsets.size(); ++i) {
    const double wanted = tape.t(0) + static_cast<double>(i) * step;
    EXPECT_GE(tape.t(onsets[i]), wanted - 1e-9);
    if (onsets[i] > 0) EXPECT_LT(tape.t(onsets[i] - 1), wanted);
  }
  // More than there are epochs: each of them.
  EXPECT_EQ(SpreadOnsets(tape, 1 << 20).size(), tape.size());
}

}  // namespace
}  // namespace hindsight
