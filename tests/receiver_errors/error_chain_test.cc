#include "receiver_errors/error_chain.h"

#include <gtest/gtest.h>

#include <tuple>

#include "receiver_errors/receiver_tape.h"

namespace hindsight {
namespace {

using testing::Good;
using testing::PositionsOnly;
using testing::TapeOf;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::WithoutOutliers;

constexpr ErrorStep kStayGood = {ErrorMode::kGood};
constexpr ErrorStep kStepVelocity = {ErrorMode::kGood, false, true};

/// Good fixes up to node k, which is predicted but for the error.
Gaussian PredictedTo(std::size_t end, ErrorChain* chain) {
  Gaussian x = chain->Begin();
  for (std::size_t k = 0;; ++k) {
    chain->MoveTo(k);
    chain->PredictNavigation(&x);
    if (k == end) return x;
    chain->PredictError(kStayGood, &x);
    chain->UpdateAll(false, &x);
  }
}

/// A drive with positions and velocities, with errors of everything.
TestProblem WithVelocities(double duration) {
  TestProblemOptions options;
  options.noise = testing::TacticalNoise(true);
  options.layout = testing::TypicalLayout(options.noise);
  options.errors = true;
  options.duration = duration;
  return testing::MakeProblem(options, 3);
}

/// Without the fixes of nodes `begin` to past `end`.
LinearTape WithGap(std::size_t begin, std::size_t end) {
  const TestProblem problem = PositionsOnly(40.0);
  GateDecisions used(problem.measurements.size(), 1);
  for (std::size_t k = begin; k < end; ++k) used[k] = 0;
  return TapeOf(problem, used);
}

/// By time: a gap is as much of a recording as what it lacks.
TEST(ErrorChain, SharesARecordingBetweenItsFixes) {
  constexpr std::size_t kBegin = 15;
  constexpr std::size_t kEnd = 25;
  const LinearTape tape = WithGap(kBegin, kEnd);
  const SensorTape seen(tape, 0);
  ErrorChain chain(seen, WithoutOutliers());
  const auto share = [&chain](std::size_t k) {
    chain.MoveTo(k);
    return chain.share();
  };
  const auto count = static_cast<double>(Good(tape).size());
  double sum = 0.0;
  for (std::size_t k = 1; k < tape.size(); ++k) sum += share(k);
  EXPECT_NEAR(sum, (count - 1.0) / count, 1e-9);
  EXPECT_NEAR(share(kEnd), static_cast<double>(kEnd - kBegin + 1) * share(1),
              1e-9);
  EXPECT_NEAR(share(0), 1.0 / count, 1e-12);
}

/// The tape's, of the navigation state with the IMU's noise so many times as large.
ErrorMatrix ScaledNoise(const LinearTape& tape, std::size_t k, double scale) {
  ErrorVector scales = ErrorVector::Ones(tape.dim());
  for (const Block& block : tape.layout().blocks()) {
    if (!IsNavigation(block.key.kind)) continue;
    scales.segment(block.offset, block.dim).setConstant(scale);
  }
  return scales.asDiagonal() * tape.Q(k) * scales.asDiagonal();
}

Gaussian RandomOf(int dim) {
  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(dim, dim);
  return {A.col(0), A * A.transpose()};
}

/// Of each mode, with an IMU worse than stated, over random covariances.
TEST(ErrorChain, PredictsAsItsTransitionSays) {
  const LinearTape tape = TapeOf(WithVelocities(5.0));
  const SensorTape seen(tape, 0);
  ErrorParameters p = WithoutOutliers();
  p.imu_scale = 3.0;
  p.rate_sigma = 0.3;
  p.down = 0.2;
  ErrorChain chain(seen, p);
  const int n = chain.dim();
  for (std::size_t k = 1; k < seen.size(); ++k) {
    chain.MoveTo(k);
    for (const ErrorStep step :
         {kStayGood, kStepVelocity, ErrorStep{ErrorMode::kBiased},
          ErrorStep{ErrorMode::kDrifting, true},
          ErrorStep{ErrorMode::kDrifting}}) {
      const Gaussian before = RandomOf(n);
      Gaussian after = before;
      chain.PredictNavigation(&after);
      chain.PredictError(step, &after);
      EXPECT_EQ(after.mean.size(), chain.DimOf(step.mode));
      after = ErrorChain::Resized(after, n);
      const ErrorMatrix Phi = chain.Phi(step);
      const ErrorVector mean = Phi * before.mean + chain.Defect();
      const ErrorMatrix P = Phi * before.P * Phi.transpose() + chain.Q(step);
      if (step == kStayGood) {
        const ErrorMatrix Q = chain.Q(step).topLeftCorner(n - 6, n - 6);
        EXPECT_LT((Q - ScaledNoise(tape, k, p.imu_scale)).norm(),
                  1e-12 * Q.norm());
      }
      EXPECT_LT((after.mean - mean).norm(), 1e-12 * mean.norm());
      EXPECT_LT((after.P - P).norm(), 1e-12 * P.norm());
    }
  }
}

/// From good fixes on, through every kind of error and back.
TEST(ErrorChain, PredictsOverChangesOfModeAsItsTransitionsSay) {
  const LinearTape tape = TapeOf(WithVelocities(8.0));
  const SensorTape seen(tape, 0);
  ErrorParameters p = WithoutOutliers();
  p.rate_sigma = 0.3;
  ErrorChain chain(seen, p);
  const ModeSequence steps = {kStayGood,
                              {ErrorMode::kSlight, true},
                              {ErrorMode::kSlight},
                              {ErrorMode::kDrifting, true},
                              {ErrorMode::kDrifting},
                              {ErrorMode::kBiased},
                              kStayGood};
  ASSERT_GT(seen.size(), steps.size());
  Gaussian x = chain.Begin();
  Gaussian all = ErrorChain::Resized(x, chain.dim());
  for (std::size_t k = 1; k <= steps.size(); ++k) {
    chain.MoveTo(k);
    chain.PredictNavigation(&x);
    chain.PredictError(steps[k - 1], &x);
    const ErrorMatrix Phi = chain.Phi(steps[k - 1]);
    all.mean = (Phi * all.mean + chain.Defect()).eval();
    all.P = (Phi * all.P * Phi.transpose() + chain.Q(steps[k - 1])).eval();
    chain.UpdateAll(false, &x);
    chain.UpdateAll(false, &all);
    const Gaussian same = ErrorChain::Resized(x, chain.dim());
    EXPECT_LT((same.mean - all.mean).norm(), 1e-9 * all.mean.norm()) << k;
    EXPECT_LT((same.P - all.P).norm(), 1e-9 * all.P.norm()) << k;
  }
}

/// With zeros in the place of what it has not.
TEST(ErrorChain, AStateIsThatOfAllComponents) {
  const LinearTape tape = TapeOf(WithVelocities(5.0));
  const SensorTape seen(tape, 0);
  ErrorParameters p = WithoutOutliers();
  p.outlier_share = 0.1;
  p.down = 0.3;
  ErrorChain chain(seen, p);
  for (const ErrorMode mode :
       {ErrorMode::kGood, ErrorMode::kSlight, ErrorMode::kDrifting}) {
    for (std::size_t k = 1; k < seen.size(); ++k) {
      chain.MoveTo(k);
      Gaussian own = RandomOf(chain.DimOf(mode));
      Gaussian all = ErrorChain::Resized(own, chain.dim());
      ASSERT_TRUE(chain.has_fix());
      for (const ErrorStep step :
           {ErrorStep{mode}, kStepVelocity, ErrorStep{ErrorMode::kBiased}}) {
        EXPECT_NEAR(chain.LikelihoodAfter(step, chain.ViewOf(own)).log,
                    chain.LikelihoodAfter(step, chain.ViewOf(all)).log, 1e-9);
        Gaussian predicted = all;
        chain.PredictError(step, &predicted);
        EXPECT_NEAR(chain.LikelihoodAfter(step, chain.ViewOf(all)).log,
                    chain.LikelihoodOfFix(step, predicted).log, 1e-9);
      }
      const auto of_own = chain.UpdateWithFix({mode}, &own);
      const auto of_all = chain.UpdateWithFix({mode}, &all);
      EXPECT_NEAR(of_own.fix.log, of_all.fix.log, 1e-9);
      EXPECT_NEAR(of_own.others, of_all.others, 1e-9);
      own = ErrorChain::Resized(own, chain.dim());
      EXPECT_LT((own.mean - all.mean).norm(), 1e-12 * all.mean.norm());
      EXPECT_LT((own.P - all.P).norm(), 1e-12 * all.P.norm());
    }
  }
}

TEST(SensorTape, NothingIsSeenSinceTheFixBefore) {
  constexpr std::size_t kMissing = 15;
  const LinearTape tape = WithGap(kMissing, kMissing + 1);
  const SensorTape seen(tape, 0);
  ASSERT_FALSE(seen.HasFix(kMissing));
  for (const std::size_t k : {kMissing - 1, kMissing + 2}) {
    EXPECT_EQ(seen.unseen_drift(k).length, tape.t(k) - tape.t(k - 1)) << k;
    EXPECT_FALSE(seen.unseen_drift(k).lacks_fix) << k;
  }
  const double T = tape.t(kMissing + 1) - tape.t(kMissing - 1);
  EXPECT_EQ(seen.unseen_drift(kMissing + 1).length, T);
  EXPECT_TRUE(seen.unseen_drift(kMissing + 1).lacks_fix);
  EXPECT_TRUE(seen.unseen_step(kMissing + 1).lacks_fix);
}

/// Else the one stands for the other.
TEST(SensorTape, OfALoneReceiverADriftAndAStepOfTheVelocityBeginAlike) {
  const LinearTape tape = WithGap(15, 17);
  const SensorTape seen(tape, 0);
  int fixes = 0;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    if (!seen.HasFix(k)) continue;
    ++fixes;
    EXPECT_EQ(seen.unseen_step(k).length, seen.unseen_drift(k).length) << k;
    EXPECT_EQ(seen.unseen_step(k).lacks_fix, seen.unseen_drift(k).lacks_fix)
        << k;
  }
  EXPECT_GT(fixes, 20);
}

/// A step of the velocity was at the last fix, but behind a gap at any time of it, or in a
/// quarter: moments of dv u, u uniform.
TEST(ErrorChain, StepsOfTheVelocityReachOverAGap) {
  constexpr std::size_t kBegin = 15;
  constexpr std::size_t kEnd = 25;
  const LinearTape tape = WithGap(kBegin, kEnd);
  ErrorParameters p = WithoutOutliers();
  p.rate_sigma = 0.3;
  for (const auto& [node, last, onset, square, by_rate] :
       {std::tuple{kBegin - 1, kBegin - 2, Onset::kUsual, 1.0, 1.0},
        {kBegin - 1, kBegin - 2, Onset::kSecond, 19.0 / 48.0, 0.625},
        {kEnd, kBegin - 1, Onset::kUsual, 1.0 / 3.0, 0.5},
        {kEnd, kBegin - 1, Onset::kFourth, 1.0 / 48.0, 0.125}}) {
    ErrorStep steps = kStepVelocity;
    steps.onset = onset;
    const SensorTape seen(tape, 0);
    ErrorChain chain(seen, p);
    Gaussian x = PredictedTo(node, &chain);
    const auto before = chain.LikelihoodAfter(steps, chain.ViewOf(x));
    Gaussian stepped = x;
    chain.PredictError(kStayGood, &x);
    chain.PredictError(steps, &stepped);
    const double T = tape.t(node) - tape.t(last);
    const double q = p.rate_sigma * p.rate_sigma;
    const int pos = tape.layout().Find(BlockKind::kPosition)->offset;
    const int vel = tape.layout().Find(BlockKind::kVelocity)->offset;
    const int n = chain.dim();
    const ErrorMatrix added =
        ErrorChain::Resized(stepped, n).P - ErrorChain::Resized(x, n).P;
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    EXPECT_TRUE(
        (added.block<3, 3>(pos, pos).isApprox(q * T * T * square * I, 1e-9)));
    EXPECT_TRUE(
        (added.block<3, 3>(pos, vel).isApprox(q * T * by_rate * I, 1e-9)));
    EXPECT_TRUE((added.block<3, 3>(vel, vel).isApprox(q * I, 1e-9)));
    EXPECT_NEAR(before.log, chain.LikelihoodOfFix(steps, stepped).log, 1e-9);
    EXPECT_TRUE((chain.Q(steps) - chain.Q(kStayGood)).isApprox(added, 1e-9));
  }
}

/// Another receiver that measures in the gap has seen where the vehicle was.
TEST(ErrorChain, OtherPositionsEndTheReachOfAStep) {
  TestProblem problem = PositionsOnly(40.0);
  constexpr std::size_t kNode = 25;
  problem.sensors.push_back(problem.sensors[0]);
  for (std::size_t k = 15; k < kNode; ++k) problem.measurements[k].sensor = 1;
  const LinearTape tape = TapeOf(problem);
  ErrorParameters p = WithoutOutliers();
  p.rate_sigma = 0.3;
  const SensorTape seen(tape, 0);
  ErrorChain chain(seen, p);
  PredictedTo(kNode, &chain);
  const int pos = tape.layout().Find(BlockKind::kPosition)->offset;
  const double dt = tape.t(kNode) - tape.t(kNode - 1);
  EXPECT_NEAR((chain.Q(kStepVelocity) - chain.Q(kStayGood))(pos, pos),
              p.rate_sigma * p.rate_sigma * dt * dt, 1e-9);
}

/// Velocities see the position by the curvature of the Earth alone.
TEST(SensorTape, VelocitiesDoNotEndTheTimeOfAStepOfPositions) {
  const TestProblem problem = WithVelocities(40.0);
  GateDecisions used;
  for (const Measurement& z : problem.measurements) {
    used.push_back(z.sensor == 1 || z.t < 14.5 || z.t > 24.5);
  }
  const LinearTape tape = TapeOf(problem, used);
  constexpr std::size_t kNode = 25;
  const Block* position = tape.layout().Find(BlockKind::kPosition);
  EXPECT_FALSE(tape.measurements(kNode - 1)[1]
                   .H.middleCols(position->offset, 3)
                   .isZero(0.0));
  const UnseenTime unseen = SensorTape(tape, 0).unseen_step(kNode);
  EXPECT_EQ(unseen.since, 14.0);
  EXPECT_EQ(unseen.length, 11.0);
}

/// What a velocity was at its last fix is known, however long ago the position was.
TEST(ErrorChain, VelocitiesEndTheReachOfAStep) {
  const TestProblem problem = WithVelocities(40.0);
  GateDecisions used;
  for (const Measurement& z : problem.measurements) {
    used.push_back(z.sensor == 1 || z.t < 14.5);
  }
  const LinearTape tape = TapeOf(problem, used);
  ErrorParameters p = WithoutOutliers();
  p.rate_sigma = 0.3;
  const SensorTape seen(tape, 1);
  ErrorChain chain(seen, p);
  constexpr std::size_t kNode = 25;
  PredictedTo(kNode, &chain);
  const int pos = tape.layout().Find(BlockKind::kPosition)->offset;
  const double dt = tape.t(kNode) - tape.t(kNode - 1);
  EXPECT_NEAR((chain.Q(kStepVelocity) - chain.Q(kStayGood))(pos, pos),
              p.rate_sigma * p.rate_sigma * dt * dt, 1e-9);
}

}  // namespace
}  // namespace hindsight
