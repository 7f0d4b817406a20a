#include "filters/imm.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "filters/imm_smoother.h"
#include "filters/rts.h"
#include "filters/vertical.h"
#include "measurements/sensor_kind.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::ScaledDifference;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

TestProblem NoisyProblem(double duration, double position_sigma = 0.5) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.errors = true;
  options.duration = duration;
  options.position_sigma = position_sigma;
  options.velocity_sigma = 0.0;
  return MakeProblem(options, 3);
}

void PutOff(std::size_t k, const Eigen::Vector3d& by_n, TestProblem* problem) {
  auto& fix = std::get<PositionFix>(problem->measurements[k].model);
  fix.p_e += NedAxes(fix.p_e) * by_n;
}

ImmModel Model(const TestProblem& problem, double sigma_factor) {
  return {"", problem.layout, problem.prior, {sigma_factor, 1.0}};
}

ImmOptions TwoModes(bool feedback) {
  ImmOptions options;
  options.transition = StayingTransition(2, 0.9);
  options.start = Eigen::Vector2d(0.5, 0.5);
  options.feedback = feedback;
  return options;
}

/// |a - b| in standard deviations of P, the largest component.
double InSigmas(const ErrorVector& a, const ErrorVector& b,
                const ErrorMatrix& P) {
  return ((a - b).array() / P.diagonal().array().sqrt()).abs().maxCoeff();
}

/// To the last bit: both are one walk.
void ExpectSameTape(const LinearTape& a, const LinearTape& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a.epoch(k).x_plus.p_e, b.epoch(k).x_plus.p_e) << k;
    EXPECT_EQ(a.epoch(k).x_plus.v_e, b.epoch(k).x_plus.v_e) << k;
    EXPECT_EQ(a.epoch(k).x_plus.q_eb.coeffs(), b.epoch(k).x_plus.q_eb.coeffs())
        << k;
    EXPECT_EQ(a.epoch(k).x_plus.b_g, b.epoch(k).x_plus.b_g) << k;
    EXPECT_EQ(a.epoch(k).dx_plus, b.epoch(k).dx_plus) << k;
    EXPECT_EQ(a.P_minus(k), b.P_minus(k)) << k;
    EXPECT_EQ(a.P_plus(k), b.P_plus(k)) << k;
    ASSERT_EQ(a.measurements(k).size(), b.measurements(k).size());
    for (std::size_t i = 0; i < a.measurements(k).size(); ++i) {
      EXPECT_EQ(a.measurements(k)[i].nis, b.measurements(k)[i].nis) << k;
      EXPECT_EQ(a.measurements(k)[i].weight, b.measurements(k)[i].weight) << k;
      EXPECT_EQ(a.measurements(k)[i].accepted, b.measurements(k)[i].accepted)
          << k;
    }
  }
}

TEST(Imm, OfOneModeIsTheExtendedKalmanFilter) {
  const TestProblem problem = NoisyProblem(30.0);
  Problem posed = problem.Pose();
  const LinearTape ekf = RunExtendedKalmanFilter(&posed);
  Problem again = problem.Pose();
  const ImmResult imm = RunImm({Model(problem, 1.0)}, {}, &again.timeline);
  ExpectSameTape(imm.tape.tapes[0], ekf);
  const SmoothedTrajectory rts = SmoothRts(ekf);
  const ImmSmoothed smoothed = SmoothImm(imm.tape, true);
  double log_likelihood = 0.0;
  for (std::size_t k = 0; k < ekf.size(); ++k) {
    for (const TapeMeasurement& z : ekf.measurements(k)) {
      log_likelihood += z.log_likelihood;
    }
    const ErrorMatrix P = ekf.P_plus(k);
    EXPECT_LT(ScaledDifference(imm.trajectory.P.Get(k), P), 1e-9);
    EXPECT_LT(ScaledDifference(smoothed.models[k][0].P, rts.P.Get(k)), 1e-8);
    EXPECT_LT(InSigmas(Local(problem.layout, rts.states[k],
                             smoothed.trajectory.states[k]),
                       ErrorVector::Zero(P.rows()), rts.P.Get(k)),
              1e-5);
  }
  EXPECT_NEAR(imm.tape.log_likelihood(), log_likelihood,
              1e-9 * std::abs(log_likelihood));
}

