#ifndef HINDSIGHT_APP_LOAD_RECORDING_H_
#define HINDSIGHT_APP_LOAD_RECORDING_H_

#include "app/run_request.h"
#include "dataset/dataset.h"
#include "io/config/config.h"
#include "io/read/file_digest.h"

namespace hindsight {

/// The data set as a run reconstructs it, and its resolved configuration: with
/// the withholding and the injected errors that the run asks for, unknown
/// mountings found, and rests that need an estimate. Digests of files go to `digests`
/// where reading makes them. Throws InputError.
Dataset LoadRecording(const RunRequest& request, ReadDigests* digests,
                      ResolvedConfig* resolved);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_LOAD_RECORDING_H_
