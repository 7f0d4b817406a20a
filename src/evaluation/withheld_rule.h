#ifndef HINDSIGHT_EVALUATION_WITHHELD_RULE_H_
#define HINDSIGHT_EVALUATION_WITHHELD_RULE_H_

#include <span>
#include <vector>

#include "evaluation/grade.h"

namespace hindsight {

/// Residuals of the withheld measurements of one row of a sensor, over their
/// predicted standard deviations: of a right model N(0, 1), but as correlated as
/// the errors of the trajectory that predicts them. Their mean square is about
/// chi^2(m)/m with m independent ones, m = n / (1 + 2 sum rho_k^2), the sum to
/// the first of their autocorrelations that is not positive (Bartlett 1946).
struct WithheldFigure {
  int sensor = 0;
  int row = 0;
  std::size_t count = 0;
  double independent = 0.0;  ///< m
  double mean = 0.0;         ///< [sigma]
  double rms = 0.0;          ///< [sigma]
  double beyond = 0.0;       ///< share beyond 3 sigmas
  /// sqrt(mean square / q), q what a right model exceeds with the rate of false
  /// alarms.
  double excess = 0.0;
};

/// Of every row of every sensor that has kFewestInnovations or more withheld.
/// `false_alarms`: probability that any excess of a right model is above 1.
std::vector<WithheldFigure> TestWithheld(
    std::span<const ResidualRecord> residuals, double false_alarms);

/// Withheld measurements that are kDoubtfulError times as far off as chance
/// explains make a solution doubtful; those of a systematic error of
/// kUnusableBias not usable, if other measurements of the sensor are used, which
/// vouch for it. What was withheld of a sensor with a robust loss is not judged.
void FindOddPredictions(const Judged& judged, std::vector<Evidence>* evidence);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_WITHHELD_RULE_H_