/// Outliers that a mixture and a gate take out, after a first ten epochs.
TestProblem ProblemWithRules() {
  TestProblem problem = NoisyProblem(30.0);
  problem.sensors[0].loss.kind = RobustLoss::Kind::kMixture;
  problem.sensors[0].loss.scale = 1.0;
  problem.sensors[0].gate_probability = 0.9999;
  PutOff(12, {8.0, -8.0, 0.0}, &problem);  // the mixture's
  PutOff(20, {800.0, 0.0, 800.0},
         &problem);  // beyond twenty sigmas: the gate's
  return problem;
}

TEST(Imm, OfOneModeTakesLossesAndGatesAsTheExtendedKalmanFilterDoes) {
  const TestProblem problem = ProblemWithRules();
  Problem posed = problem.Pose();
  const LinearTape ekf = RunExtendedKalmanFilter(&posed);
  Problem again = problem.Pose();
  const ImmResult imm = RunImm({Model(problem, 1.0)}, {}, &again.timeline);
  EXPECT_LT(ekf.measurements(12)[0].weight, 0.01);
  EXPECT_TRUE(ekf.measurements(12)[0].accepted);
  EXPECT_FALSE(ekf.measurements(20)[0].accepted);
  ExpectSameTape(imm.tape.tapes[0], ekf);
  const SmoothedTrajectory rts = SmoothRts(ekf);
  const ImmSmoothed smoothed = SmoothImm(imm.tape, true);
  for (std::size_t k = 0; k < ekf.size(); ++k) {
    EXPECT_LT(ScaledDifference(imm.trajectory.P.Get(k), ekf.P_plus(k)), 1e-6);
    EXPECT_LT(ScaledDifference(smoothed.models[k][0].P, rts.P.Get(k)), 1e-6);
    EXPECT_LT(InSigmas(Local(problem.layout, rts.states[k],
                             smoothed.trajectory.states[k]),
                       ErrorVector::Zero(rts.P.Get(k).rows()), rts.P.Get(k)),
              1e-4);
  }
}

TEST(Imm, AllModelsShareOneWeightAndOneGate) {
  const TestProblem problem = ProblemWithRules();
  Problem posed = problem.Pose();
  ImmModel unsure = Model(problem, 1.0);
  unsure.prior.P *= 25.0;
  const ImmResult imm =
      RunImm({Model(problem, 1.0), unsure}, TwoModes(true), &posed.timeline);
  for (std::size_t k = 0; k < imm.tape.size(); ++k) {
    for (std::size_t i = 0; i < imm.tape.tapes[0].measurements(k).size(); ++i) {
      const TapeMeasurement& a = imm.tape.tapes[0].measurements(k)[i];
      const TapeMeasurement& b = imm.tape.tapes[1].measurements(k)[i];
      EXPECT_EQ(a.weight, b.weight);
      EXPECT_EQ(a.accepted, b.accepted);
    }
  }
  EXPECT_LT(imm.tape.tapes[1].measurements(12)[0].weight, 0.01);
  EXPECT_FALSE(imm.tape.tapes[1].measurements(20)[0].accepted);
  EXPECT_TRUE(imm.tape.tapes[1].measurements(21)[0].accepted);
}

TEST(Imm, ModeProbabilitiesSumToOneAndFollowTheOutliers) {
  TestProblem problem = NoisyProblem(40.0);
  for (std::size_t k = 20; k < 26; ++k) PutOff(k, {8.0, -8.0, 0.0}, &problem);
  for (const bool feedback : {false, true}) {
    Problem posed = problem.Pose();
    const ImmResult imm = RunImm({Model(problem, 1.0), Model(problem, 20.0)},
                                 TwoModes(feedback), &posed.timeline);
    const ImmSmoothed smoothed = SmoothImm(imm.tape, true);
    for (std::size_t k = 0; k < imm.tape.size(); ++k) {
      EXPECT_NEAR(imm.tape.epochs[k].probability.sum(), 1.0, 1e-12);
      EXPECT_NEAR(imm.tape.epochs[k].predicted.sum(), 1.0, 1e-12);
      EXPECT_NEAR(smoothed.trajectory.probabilities[k].sum(), 1.0, 1e-12);
      const double wide = imm.trajectory.probabilities[k](1);
      const double smoothed_wide = smoothed.trajectory.probabilities[k](1);
      if (k >= 20 && k < 26) {
        EXPECT_GT(wide, 0.99) << k;
        EXPECT_GT(smoothed_wide, 0.99) << k;
      } else if (k > 5) {
        EXPECT_LT(wide, 0.2) << k;
        EXPECT_LT(smoothed_wide, 0.1) << k;
      }
    }
  }
}

