#include "problems/error_regimes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace hindsight {
namespace {

constexpr std::size_t kGood = 0;
constexpr std::size_t kOutlier = 1;
constexpr std::size_t kBiased = 2;
constexpr std::size_t kJump = 3;

/// What is left of a receiver's bias in its good mode, in its sigma.
constexpr double kZeroError = 1e-3;
/// Correlation time by which an error is forgotten between any two nodes [s].
constexpr double kForgotten = 1e-6;

/// Root mean square of the stated sigmas of the receiver, north and east [m].
double StatedSigma(const RegimeProblem& problem) {
  double sum = 0.0;
  int count = 0;
  for (const Measurement& z : problem.timeline->all_measurements()) {
    const auto* fix = std::get_if<PositionFix>(&z.model);
    if (fix == nullptr || z.sensor != problem.receiver) continue;
    sum += 0.5 * (fix->R_n(0, 0) + fix->R_n(1, 1));
    ++count;
  }
  return std::sqrt(sum / std::max(1, count));
}

int FixCount(const RegimeProblem& problem) {
  int count = 0;
  for (const Measurement& z : problem.timeline->all_measurements()) {
    if (z.sensor == problem.receiver && !z.withheld) ++count;
  }
  return count;
}

/// Where the fit of a kind begins; `jump` is a guess of the size of errors [m].
ErrorRegimes Initial(const RegimeProblem& problem, ErrorRegimes::Kind kind,
                     double jump) {
  ErrorRegimes regimes;
  regimes.kind = kind;
  const double stated = StatedSigma(problem);
  regimes.sigma = kind == ErrorRegimes::Kind::kSwitching
                      ? std::max(10.0 * stated, jump)
                      : stated;
  // A bias is first taken to stay: one that walks fast explains anything.
  regimes.tau = kind == ErrorRegimes::Kind::kSwitching ? 3000.0 : 100.0;
  if (kind == ErrorRegimes::Kind::kSwitching) {
    regimes.transition.resize(4, 4);
    regimes.transition << 0.97, 0.02, 0.005, 0.005,  //
        0.85, 0.10, 0.025, 0.025,                    //
        0.02, 0.02, 0.95, 0.01,                      //
        0.10, 0.02, 0.85, 0.03;
    regimes.start = Eigen::Vector4d(0.94, 0.04, 0.01, 0.01);
  } else {
    regimes.transition.resize(2, 2);
    regimes.transition << 0.98, 0.02, 0.7, 0.3;
    regimes.start = Eigen::Vector2d(0.96, 0.04);
  }
  return regimes;
}

double StartSigma(const ErrorRegimes& regimes, std::size_t mode) {
  const bool zero = regimes.kind == ErrorRegimes::Kind::kSwitching &&
                    (mode == kGood || mode == kOutlier);
  return zero ? kZeroError * regimes.sigma : regimes.sigma;
}

Block ErrorBlock(const RegimeProblem& problem, const ErrorRegimes& regimes,
                 std::size_t mode) {
  Block block;
  block.key = {BlockKind::kColouredNoise, problem.receiver};
  block.name =
      problem.timeline->sensors()[static_cast<std::size_t>(problem.receiver)]
          .name +
      "_error";
  block.unit = "m";
  block.evolution = ErrorEvolution(regimes, mode);
  block.sigma0.setConstant(StartSigma(regimes, mode));
  return block;
}

/// The prior of the base layout beside that of the last block of `layout`.
ErrorMatrix WithBlock(const ErrorMatrix& P, const ErrorLayout& layout) {
  ErrorMatrix out = layout.InitialCovariance();
  out.topLeftCorner(P.rows(), P.cols()) = P;
  return out;
}

std::vector<ImmModel> Models(const RegimeProblem& problem,
                             const ExtendedProblem& extended,
                             const ErrorRegimes& regimes) {
  std::vector<ImmModel> models;
  const std::vector<std::string> names = regimes.ModeNames();
  for (std::size_t j = 0; j < names.size(); ++j) {
    ImmModel& model = models.emplace_back();
    model.name = names[j];
    model.layout = problem.layout;
    if (regimes.HasGaussMarkov()) {
      model.layout.Add(ErrorBlock(problem, regimes, j));
    }
    model.prior.x = extended.prior.x;
    model.prior.P = WithBlock(problem.prior.P, model.layout);
    model.sigma_factors.assign(problem.timeline->sensors().size(), 1.0);
    model.sigma_factors[static_cast<std::size_t>(problem.receiver)] =
        regimes.scale * (j == kOutlier ? regimes.outlier_ratio : 1.0);
  }
  return models;
}

ImmTape Filter(const RegimeProblem& problem, const ErrorRegimes& regimes) {
  const ExtendedProblem extended = Extend(problem, regimes);
  ImmOptions options;
  options.transition = regimes.transition;
  options.start = regimes.start;
  options.sensors = {problem.receiver};
  options.nominal = extended.nominal;
  options.decisions = problem.decisions;
  return RunImm(Models(problem, extended, regimes), options, problem.timeline,
                problem.callback)
      .tape;
}

/// Mean over the rows of E r' R^-1 r of a fix, R as stated: r has the smoothed
/// mean and covariance of a mode.
double NormalizedSquare(const TapeMeasurement& z, const Gaussian& smoothed,
                        double factor) {
  const Eigen::VectorXd r = z.residual - z.H * smoothed.mean;
  const Eigen::MatrixXd M =
      r * r.transpose() + z.H * smoothed.P * z.H.transpose();
  return factor * factor * z.R.llt().solve(M).trace() /
         static_cast<double>(r.size());
}

/// The maximisation step for scale, ratio and transition.
void Maximize(const RegimeProblem& problem, const ImmTape& tape,
              const ImmSmoothed& smoothed, ErrorRegimes* regimes) {
  // The prior counts as so many fixes.
  constexpr double kPrior = 5.0;
  double inliers = kPrior;
  double inlier_squares = kPrior;
  double outliers = 1.0;
  double outlier_squares = regimes->scale * regimes->scale *
                           regimes->outlier_ratio * regimes->outlier_ratio;
  Eigen::MatrixXd counts =
      kPrior * Initial(problem, regimes->kind, 0.0).transition;
  const std::size_t modes = tape.tapes.size();
  for (std::size_t k = 0; k < tape.size(); ++k) {
    if (smoothed.pairs[k].size() > 0) counts += smoothed.pairs[k];
    for (std::size_t j = 0; j < modes; ++j) {
      const double p =
          smoothed.trajectory.probabilities[k](static_cast<Eigen::Index>(j));
      if (p < 1e-6) continue;
      const double factor =
          regimes->scale * (j == kOutlier ? regimes->outlier_ratio : 1.0);
      for (const TapeMeasurement& z : tape.tapes[j].measurements(k)) {
        if (!z.accepted || z.sensor != problem.receiver) continue;
        const double square =
            NormalizedSquare(z, smoothed.models[k][j], factor);
        (j == kOutlier ? outliers : inliers) += p;
        (j == kOutlier ? outlier_squares : inlier_squares) += p * square;
      }
    }
  }
  constexpr double kLeastRatio = 3.0;
  constexpr double kLargestRatio = 1000.0;
  regimes->scale = std::sqrt(inlier_squares / inliers);
  regimes->outlier_ratio =
      std::clamp(std::sqrt(outlier_squares / outliers) / regimes->scale,
                 kLeastRatio, kLargestRatio);
  regimes->transition =
      counts.array().colwise() / counts.rowwise().sum().array();
}

/// Multiplies sigma and tau by steps that the likelihood asks for.
void SearchGaussMarkov(const RegimeProblem& problem, ErrorRegimes* regimes) {
  constexpr double kSteps[] = {3.0, 1.0 / 3.0};
  constexpr double kLargestTau = 1e4;
  regimes->log_likelihood = Filter(problem, *regimes).log_likelihood();
  for (double ErrorRegimes::*parameter :
       {&ErrorRegimes::tau, &ErrorRegimes::sigma}) {
    for (const double step : kSteps) {
      bool moved = false;
      for (int i = 0; i < 4; ++i) {
        ErrorRegimes trial = *regimes;
        trial.*parameter *= step;
        if (trial.tau > kLargestTau) break;
        trial.log_likelihood = Filter(problem, trial).log_likelihood();
        if (trial.log_likelihood <= regimes->log_likelihood) break;
        *regimes = trial;
        moved = true;
      }
      if (moved) break;
    }
  }
}

/// Scale, ratio, sigma and tau, and one for each mode beside the good one: the
/// transitions are held by their prior otherwise.
int ParameterCount(ErrorRegimes::Kind kind) {
  switch (kind) {
    case ErrorRegimes::Kind::kWhite:
      return 3;
    case ErrorRegimes::Kind::kGaussMarkov:
      return 5;
    case ErrorRegimes::Kind::kSwitching:
      return 7;
  }
  return 0;
}

}  // namespace

