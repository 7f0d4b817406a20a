#ifndef HINDSIGHT_RECEIVER_ERRORS_OTHER_TELLINGS_H_
#define HINDSIGHT_RECEIVER_ERRORS_OTHER_TELLINGS_H_

#include <vector>

#include "receiver_errors/search_attempts.h"

namespace hindsight {

/// What else a jump to or from a bias may be: RolesExchanged, by a lasting bias as
/// large as the hypothesis's own errors. Their posteriors are not filled in.
std::vector<Attempt> ExchangedRoles(const RegimeProblem& problem,
                                    const Hypothesis& jumping);

/// What else a fix may be that noise takes for an outlier, beside a gap or an end of the
/// recording: right, and all others up to the next gap err, which hides where they begin
/// or end. The likeliest, by errors as large as the outlier; without a sequence if there
/// is none.
Attempt BestOutlierThatIsRight(const RegimeProblem& problem,
                               const Hypothesis& noise);

/// The likeliest of DriftsThatEnd, each by the rate that leads to errors as large
/// as the hypothesis's own and with no more noise of the IMU than stated; without a
/// sequence if there is none.
Attempt BestDriftThatEnds(const RegimeProblem& problem,
                          const Hypothesis& jumping);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_OTHER_TELLINGS_H_
