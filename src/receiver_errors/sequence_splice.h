#ifndef HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_SPLICE_H_
#define HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_SPLICE_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "base/paged_rows.h"
#include "receiver_errors/error_chain.h"
#include "receiver_errors/later_likelihood.h"
#include "receiver_errors/sequence_smoother.h"
#include "state/covariance_series.h"

namespace hindsight {

/// Scores hypotheses that differ from a base sequence over few fixes, as
/// ScoreSequence does, by a filter over those few alone. It begins with what the
/// base's filter knew before them, (m, P), and is joined to what the base's
/// backward filter has of all measurements after them, as a function of the
/// error there,
///   ln L(x) = c - |U x - z|^2 / 2   (receiver_errors/later_likelihood.h).
/// Neither Q nor P is inverted: both are singular where the receiver is good.
/// The combination of two filters is Mayne's (Automatica 4, 1966) and Fraser
/// and Potter's (IEEE Trans. Autom. Control 14(4), 1969); the square root is
/// that of filters/information.h, c was derived for this program.
///
/// The density of a fix is a mixture, whose logarithm exceeds that of the
/// Gaussian that the filter updates with; by how much, and whether the fix is
/// taken for an outlier, depends on all before it. After the join both are the
/// base's. So that they are nearly the sequence's own, the filter goes on after
/// the last difference until five fixes in a row are taken as in the base, the
/// excess of each the same to 1e-4. All else is exact: the score differs from
/// ScoreSequence's by what later excesses differ, in tests 3e-4 on average and
/// at most 1e-2 at an outlier share of 0.02, nothing as the share goes to zero.
/// Were a still later fix taken otherwise, the score would be that under the
/// base's decision.
class SequenceSplice {
 public:
  /// The tape must outlive this. Throws EstimationError if the noise of a
  /// measurement is not positive definite.
  SequenceSplice(const SensorTape& tape, const ErrorParameters& parameters,
                 const ModeSequence& base);
  SequenceSplice(SensorTape&& tape, const ErrorParameters& parameters,
                 const ModeSequence& base) = delete;

  struct Spliced : SequenceScore {
    std::size_t steps = 0;  ///< nodes that a filter has passed for it
  };
  /// Score of a sequence of the base's length, from any thread. The cost grows with the
  /// span from the first to the last fix at which it differs from the base.
  Spliced Score(const ModeSequence& sequence) const;
  /// Whether a sequence that takes fix i for an outlier, alone, may have a higher score:
  /// by a filter that is joined right behind it. That leaves later fixes the excesses and
  /// the decisions of the base, so that it is sought only where none of the thirty fixes
  /// behind, which feel it most, is an outlier in the base or nearly one (odds of less
  /// than e^2), and may be where the base has fix i for one. From any thread, at the cost
  /// of a node.
  bool MayBeBetter(const ModeSequence& sequence, std::size_t i) const;

  const ModeSequence& base() const { return base_; }
  /// What the base's filter knows before the interval that leads to the node of
  /// fix i, and the mode there.
  struct Before {
    std::size_t node = 0;  ///< of the fix
    ErrorMode mode = ErrorMode::kGood;
    Gaussian x;
  };
  Before BeforeFix(std::size_t i) const;
  /// Whether the base takes fix i for none by odds less than
  /// ErrorChain::kSureLogOdds.
  bool MayBeAnOutlier(std::size_t i) const;
  /// What all measurements after the node of fix i say, as the base has them.
  LaterLikelihood After(std::size_t i) const;

 private:
  /// A filter on its way: the next node and fix, the mode and what is known
  /// before them.
  struct Place {
    std::size_t node = 0;
    std::size_t fix = 0;
    ErrorMode mode = ErrorMode::kGood;
    Gaussian x;
    Spliced score;  ///< of all before
  };
  /// How a fix was taken.
  struct Taken {
    bool outlier = false;
    double excess = 0.0;    ///< ln of its mixture less ln of its Gaussian
    double log_odds = 0.0;  ///< of being no outlier
  };
  /// The base at a fix.
  struct AtFix {
    std::size_t node = 0;
    SequenceScore before;  ///< of all nodes before
    Taken taken;
    double log_prior = 0.0;  ///< of all steps up to it
    double c = 0.0;
  };

  /// But for what several velocity steps cost together.
  Spliced ScoreWithoutPrice(const ModeSequence& sequence) const;
  /// Takes the next node; false if it has no fix.
  static bool Pass(const ModeSequence& sequence, ErrorChain* chain, Place* at,
                   Taken* taken);
  /// Whether any of thirty fixes behind fix i is an outlier in the base or nearly one.
  bool IsInDoubtBehind(std::size_t i) const;
  void RunForward();
  void RunBackward();
  Place PlaceBefore(std::size_t i) const;
  /// None where P is too near to singular for the U there.
  std::optional<Spliced> Joined(std::size_t i, const Place& after) const;

  const SensorTape& tape_;
  ErrorParameters parameters_;
  ErrorChain chain_;  ///< of the base
  ModeSequence base_;
  std::vector<AtFix> fixes_;
  SequenceScore total_;
  // By fix: before the interval that leads to its node, and after its update.
  Eigen::MatrixXd mean_;
  CovarianceSeries P_;
  PagedRows U_;  ///< column by column
  Eigen::MatrixXd z_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_SPLICE_H_
