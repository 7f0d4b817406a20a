#ifndef HINDSIGHT_RECEIVER_ERRORS_ERROR_REGIMES_H_
#define HINDSIGHT_RECEIVER_ERRORS_ERROR_REGIMES_H_

#include <optional>
#include <vector>

#include "receiver_errors/bias_range.h"
#include "receiver_errors/hypothesis_search.h"
#include "receiver_errors/normal_points.h"
#include "receiver_errors/sensor_tape.h"

namespace hindsight {

/// What the errors of a sensor may be like. Beyond noise
///   stated        none: the noise is as stated, without outliers
///   white         none: the noise has another scale, and outliers
///   gauss_markov  all fixes share a Gauss-Markov error
///   switching     the sensor is good, biased (by a Gauss-Markov error) or
///                 drifting, as a mode sequence says
///                 (receiver_errors/mode_sequence.h)
struct ErrorRegimes {
  enum class Kind { kStated, kWhite, kGaussMarkov, kSwitching };
  Kind kind = Kind::kStated;
  /// The likeliest first; with kSwitching, others that the data do not rule out,
  /// each with the parameters of the fit that likes it best.
  std::vector<Hypothesis> hypotheses;
  /// ln of the evidence: of likelihood and prior of the sequence of the first
  /// hypothesis, integrated over its parameters (LogShareOfPrior).
  double log_evidence = 0.0;
  /// Of kGaussMarkov, with sigma and tau by which covariances are told: what
  /// BiasRange::expected is.
  std::optional<ErrorParameters> expected = std::nullopt;
  /// BiasRange::slight of the same.
  std::optional<SlightBias> slight = std::nullopt;
};

/// Of one fit: the likeliest, and others about as likely, which nothing may ever tell from
/// it.
using MetHypotheses = std::vector<Hypothesis>;
MetHypotheses LikelyOf(const ErrorRegimes& fit);

/// "stated", "white", "gauss_markov", "switching".
const char* RegimeName(ErrorRegimes::Kind kind);

/// The data about a fixed nominal trajectory.
struct RegimeProblem {
  const SensorTape& tape;
  double stated_sigma = 1.0;  ///< of its fixes, an axis
  bool only_white = false;    ///< other errors are not compared with white ones
  SearchEffort* effort = nullptr;  ///< must not be
  /// The layout has a Gauss-Markov error of the sensor already: it may err beyond
  /// that, but not by another one.
  bool has_gauss_markov = false;
  /// Its sigma is the tolerance of a constraint, which may hold as exactly as it likes:
  /// the least factor on it means nothing.
  bool is_tolerance = false;
  /// Its clock is estimated: what errs may have turned it, beside which fixes without
  /// errors look like some with such.
  bool has_clock = false;
  /// What searches about other tapes have met of it.
  std::vector<MetHypotheses> met = {};
};

/// Every kind as fitted to the data, the simplest first; of kSwitching several,
/// from different starts, or none where no error is found. Parameters - scale,
/// share and size of outliers, the factor on the noise of the IMU, sigma and
/// correlation time of the Gauss-Markov errors, sigma of the rate of drifts -
/// maximise the likelihood of the fixes, a mixture of two normal densities each
/// (as in Pfeifer and Protzel, ICRA 2019), times their priors
/// (receiver_errors/error_tuning.h). Sequences are sought from several sizes of
/// errors, in turn with fits of the parameters to what was found; the best with
/// different orders of modes are refined, each with parameters of its own, and so is the
/// likeliest of RegimeProblem::met. Ends
/// early, with what there is, once the effort is spent; with no switching ones where it
/// was stopped before the parameters of the others were fitted.
std::vector<ErrorRegimes> FitRegimes(const RegimeProblem& problem);

/// Regimes found on normal points, refined on all fixes (`problem`): the noise is
/// fitted again, change points move to fixes.
ErrorRegimes RefineAtFixes(const RegimeProblem& problem,
                           const NormalPoints& points,
                           const ErrorRegimes& found);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_ERROR_REGIMES_H_