const char* RegimeName(ErrorRegimes::Kind kind) {
  static const char* const kNames[] = {"white", "gauss_markov", "switching"};
  return kNames[static_cast<int>(kind)];
}

std::vector<std::string> ErrorRegimes::ModeNames() const {
  if (kind != Kind::kSwitching) return {"good", "outlier"};
  return {"good", "outlier", "biased", "jump"};
}

Evolution ErrorEvolution(const ErrorRegimes& regimes, std::size_t mode) {
  if (regimes.kind == ErrorRegimes::Kind::kGaussMarkov || mode == kBiased) {
    return Evolution::GaussMarkov(regimes.sigma, regimes.tau);
  }
  if (mode == kOutlier) return Evolution::Constant();
  const double sigma =
      mode == kGood ? kZeroError * regimes.sigma : regimes.sigma;
  return Evolution::GaussMarkov(sigma, kForgotten);
}

ExtendedProblem Extend(const RegimeProblem& problem,
                       const ErrorRegimes& regimes) {
  ExtendedProblem out{problem.layout, problem.prior, problem.nominal};
  if (!regimes.HasGaussMarkov()) return out;
  const std::size_t mode =
      regimes.kind == ErrorRegimes::Kind::kSwitching ? kBiased : kGood;
  out.layout.Add(ErrorBlock(problem, regimes, mode));
  const auto extend = [&](State* x) {
    const Eigen::Index count = out.layout.parameter_count();
    x->parameters.conservativeResize(count);
    x->parameters.tail<3>().setZero();
  };
  extend(&out.prior.x);
  for (State& x : out.nominal) extend(&x);
  out.prior.P = WithBlock(problem.prior.P, out.layout);
  return out;
}

