#ifndef HINDSIGHT_PROBLEMS_ERROR_REGIMES_H_
#define HINDSIGHT_PROBLEMS_ERROR_REGIMES_H_

#include <string>
#include <vector>

#include "filters/imm_smoother.h"

namespace hindsight {

/// What the errors of a receiver are like, as found in its own data. Inliers
/// have `scale` times the stated sigma, outliers `outlier_ratio` times that of
/// inliers. Beyond that
///   white         nothing: modes good, outlier
///   gauss_markov  all fixes share a Gauss-Markov error: modes good, outlier
///   switching     the receiver is good, or biased by a Gauss-Markov error that
///                 begins with a jump or creeps in: modes good (error zero),
///                 outlier (error as before), biased (error goes on), jump
///                 (error drawn anew)
struct ErrorRegimes {
  enum class Kind { kWhite, kGaussMarkov, kSwitching };
  Kind kind = Kind::kWhite;
  double scale = 1.0;
  double outlier_ratio = 10.0;
  double sigma = 0.0;          ///< stationary, of the Gauss-Markov error [m]
  double tau = 0.0;            ///< its correlation time [s]
  Eigen::MatrixXd transition;  ///< between the modes, from fix to fix
  Eigen::VectorXd start;       ///< probabilities of the modes at first
  double log_likelihood = 0.0;
  /// log_likelihood - (parameters / 2) ln(fixes): Schwarz's criterion.
  double criterion = 0.0;

  std::vector<std::string> ModeNames() const;
  bool HasGaussMarkov() const { return kind != Kind::kWhite; }
};

/// "white", "gauss_markov", "switching".
const char* RegimeName(ErrorRegimes::Kind kind);

/// The data about a fixed nominal trajectory.
struct RegimeProblem {
  const ErrorLayout& layout;  ///< without the receiver's own error
  const Prior& prior;
  const std::vector<State>& nominal;
  int receiver = 0;  ///< index of the position sensor
  Timeline* timeline;
  GateDecisions decisions;
  EpochCallback callback;
};

/// Layout, prior and nominal with the receiver's Gauss-Markov error behind all
/// other blocks, or as they are.
struct ExtendedProblem {
  ErrorLayout layout;
  Prior prior;
  std::vector<State> nominal;
};
ExtendedProblem Extend(const RegimeProblem& problem,
                       const ErrorRegimes& regimes);

/// The receiver's error in a mode: its evolution.
Evolution ErrorEvolution(const ErrorRegimes& regimes, std::size_t mode);

struct TunedRegimes {
  ErrorRegimes regimes;
  ImmSmoothed smoothed;  ///< modes in the order of ModeNames
};

/// Fits a kind of regimes to the data: expectation-maximisation over the modes
/// for scale, ratio and transition (the expectations are those of SmoothImm;
/// Dempster, Laird and Rubin 1977; for mixtures of noise, Pfeifer and Protzel,
/// ICRA 2019), a pattern search of the filter's likelihood for sigma and tau.
/// Weak priors keep what the data do not show near its start. `jump` is a guess
/// of the size of a bias, where it is more than ten stated sigmas [m].
TunedRegimes TuneRegimes(const RegimeProblem& problem, ErrorRegimes::Kind kind,
                         double jump = 0.0);

/// The kind with the largest criterion. No truth takes part. The outliers of
/// the white kind tell the others what size of bias to begin with.
TunedRegimes ChooseRegimes(const RegimeProblem& problem);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ERROR_REGIMES_H_
