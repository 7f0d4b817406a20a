#ifndef HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_TRIALS_H_
#define HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_TRIALS_H_

#include <cstddef>
#include <exception>
#include <optional>
#include <unordered_set>
#include <vector>

#include "receiver_errors/sequence_splice.h"

namespace hindsight {

/// A sequence to be scored about a base.
struct SequenceTrial {
  ModeSequence sequence;
  double count = 1.0;  ///< as Hypothesis has it
  /// Fix at which alone it differs from the base, as an outlier or none.
  std::optional<std::size_t> outlier = std::nullopt;
};

struct TrialScore {
  std::size_t hash = 0;  ///< of the sequence
  bool is_new = false;   ///< else neither scored here nor to be kept
  /// None if it cannot be better than the base; of a filter that breaks down
  /// -1e300.
  std::optional<double> log_posterior;
  std::size_t steps = 0;       ///< nodes that a filter has passed
  std::exception_ptr failure;  ///< an EstimationError
};

/// The same of equal sequences; of others different but for chance of 2^-64.
std::size_t HashOf(const ModeSequence& sequence);

/// Scores of the trials, in their order, by all threads, which give the same for
/// any number of them. What `tried` has by its hash, or an earlier trial has, is
/// not scored.
std::vector<TrialScore> ScoresOf(const std::vector<SequenceTrial>& trials,
                                 const SequenceSplice& splice,
                                 const std::unordered_set<std::size_t>& tried);

/// Of how much less likely ones LikeliestBehind returns the likeliest.
struct ScoresBehind {
  double nearest = 0.0;   ///< [ln]
  double farthest = 0.0;  ///< [ln]
  std::size_t most = 0;
};
/// Sequences that were scored so far behind `level`, the likeliest first.
std::vector<ModeSequence> LikeliestBehind(
    const std::vector<SequenceTrial>& trials,
    const std::vector<TrialScore>& scores, double level,
    const ScoresBehind& asked);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_TRIALS_H_
