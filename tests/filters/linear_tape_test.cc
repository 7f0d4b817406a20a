#include "filters/linear_tape.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "filters/forward_filter.h"
#include "linear/sparse_product.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::RichLayout;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

TestProblem TapeProblem(bool rich) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout =
      rich ? RichLayout(options.noise) : TypicalLayout(options.noise);
  options.errors = true;
  options.duration = 20.0;
  return MakeProblem(options, 3);
}

State RandomState(const ErrorLayout& layout) {
  State x;
  x.t = 0.25;
  x.p_e.setRandom();
  x.v_e.setRandom();
  x.q_eb = Eigen::Quaterniond::UnitRandom();
  x.b_g.setRandom();
  x.b_a.setRandom();
  x.parameters.setRandom(layout.parameter_count());
  return x;
}

ErrorMatrix RandomSymmetric(int n) {
  const ErrorMatrix A = ErrorMatrix::Random(n, n);
  return A + A.transpose();
}

struct Written {
  TapeEpoch epoch;
  Transition transition;
  ErrorMatrix P_minus, P_plus;
};

/// Epochs of every form: reset or not, with and without zero vectors, and with
/// transitions of which few rows, or all, are more than their diagonal.
Written WrittenAs(const ErrorLayout& layout, std::size_t k) {
  const int n = layout.dim();
  Written out;
  out.epoch.t = static_cast<double>(k);
  out.epoch.x_minus = RandomState(layout);
  out.epoch.x_plus = k % 2 == 0 ? out.epoch.x_minus : RandomState(layout);
  out.epoch.reset = k % 2 == 1;
  const ErrorVector zero = ErrorVector::Zero(n);
  const ErrorVector some = ErrorVector::Random(n);
  out.epoch.c = k % 3 == 0 ? zero : some;
  out.epoch.dx_minus = k % 5 == 0 ? some : zero;
  out.epoch.dx_plus = k % 4 == 0 ? zero : some;
  out.transition.Phi = ErrorMatrix::Random(n, n);
  if (k % 2 == 0) {
    out.transition.Phi.bottomRows(n - 9).setZero();
    out.transition.Phi.diagonal().setConstant(0.5);
    // Full rows come last.
    if (k % 4 == 0) out.transition.Phi.reverseInPlace();
  }
  out.transition.Q = RandomSymmetric(n);
  out.P_minus = RandomSymmetric(n);
  out.P_plus = RandomSymmetric(n);
  return out;
}

void ExpectSame(const State& a, const State& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.p_e, b.p_e);
  EXPECT_EQ(a.v_e, b.v_e);
  EXPECT_EQ(a.q_eb.coeffs(), b.q_eb.coeffs());
  EXPECT_EQ(a.b_g, b.b_g);
  EXPECT_EQ(a.b_a, b.b_a);
  EXPECT_EQ(a.parameters, b.parameters);
}

void ExpectEpoch(const LinearTape& tape, std::size_t k, const Written& wanted) {
  const TapeEpoch epoch = tape.epoch(k);
  EXPECT_EQ(tape.t(k), wanted.epoch.t);
  EXPECT_EQ(epoch.t, wanted.epoch.t);
  ExpectSame(epoch.x_minus, wanted.epoch.x_minus);
  ExpectSame(epoch.x_plus, wanted.epoch.x_plus);
  EXPECT_EQ(epoch.reset, wanted.epoch.reset);
  EXPECT_EQ(epoch.c, wanted.epoch.c);
  EXPECT_EQ(epoch.dx_minus, wanted.epoch.dx_minus);
  EXPECT_EQ(epoch.dx_plus, wanted.epoch.dx_plus);
  EXPECT_EQ(tape.P_minus(k), wanted.P_minus);
  EXPECT_EQ(tape.P_plus(k), wanted.P_plus);
  if (k == 0) return;
  EXPECT_EQ(tape.Phi(k), wanted.transition.Phi);
  EXPECT_EQ(tape.Q(k), wanted.transition.Q);
  ErrorMatrix predicted = wanted.P_plus;
  tape.OverInterval(k).ApplyCongruence(&predicted);
  ErrorMatrix expected = wanted.P_plus;
  SparseCongruence(wanted.transition.Phi).ApplyCongruence(&expected);
  EXPECT_EQ(predicted, expected);
  const PackedSymmetric Q = tape.PackedQ(k);
  for (Eigen::Index j = 0; j < Q.n; ++j) {
    const Eigen::Map<const Eigen::VectorXd> column(Q.Column(j), Q.n - j);
    EXPECT_EQ(column, wanted.transition.Q.col(j).tail(Q.n - j));
  }
}

TEST(LinearTape, ReadsWhatWasWritten) {
  for (const bool rich : {false, true}) {
    const TestProblem problem = TapeProblem(rich);
    const ErrorLayout& layout = problem.layout;
    LinearTape tape(layout);
    std::vector<Written> all;
    for (std::size_t k = 0; k < 3000; ++k) {
      const Written& next = all.emplace_back(WrittenAs(layout, k));
      tape.Append(next.epoch, next.transition, next.P_minus, next.P_plus);
    }
    while (tape.size() > 0) {
      for (const std::size_t k : {tape.size() - 1, tape.size() / 3}) {
        ExpectEpoch(tape, k, all[k]);
      }
      if (::testing::Test::HasFailure()) return;
      tape.PopBack();
    }
  }
}

TEST(LinearTape, GoesOnWhereItWasShortened) {
  const TestProblem problem = TapeProblem(false);
  LinearTape tape(problem.layout);
  std::vector<Written> all;
  for (std::size_t k = 0; k < 40; ++k) {
    all.push_back(WrittenAs(problem.layout, k));
  }
  const auto append = [&](const Written& one) {
    tape.Append(one.epoch, one.transition, one.P_minus, one.P_plus);
  };
  for (const Written& one : all) append(one);
  const std::size_t bytes = tape.bytes();
  for (int i = 0; i < 25; ++i) tape.PopBack();
  EXPECT_LT(tape.bytes(), bytes / 2);
  for (std::size_t k = 15; k < all.size(); ++k) append(all[k]);
  EXPECT_EQ(tape.bytes(), bytes);
  for (std::size_t k = 0; k < all.size(); ++k) ExpectEpoch(tape, k, all[k]);
}

/// An epoch takes the numbers that it has, and no room for the largest layout:
/// three triangles, two states, one mean, the nine rows of Phi that are more than
/// their diagonal, and residual, innovation, H, R and S of a fix; beside these its
/// place and the header of a measurement.
TEST(LinearTape, TakesWhatItsLayoutHas) {
  TestProblem problem = TapeProblem(false);
  Problem posed = problem.Pose();
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  const auto n = static_cast<std::size_t>(tape.dim());
  ASSERT_EQ(n, 15u);
  std::size_t rows = 0;
  std::size_t measurements = 0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      const auto m = static_cast<std::size_t>(z.residual.size());
      rows += m * (2 + n + 2 * m + n);
      ++measurements;
    }
  }
  const std::size_t epoch = 3 * n * (n + 1) / 2 + 2 * 17 + n + 9 * n + (n - 9);
  EXPECT_LE(tape.bytes(), 8 * (tape.size() * epoch + rows) + 64 * tape.size() +
                              measurements * sizeof(TapeMeasurement));
}

}  // namespace
}  // namespace hindsight
