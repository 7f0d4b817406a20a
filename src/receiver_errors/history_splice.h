#ifndef HINDSIGHT_RECEIVER_ERRORS_HISTORY_SPLICE_H_
#define HINDSIGHT_RECEIVER_ERRORS_HISTORY_SPLICE_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "receiver_errors/error_chain.h"
#include "receiver_errors/history_smoother.h"
#include "state/covariance_series.h"

namespace hindsight {

/// Scores histories that differ from a base history over few fixes, as
/// ScoreHistory does, by a filter over those few alone. It begins with what the
/// base's filter knew before them, (m, P), and is joined to what the base's
/// backward filter has of all measurements after them, as a function of the
/// error there,
///   ln L(x) = c - |U x - z|^2 / 2.
/// Back over x+ = Phi x + d + w, w ~ (0, Q), with G G' = I + U Q U',
///   c <- c - ln det G,   z <- G^-1 (z - U d),   U <- G^-1 U Phi;
/// a measurement's whitened rows are added by an orthogonal transformation,
/// what is left of them goes into c. Joined, with G G' = I + U P U',
///   ln E[L] = c - ln det G - |G^-1 (z - U m)|^2 / 2.
/// Neither Q nor P is inverted: both are singular where the receiver is good.
/// The combination of two filters is Mayne's (Automatica 4, 1966) and Fraser
/// and Potter's (IEEE Trans. Autom. Control 14(4), 1969); the square root is
/// that of filters/information.h, c was derived for this program.
///
/// The density of a fix is a mixture, whose logarithm exceeds that of the
/// Gaussian that the filter updates with; by how much, and whether the fix is
/// taken for an outlier, depends on all before it. After the join both are the
/// base's. So that they are nearly the history's own, the filter goes on after
/// the last difference until five fixes in a row are taken as in the base, the
/// excess of each the same to 1e-4. All else is exact: the score differs from
/// ScoreHistory's by what later excesses differ, in tests 3e-4 on average and
/// at most 1e-2 at an outlier share of 0.02, nothing as the share goes to zero.
/// Were a still later fix taken otherwise, the score would be that under the
/// base's decision.
class HistorySplice {
 public:
  /// The tape must outlive this. Throws EstimationError if the noise of a
  /// measurement is not positive definite.
  HistorySplice(const LinearTape& tape, int receiver,
                const ErrorParameters& parameters, const ErrorHistory& base);

  /// Score of a history of the base's length. The cost grows with the span from
  /// the first to the last fix at which it differs from the base.
  HistoryScore Score(const ErrorHistory& history);

 private:
  /// A filter on its way: the next node and fix, the mode and what is known
  /// before them.
  struct Place {
    std::size_t node = 0;
    std::size_t fix = 0;
    ErrorMode mode = ErrorMode::kGood;
    Gaussian x;
    HistoryScore score;  ///< of all before
  };
  /// How a fix was taken.
  struct Taken {
    bool outlier = false;
    double excess = 0.0;  ///< ln of its mixture less ln of its Gaussian, the
                          ///< latter where it stands among the node's
                          ///< measurements
  };
  /// The base at a fix.
  struct AtFix {
    std::size_t node = 0;
    HistoryScore before;  ///< of all nodes before
    Taken taken;
    double log_prior = 0.0;  ///< of all steps up to it
    double c = 0.0;
  };

  /// Takes the next node; false if it has no fix.
  bool Pass(const ErrorHistory& history, Place* at, Taken* taken);
  void RunForward();
  void RunBackward();
  Place PlaceBefore(std::size_t i) const;
  /// None where P is too near to singular for the U there.
  std::optional<HistoryScore> Joined(std::size_t i, const Place& after) const;

  ErrorChain chain_;
  ErrorHistory base_;
  std::vector<AtFix> fixes_;
  HistoryScore total_;
  // By fix: before the interval that leads to its node, and after its update.
  Eigen::MatrixXd mean_;
  CovarianceSeries P_;
  Eigen::MatrixXd U_;  ///< dim() columns each
  Eigen::MatrixXd z_;
  std::vector<ErrorChain::Used> used_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_HISTORY_SPLICE_H_
