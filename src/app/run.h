#ifndef HINDSIGHT_APP_RUN_H_
#define HINDSIGHT_APP_RUN_H_

#include "app/run_request.h"

namespace hindsight {

/// Loads the data set, reconstructs it by every method asked for, writes the
/// results, prints the report and returns the exit status, which says the grade
/// of the best method.
int Reconstruct(const RunRequest& request);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_RUN_H_
