#include "receiver_errors/sequence_smoother.h"

#include <Eigen/Cholesky>

#include "receiver_errors/error_chain.h"
#include "state/covariance_series.h"

namespace hindsight {
namespace {

/// The sequence, node by node.
class Walk {
 public:
  Walk(const LinearTape& tape, int receiver, const ErrorParameters& parameters,
       const ModeSequence& sequence)
      : chain_(tape, receiver, parameters),
        steps_(StepsByNode(tape, receiver, sequence)),
        x_(chain_.Begin()) {}

  void PredictTo(std::size_t k) {
    chain_.MoveTo(k);
    x_ = chain_.PredictNavigation(x_);
    chain_.PredictError(steps_[k], &x_);
  }

  const ErrorChain& chain() const { return chain_; }
  const std::vector<ErrorStep>& steps() const { return steps_; }
  Gaussian* x() { return &x_; }

  ErrorChain::FixLikelihood Fix() const { return chain_.LikelihoodOfFix(x_); }

 private:
  ErrorChain chain_;
  std::vector<ErrorStep> steps_;
  Gaussian x_;
};

/// Carries lambda of x_s = x + P lambda back over an update,
/// lambda <- (I - K H)' lambda + H' S^-1 innovation.
void BackOver(const ErrorChain::Used& used, ErrorVector* lambda) {
  const Eigen::LLT<RowMatrix> llt(used.innovation.S);
  const RowVector gain =
      llt.solve(RowVector(used.innovation.residual - used.HP * *lambda));
  *lambda += used.z.H.transpose() * gain;
}

}  // namespace

SequenceScore ScoreSequence(const LinearTape& tape, int receiver,
                            const ErrorParameters& parameters,
                            const ModeSequence& sequence) {
  Walk walk(tape, receiver, parameters, sequence);
  SequenceScore score;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    walk.PredictTo(k);
    bool outlier = false;
    if (walk.chain().has_fix()) {
      const auto fix = walk.Fix();
      outlier = fix.outlier;
      score.log_likelihood += fix.log;
      score.log_prior +=
          LogTransition(k == 0 ? ErrorMode::kGood : walk.steps()[k - 1].mode,
                        walk.steps()[k], walk.chain().fix_count());
    }
    score.log_likelihood += walk.chain().UpdateAll(outlier, walk.x());
  }
  score.log_prior += LogOfVelocitySteps(CountVelocitySteps(sequence));
  return score;
}

std::vector<ErrorVector> SmoothSequence(const LinearTape& tape, int receiver,
                                        const ErrorParameters& parameters,
                                        const ModeSequence& sequence) {
  Walk walk(tape, receiver, parameters, sequence);
  const int n = walk.chain().dim();
  std::vector<ErrorVector> mean;
  CovarianceSeries P(n, tape.size());
  std::vector<std::vector<ErrorChain::Used>> used(tape.size());
  for (std::size_t k = 0; k < tape.size(); ++k) {
    walk.PredictTo(k);
    const bool outlier = walk.chain().has_fix() && walk.Fix().outlier;
    walk.chain().UpdateAll(outlier, walk.x(), &used[k]);
    mean.push_back(walk.x()->mean);
    P.Set(k, walk.x()->P);
  }
  ErrorVector lambda = ErrorVector::Zero(n);
  ErrorChain chain(tape, receiver, parameters);
  for (std::size_t k = tape.size(); k-- > 0;) {
    mean[k] += P.Get(k) * lambda;
    if (k == 0) break;
    for (std::size_t i = used[k].size(); i-- > 0;) {
      BackOver(used[k][i], &lambda);
    }
    chain.MoveTo(k);
    lambda = (chain.Phi(walk.steps()[k]).transpose() * lambda).eval();
  }
  return mean;
}

double MeanSquareDistance(const std::vector<ErrorVector>& a,
                          const std::vector<ErrorVector>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    sum += (a[k] - b[k]).head<2>().squaredNorm();
  }
  return sum / static_cast<double>(a.size());
}

}  // namespace hindsight
