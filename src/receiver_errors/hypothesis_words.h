#ifndef HINDSIGHT_RECEIVER_ERRORS_HYPOTHESIS_WORDS_H_
#define HINDSIGHT_RECEIVER_ERRORS_HYPOTHESIS_WORDS_H_

#include <string>
#include <vector>

#include "receiver_errors/weighed_hypotheses.h"
#include "state/covariance_series.h"

namespace hindsight {

/// How large the error of a hypothesis is at each node, and its unit.
struct ErrorSizes {
  std::vector<double> by_node;
  std::string unit;

  /// "8.2 m", in the root mean square over some nodes.
  std::string Over(std::size_t first, std::size_t past) const;
  /// The same of the largest.
  std::string Most(std::size_t first, std::size_t past) const;
};
/// `dim` errors stand before those of the sensor, which has three.
ErrorSizes SizesOf(const WeighedHypothesis& one, int dim,
                   const std::string& unit);

/// A sequence in words, "biased from 120 to 140 s by 8.2 m, drifting from 175 s to the
/// end by up to 15 m"; a bias or drift drawn anew begins a part of its own. `times` are those
/// of the nodes. "good throughout" if there is nothing to tell.
std::string DescribeSequence(const std::vector<ErrorStep>& steps,
                             const std::vector<double>& times,
                             const ErrorSizes& sizes);

/// The largest horizontal distance of two trajectories; whether it is more
/// than three standard deviations of P anywhere; and its mean square by P, the NEES of
/// the horizontal position if the other were right.
struct Separation {
  double distance = 0.0;
  bool significant = false;
  double nees = 0.0;
};
Separation Separate(const WeighedHypothesis& one,
                    const WeighedHypothesis& chosen, const CovarianceSeries& P);

/// The likeliest hypothesis that takes the trajectory elsewhere than `chosen`,
/// more than three standard deviations of P (errors of the chosen one's
/// horizontal position first) at some node.
struct RivalHypothesis {
  const WeighedHypothesis* hypothesis = nullptr;  ///< none: no such one
  double probability = 0.0;                       ///< of all such together
  double distance = 0.0;  ///< largest, horizontal [m], of the likeliest

  /// Than the chosen one and what is near it.
  bool IsLikelier() const { return probability > 0.5; }
};
RivalHypothesis FindRival(const std::vector<WeighedHypothesis>& all,
                          const WeighedHypothesis& chosen,
                          const CovarianceSeries& P);
/// The likeliest of those that would make P wrong if they were right: with a mean
/// NEES of the horizontal position above 25, where 2 is right.
RivalHypothesis FindRivalBeyond(const std::vector<WeighedHypothesis>& all,
                                const WeighedHypothesis& chosen,
                                const CovarianceSeries& P);

/// Of a bias: "sigma 0.5 m", "sigma 0.5 m (0.1 down)".
std::string DescribeSigma(const ErrorParameters& p, const std::string& unit);

/// What the noise of a sensor is like.
std::string DescribeNoise(ErrorRegimes::Kind kind, const ErrorParameters& p);
/// By what sigma the errors of a sequence's steps are taken for possible, a clause for
/// each kind; `unit` of the error; empty if they have none. Of a Gauss-Markov error whose correlation time is
/// longer than the recording, of `duration` [s], its walk, sqrt(2 / tau) sigma, in place
/// of that time, which nobody sees; its sigma down where it is another by half.
std::vector<std::string> DescribeErrors(const ModeSequence& steps,
                                        const ErrorParameters& p,
                                        const std::string& unit,
                                        double duration);
/// What else may have happened; empty where it is too improbable to be told. `dim` and
/// `unit` as of SizesOf.
std::string DescribeRival(const RivalHypothesis& rival,
                          const std::vector<double>& times, int dim,
                          const std::string& unit);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_HYPOTHESIS_WORDS_H_