TEST(Imm, FeedForwardAndFeedbackAgreeAsLongAsErrorsAreSmall) {
  TestProblem problem = NoisyProblem(10.0);
  // The start is exact: what is left of nonlinearity is of second order.
  problem.prior.x = problem.truth.front();
  std::vector<ImmResult> results;
  for (const bool feedback : {false, true}) {
    Problem posed = problem.Pose();
    results.push_back(RunImm({Model(problem, 1.0), Model(problem, 20.0)},
                             TwoModes(feedback), &posed.timeline));
  }
  for (std::size_t k = 0; k < problem.nodes.size(); ++k) {
    const ErrorVector d = Local(problem.layout, results[0].trajectory.states[k],
                                results[1].trajectory.states[k]);
    EXPECT_LT(InSigmas(d, ErrorVector::Zero(d.size()),
                       results[1].trajectory.P.Get(k)),
              0.02)
        << k;
  }
}

/// A block that no measurement sees makes a layout longer and changes nothing.
TEST(Imm, UnequalLayoutsMixOverWhatTheyShare) {
  const TestProblem problem = NoisyProblem(20.0);
  ImmModel longer = Model(problem, 1.0);
  Block unseen;
  unseen.key = {BlockKind::kColouredNoise, 7};
  unseen.name = "unseen";
  unseen.evolution = Evolution::GaussMarkov(2.0, 5.0);
  unseen.sigma0.setConstant(2.0);
  unseen.active = {true, false, true};
  longer.layout.Add(unseen);
  longer.prior.P = longer.layout.InitialCovariance();
  longer.prior.x.parameters = ParameterVector::Zero(3);
  Problem ekf_problem = problem.Pose();
  const LinearTape ekf = RunExtendedKalmanFilter(&ekf_problem);
  const std::vector<std::vector<ImmModel>> orders = {
      {Model(problem, 1.0), longer}, {longer, Model(problem, 1.0)}};
  for (const auto& models : orders) {
    Problem posed = problem.Pose();
    const ImmResult imm = RunImm(models, TwoModes(true), &posed.timeline);
    const ImmSmoothed smoothed = SmoothImm(imm.tape, true);
    const SmoothedTrajectory rts = SmoothRts(ekf);
    for (std::size_t k = 0; k < ekf.size(); ++k) {
      EXPECT_NEAR(imm.trajectory.probabilities[k](0), 0.5, 1e-6);
      EXPECT_NEAR(smoothed.trajectory.probabilities[k](0), 0.5, 1e-4);
      const ErrorMatrix P = imm.trajectory.P.Get(k);
      EXPECT_LT(ScaledDifference(P.topLeftCorner(15, 15), ekf.P_plus(k)), 1e-6);
      const ErrorMatrix P_s = smoothed.models[k][0].P;
      EXPECT_LT(ScaledDifference(P_s.topLeftCorner(15, 15), rts.P.Get(k)),
                1e-4);
      if (P.rows() > 15) {
        EXPECT_NEAR(P(15, 15), 4.0, 1e-9);
        EXPECT_NEAR(P_s(16, 16), 4.0, 1e-6);
      }
    }
  }
}

TEST(Imm, RefusesAFirstModelWithoutANavigationStateThatAnotherHas) {
  const TestProblem problem = NoisyProblem(3.0);
  ImmModel masked = Model(problem, 1.0);
  masked.layout = ErrorLayout();
  for (Block block : problem.layout.blocks()) {
    if (block.key.kind == BlockKind::kVelocity) block.active[2] = false;
    masked.layout.Add(block);
  }
  masked.prior.P = masked.layout.InitialCovariance();
  Problem posed = problem.Pose();
  EXPECT_THROW(
      RunImm({masked, Model(problem, 1.0)}, TwoModes(true), &posed.timeline),
      std::logic_error);
}