TunedRegimes TuneRegimes(const RegimeProblem& problem, ErrorRegimes::Kind kind,
                         double jump) {
  constexpr int kIterations = 3;
  TunedRegimes out;
  out.regimes = Initial(problem, kind, jump);
  for (int i = 0;; ++i) {
    if (i == 1 && out.regimes.HasGaussMarkov()) {
      SearchGaussMarkov(problem, &out.regimes);
    }
    const ImmTape tape = Filter(problem, out.regimes);
    out.regimes.log_likelihood = tape.log_likelihood();
    out.smoothed = SmoothImm(tape);
    if (i == kIterations) break;
    Maximize(problem, tape, out.smoothed, &out.regimes);
  }
  out.regimes.criterion =
      out.regimes.log_likelihood -
      0.5 * ParameterCount(kind) * std::log(std::max(2, FixCount(problem)));
  return out;
}

TunedRegimes ChooseRegimes(const RegimeProblem& problem) {
  TunedRegimes best = TuneRegimes(problem, ErrorRegimes::Kind::kWhite);
  // A sensor that is said to have a Gauss-Markov error has it already.
  if (problem.layout.Has(BlockKind::kColouredNoise, problem.receiver)) {
    return best;
  }
  const double outlier =
      best.regimes.scale * best.regimes.outlier_ratio * StatedSigma(problem);
  for (const auto kind :
       {ErrorRegimes::Kind::kGaussMarkov, ErrorRegimes::Kind::kSwitching}) {
    TunedRegimes tuned = TuneRegimes(problem, kind, outlier);
    if (tuned.regimes.criterion > best.regimes.criterion) {
      best = std::move(tuned);
    }
  }
  return best;
}

}  // namespace hindsight
