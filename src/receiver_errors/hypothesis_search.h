#ifndef HINDSIGHT_RECEIVER_ERRORS_HYPOTHESIS_SEARCH_H_
#define HINDSIGHT_RECEIVER_ERRORS_HYPOTHESIS_SEARCH_H_

#include "receiver_errors/mode_sequence.h"
#include "receiver_errors/search_effort.h"
#include "receiver_errors/sensor_tape.h"

namespace hindsight {

struct Hypothesis {
  ModeSequence sequence;
  double log_posterior = 0.0;  ///< but for a constant of the data
  /// How many hypotheses of about the same likelihood, with times next to these,
  /// this one stands for.
  double count = 1.0;
  ErrorParameters parameters = {};  ///< that it was scored with
};

/// The likeliest hypotheses of a receiver's error, best first: a Kalman filter
/// each, split at every fix into all steps that may follow, and into outlier and
/// none where odds leave it open, and pruned again
/// (Singer, Sea and Housewright, IEEE Trans. Inf. Theory 20(4), 1974; merging
/// of near ones as in Salmond, SPIE 1305, 1990). Unlike an IMM, which mixes
/// what its modes know at every fix, a sequence remembers when its error began,
/// so that one that begins too slowly for any single fix to show is found once
/// the fixes together do.
/// At most `width` hypotheses of each mode, and of each power of two of fixes
/// since what goes on began, stay after a fix; once the effort is spent, the
/// likeliest alone.
std::vector<Hypothesis> SearchHypotheses(const SensorTape& tape,
                                         const ErrorParameters& parameters,
                                         std::size_t width = 3,
                                         SearchEffort* effort = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_HYPOTHESIS_SEARCH_H_