/// What an exact smoother says: all sequences of modes, each with a Kalman
/// filter and smoother of its own about the same nominal.
struct Exact {
  std::vector<Gaussian> smoothed;
  std::vector<double> wide;  ///< smoothed probability of mode 1
  Eigen::Matrix2d pairs = Eigen::Matrix2d::Zero();  ///< of the last two nodes
  double log_likelihood = 0.0;
};

Exact Enumerate(const TestProblem& problem, const ImmTape& tape, double factor,
                const ImmOptions& options) {
  std::vector<State> nominal;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    nominal.push_back(tape.tapes[0].epoch(k).x_minus);
  }
  const std::size_t nodes = tape.size();
  std::vector<double> log_weight;
  std::vector<SmoothedTrajectory> trajectories;
  for (unsigned sequence = 0; sequence < (1U << nodes); ++sequence) {
    TestProblem scaled = problem;
    double sum = 0.0;
    for (std::size_t k = 0; k < nodes; ++k) {
      const int mode = (sequence >> k) & 1U;
      const int before = k == 0 ? 0 : (sequence >> (k - 1)) & 1U;
      sum += std::log(k == 0 ? options.start(mode)
                             : options.transition(before, mode));
      if (mode == 1) ScaleSigma(factor, &scaled.measurements[k]);
    }
    Problem posed = scaled.Pose();
    const LinearTape linear = RunLinearizedFilter(nominal, &posed);
    for (std::size_t k = 0; k < nodes; ++k) {
      sum += linear.measurements(k)[0].log_likelihood;
    }
    log_weight.push_back(sum);
    trajectories.push_back(SmoothRts(linear));
  }
  const auto count = static_cast<Eigen::Index>(log_weight.size());
  const Eigen::Map<Eigen::VectorXd> logs(log_weight.data(), count);
  const double largest = logs.maxCoeff();
  Eigen::VectorXd weights = (logs.array() - largest).exp();
  Exact exact;
  exact.log_likelihood = largest + std::log(weights.sum());
  weights /= weights.sum();
  for (std::size_t i = 0; i < trajectories.size(); ++i) {
    exact.pairs((i >> (nodes - 2)) & 1U, (i >> (nodes - 1)) & 1U) +=
        weights(static_cast<Eigen::Index>(i));
  }
  for (std::size_t k = 0; k < nodes; ++k) {
    std::vector<Gaussian> parts;
    double wide = 0.0;
    for (std::size_t i = 0; i < trajectories.size(); ++i) {
      parts.push_back({trajectories[i].d[k], trajectories[i].P.Get(k)});
      if ((i >> k) & 1U) wide += weights(static_cast<Eigen::Index>(i));
    }
    exact.smoothed.push_back(Merge(parts, weights));
    exact.wide.push_back(wide);
  }
  return exact;
}

/// A fixed nominal is that of the linearised filter.
TEST(Imm, OfOneModeAboutAFixedNominalIsTheLinearizedFilter) {
  const TestProblem problem = NoisyProblem(15.0);
  Problem posed = problem.Pose();
  const LinearTape linear = RunLinearizedFilter(problem.truth, &posed);
  ImmOptions options;
  options.transition = StayingTransition(1, 1.0);
  options.start = Eigen::VectorXd::Ones(1);
  options.nominal = problem.truth;
  const ImmResult imm = RunImm({Model(problem, 1.0)}, options, &posed.timeline);
  for (std::size_t k = 0; k < linear.size(); ++k) {
    const ErrorMatrix P = linear.P_plus(k);
    EXPECT_LT(ScaledDifference(imm.tape.tapes[0].P_plus(k), P), 1e-9);
    EXPECT_LT(
        InSigmas(imm.tape.epochs[k].mean_plus[0], linear.epoch(k).dx_plus, P),
        1e-6);
  }
}

/// Between two nodes nothing has been merged yet but the prediction, which the
/// smoother divides out again.
TEST(ImmSmoother, IsExactOverOneInterval) {
  constexpr double kFactor = 6.0;
  TestProblem problem = NoisyProblem(1.0, 0.3);
  PutOff(0, {0.9, 0.0, 0.0}, &problem);
  const ImmOptions options = TwoModes(false);
  Problem posed = problem.Pose();
  const ImmResult imm = RunImm({Model(problem, 1.0), Model(problem, kFactor)},
                               options, &posed.timeline);
  const ImmSmoothed smoothed = SmoothImm(imm.tape, true);
  const Exact exact = Enumerate(problem, imm.tape, kFactor, options);
  const Eigen::MatrixXd& pairs = smoothed.pairs[1];
  for (Eigen::Index j = 0; j < 2; ++j) {
    const Eigen::VectorXd right = exact.pairs.col(j) / exact.pairs.col(j).sum();
    EXPECT_GT(right.minCoeff(), 1e-3);
    EXPECT_LT((pairs.col(j) / pairs.col(j).sum() - right).norm(), 1e-6);
  }
}

