#ifndef HINDSIGHT_APP_RUN_OUTPUT_H_
#define HINDSIGHT_APP_RUN_OUTPUT_H_

#include <vector>

#include "app/result_folder.h"
#include "app/run_request.h"
#include "io/summary.h"
#include "problems/reconstruction.h"

namespace hindsight {

/// "hindsight 0.1.0", as results name the program.
extern const char* const kProgram;

/// Name of the file with the figures of a run.
inline constexpr char kSummaryName[] = "summary.json";

OutputRequest OutputOf(const RunRequest& request);

/// All files that the run reads.
ResultFolder::Paths InputsOf(const RunRequest& request);

/// Writes METHOD.csv, METHOD.at.csv and the exports of one solution, nothing
/// for one without states. Throws InputError if a time of --at is outside its
/// span.
void WriteMethodFiles(const RunRequest& request, const Dataset& dataset,
                      const Reconstruction& reconstruction,
                      const Solution& solution, const ResultFolder& folder);

/// The figures of one solution; of one without states, only that it failed. It
/// is compared with the truth as sampled through the IMU at the truth's times,
/// so that nothing is interpolated.
MethodSummary Summarize(const Dataset& dataset,
                        const Reconstruction& reconstruction,
                        const Solution& solution);

/// Leaves out truth points closer than 0.1 s to the one before: a trajectory
/// says nothing new in between, and samples with covariances are large.
void ThinTruth(std::vector<TruthPoint>* truth);

StartSummary SummarizeStart(const StartReport& start);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_RUN_OUTPUT_H_
