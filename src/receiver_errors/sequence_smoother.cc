#include "receiver_errors/sequence_smoother.h"

#include <Eigen/Cholesky>

#include "receiver_errors/error_chain.h"
#include "state/covariance_series.h"

namespace hindsight {
namespace {

/// The sequence, node by node.
class Walk {
 public:
  Walk(const SensorTape& tape, const ErrorParameters& parameters,
       const ModeSequence& sequence)
      : chain_(tape, parameters),
        steps_(StepsByNode(tape, sequence)),
        x_(chain_.Begin()) {}

  void PredictTo(std::size_t k) {
    chain_.MoveTo(k);
    chain_.PredictNavigation(&x_);
    chain_.PredictError(steps_[k], &x_);
  }

  const ErrorChain& chain() const { return chain_; }
  const std::vector<ErrorStep>& steps() const { return steps_; }
  const Gaussian& x() const { return x_; }

  ErrorChain::NodeLikelihood UpdateAt(
      std::size_t k, std::vector<ErrorChain::Used>* used = nullptr) {
    return chain_.UpdateWithFix(steps_[k], &x_, used);
  }

 private:
  ErrorChain chain_;
  std::vector<ErrorStep> steps_;
  Gaussian x_;
};

/// An update, in no more memory than it needs.
struct PassedUpdate {
  explicit PassedUpdate(const ErrorChain::Used& used)
      : H(used.z.H.leftCols(used.HP.cols())),
        HP(used.HP),
        S(used.innovation.S),
        innovation(used.innovation.residual) {}

  Eigen::MatrixXd H;
  Eigen::MatrixXd HP;
  Eigen::MatrixXd S;
  Eigen::VectorXd innovation;
};

/// Carries lambda of x_s = x + P lambda back over an update,
/// lambda <- (I - K H)' lambda + H' S^-1 innovation.
/// Components that the filter did not have are lost at the next Phi', which has zeros
/// for them.
void BackOver(const PassedUpdate& passed, ErrorVector* lambda) {
  const Eigen::LLT<Eigen::MatrixXd> llt(passed.S);
  auto seen = lambda->head(passed.H.cols());
  const Eigen::VectorXd gain = llt.solve(passed.innovation - passed.HP * seen);
  seen += passed.H.transpose() * gain;
}

}  // namespace

SequenceScore ScoreSequence(const SensorTape& tape,
                            const ErrorParameters& parameters,
                            const ModeSequence& sequence) {
  Walk walk(tape, parameters, sequence);
  SequenceScore score;
  bool first = true;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    walk.PredictTo(k);
    if (walk.chain().has_fix()) {
      const ErrorStep step = walk.steps()[k];
      const double share = walk.chain().share();
      score.log_prior +=
          first ? LogFirst(step, share)
                : LogTransition(walk.steps()[k - 1].mode, step, share);
      first = false;
    }
    const auto at_node = walk.UpdateAt(k);
    score.log_likelihood += at_node.fix.log + at_node.others;
  }
  score.log_prior += LogOfVelocitySteps(CountVelocitySteps(sequence));
  return score;
}

ErrorTrajectory SmoothSequence(const SensorTape& tape,
                               const ErrorParameters& parameters,
                               const ModeSequence& sequence) {
  Walk walk(tape, parameters, sequence);
  const int n = walk.chain().dim();
  ErrorTrajectory mean(n, tape.size());
  CovarianceSeries P(n, tape.size());
  std::vector<std::vector<PassedUpdate>> passed(tape.size());
  std::vector<ErrorChain::Used> used;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    walk.PredictTo(k);
    used.clear();
    walk.UpdateAt(k, &used);
    for (const ErrorChain::Used& one : used) passed[k].emplace_back(one);
    const Gaussian x = ErrorChain::Resized(walk.x(), n);
    mean[k] = x.mean;
    P.Set(k, x.P);
  }
  ErrorVector lambda = ErrorVector::Zero(n);
  ErrorChain chain(tape, parameters);
  for (std::size_t k = tape.size(); k-- > 0;) {
    mean[k] += P.Get(k) * lambda;
    if (k == 0) break;
    for (std::size_t i = passed[k].size(); i-- > 0;) {
      BackOver(passed[k][i], &lambda);
    }
    chain.MoveTo(k);
    lambda = (chain.Phi(walk.steps()[k]).transpose() * lambda).eval();
  }
  return mean;
}

double MeanSquareDistance(const ErrorTrajectory& a, const ErrorTrajectory& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    sum += (a[k] - b[k]).head<2>().squaredNorm();
  }
  return sum / static_cast<double>(a.size());
}

}  // namespace hindsight