TEST(ImmSmoother, IsNearAllSequencesOfModesWeighedExactly) {
  constexpr double kFactor = 6.0;
  TestProblem problem = NoisyProblem(7.0, 0.3);
  // One clear outlier and one of which the data cannot be sure.
  PutOff(3, {2.5, 0.0, 0.0}, &problem);
  PutOff(5, {0.0, 0.8, 0.0}, &problem);
  const ImmOptions options = TwoModes(false);
  Problem posed = problem.Pose();
  const ImmResult imm = RunImm({Model(problem, 1.0), Model(problem, kFactor)},
                               options, &posed.timeline);
  const ImmSmoothed smoothed = SmoothImm(imm.tape, true);
  const Exact exact = Enumerate(problem, imm.tape, kFactor, options);
  double filter_error = 0.0;
  double smoother_error = 0.0;
  double doubt = 0.0;
  for (std::size_t k = 0; k < imm.tape.size(); ++k) {
    const Gaussian combined = Combine(imm.tape.tapes, smoothed.models[k],
                                      smoothed.trajectory.probabilities[k]);
    const Gaussian& right = exact.smoothed[k];
    const double p = smoothed.trajectory.probabilities[k](1);
    // What merging costs: half a sigma, half a variance at most.
    EXPECT_LT(InSigmas(combined.mean, right.mean, right.P), 0.5) << k;
    EXPECT_LT(ScaledDifference(combined.P, right.P), 0.5) << k;
    EXPECT_NEAR(p, exact.wide[k], 0.2) << k;
    filter_error +=
        std::abs(imm.trajectory.probabilities[k](1) - exact.wide[k]);
    smoother_error += std::abs(p - exact.wide[k]);
    doubt = std::max(doubt, std::min(exact.wide[k], 1.0 - exact.wide[k]));
  }
  EXPECT_NEAR(imm.tape.log_likelihood(), exact.log_likelihood, 0.1);
  EXPECT_GT(doubt, 0.1);
  EXPECT_LT(smoother_error, 0.3 * filter_error);
}

TEST(ImmSmoother, PairsHaveTheModesAsMargins) {
  const TestProblem problem = NoisyProblem(15.0);
  Problem posed = problem.Pose();
  const ImmResult imm = RunImm({Model(problem, 1.0), Model(problem, 3.0)},
                               TwoModes(true), &posed.timeline);
  const ImmSmoothed smoothed = SmoothImm(imm.tape, true);
  for (std::size_t k = 1; k < imm.tape.size(); ++k) {
    const Eigen::MatrixXd& pairs = smoothed.pairs[k];
    const auto& p = smoothed.trajectory.probabilities;
    EXPECT_LT((pairs.rowwise().sum() - p[k - 1]).norm(), 1e-9);
    EXPECT_LT((pairs.colwise().sum().transpose() - p[k]).norm(), 1e-9);
  }
}

TEST(Mixing, TransferKeepsTheConditionalOfWhatIsNotShared) {
  Random random(4);
  ErrorMatrix A(5, 5);
  for (int i = 0; i < 25; ++i) A(i / 5, i % 5) = random.Normal();
  Gaussian own{ErrorVector::Ones(5), ErrorMatrix(A * A.transpose())};
  const ComponentMap shared = {2, -1, 0, -1, -1};
  // The same distribution of what is shared changes nothing.
  Gaussian from{ErrorVector::Zero(3), ErrorMatrix::Identity(3, 3)};
  from.mean << own.mean(2), 7.0, own.mean(0);
  from.P(0, 0) = own.P(2, 2);
  from.P(2, 2) = own.P(0, 0);
  from.P(0, 2) = from.P(2, 0) = own.P(0, 2);
  Gaussian same = Transfer(from, own, shared);
  EXPECT_LT((same.P - own.P).norm(), 1e-9);
  EXPECT_LT((same.mean - own.mean).norm(), 1e-9);
  // Exact knowledge of what is shared leaves the conditional covariance.
  from.P.setZero();
  const Gaussian known = Transfer(from, own, shared);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(known.P);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-9);
  EXPECT_NEAR(eigen.eigenvalues()(1), 0.0, 1e-9);
  EXPECT_GT(eigen.eigenvalues()(2), 1e-3);
}

