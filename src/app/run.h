#ifndef HINDSIGHT_APP_RUN_H_
#define HINDSIGHT_APP_RUN_H_

#include "alignment/start.h"
#include "app/run_request.h"

namespace hindsight {

/// Nothing tells where the IMU is, and no stream but magnetometers is there: what is
/// left is attitude alone.
class OnlyAttitude : public NoInitialPosition {
 public:
  using NoInitialPosition::NoInitialPosition;
};

/// Loads the data set, reconstructs it by every method asked for, writes the
/// results, prints the report and returns the exit status, which says the grade
/// of the best method. Throws OnlyAttitude before it writes anything.
int Reconstruct(const RunRequest& request);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_RUN_H_
