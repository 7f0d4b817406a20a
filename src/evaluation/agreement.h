#ifndef HINDSIGHT_EVALUATION_AGREEMENT_H_
#define HINDSIGHT_EVALUATION_AGREEMENT_H_

#include <string>
#include <vector>

#include "evaluation/grade.h"

namespace hindsight {

/// How far apart two estimates of the same state are, of which the one knows
/// what the other does not.
struct AgreementFigure {
  std::string what;  ///< a clause: "the velocity before and after it differs"
  double t = 0.0;    ///< [s]
  double distance = 0.0;  ///< in sigmas of the difference
  /// That any of all figures of a right model reaches with the rate of false
  /// alarms.
  double limit = 0.0;
};

/// Doubtful: estimates of one state from both sides, or of the filter and the
/// smoother, that are kDoubtfulError times as far apart as chance explains. The
/// farthest beyond its limit is told.
void FindDisagreeingSides(const Judged& judged,
                          std::vector<Evidence>* evidence);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_AGREEMENT_H_
