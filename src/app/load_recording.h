#ifndef HINDSIGHT_APP_LOAD_RECORDING_H_
#define HINDSIGHT_APP_LOAD_RECORDING_H_

#include "app/run_request.h"
#include "dataset/dataset.h"
#include "io/config/config.h"

namespace hindsight {

/// The data set as a run reconstructs it, and its resolved configuration: with
/// the withholding and the injected errors that the run asks for, unknown
/// mountings found, and rests that need an estimate. Throws InputError.
Dataset LoadRecording(const RunRequest& request, ResolvedConfig* resolved);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_LOAD_RECORDING_H_