TEST(Mixing, MergeHasTheMixturesMoments) {
  const Gaussian a{ErrorVector::Constant(1, 1.0),
                   ErrorMatrix::Constant(1, 1, 2)};
  const Gaussian b{ErrorVector::Constant(1, 5.0),
                   ErrorMatrix::Constant(1, 1, 4)};
  const Gaussian m = Merge({a, b}, Eigen::Vector2d(0.25, 0.75));
  EXPECT_DOUBLE_EQ(m.mean(0), 4.0);
  // E x^2 = 0.25 (2 + 1) + 0.75 (4 + 25) = 22.5.
  EXPECT_DOUBLE_EQ(m.P(0, 0), 22.5 - 16.0);
}

/// Position and velocity without down, as in the 2019 paper.
ErrorLayout MaskedLayout(const ErrorLayout& full) {
  ErrorLayout layout;
  for (Block block : full.blocks()) {
    if (block.key.kind <= BlockKind::kVelocity) block.active[2] = false;
    layout.Add(block);
  }
  return layout;
}

TEST(Imm, TakesTheMaskedVerticalFromTheHeights) {
  TestProblem problem = NoisyProblem(30.0);
  Sensor height;
  height.name = "height";
  height.kind = &HeightKind();
  problem.sensors.push_back(height);
  std::vector<Measurement> measurements;
  for (std::size_t k = 0; k < problem.nodes.size(); ++k) {
    Node& node = problem.nodes[k];
    const Measurement fix =
        problem.measurements[static_cast<std::size_t>(node.first_measurement)];
    node.first_measurement = static_cast<int>(measurements.size());
    node.measurement_count = 2;
    measurements.push_back(fix);
    const double h = GeodeticFromEcef(problem.truth[k].p_e).height;
    measurements.push_back({node.t, 2, false, HeightFix{h, 0.1}});
  }
  problem.measurements = measurements;
  ImmModel model = Model(problem, 1.0);
  model.sigma_factors.clear();
  model.layout = MaskedLayout(problem.layout);
  model.prior.P = model.layout.InitialCovariance();
  ASSERT_TRUE(MasksVertical(model.layout));
  ASSERT_FALSE(MasksVertical(problem.layout));
  ImmOptions options;
  options.transition = StayingTransition(1, 1.0);
  options.start = Eigen::VectorXd::Ones(1);
  for (const bool feedback : {false, true}) {
    options.feedback = feedback;
    Problem posed = problem.Pose();
    const ImmResult imm = RunImm({model}, options, &posed.timeline);
    for (std::size_t k = 1; k < imm.tape.size(); ++k) {
      const State& x = imm.trajectory.states[k];
      const State& truth = problem.truth[k];
      const double mean_rate =
          (GeodeticFromEcef(truth.p_e).height -
           GeodeticFromEcef(problem.truth[k - 1].p_e).height) /
          (truth.t - problem.truth[k - 1].t);
      // A step s along the tangent leaves the ellipsoid by s^2 / 2R.
      const double step = imm.tape.tapes[0].epoch(k).dx_plus.head<2>().norm();
      EXPECT_NEAR(GeodeticFromEcef(x.p_e).height,
                  GeodeticFromEcef(truth.p_e).height,
                  1e-6 + step * step / (2.0 * 6.3e6));
      EXPECT_NEAR(-x.v_n().z(), mean_rate, 1e-4);
      const Eigen::Vector3d e = x.C_en().transpose() * (truth.p_e - x.p_e);
      const ErrorMatrix P = imm.trajectory.P.Get(k);
      // Five sigmas: 29 epochs of two axes.
      EXPECT_LT(std::abs(e.x()), 5.0 * std::sqrt(P(0, 0))) << k;
      EXPECT_LT(std::abs(e.y()), 5.0 * std::sqrt(P(1, 1))) << k;
    }
  }
}

}  // namespace
}  // namespace hindsight
