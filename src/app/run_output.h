#ifndef HINDSIGHT_APP_RUN_OUTPUT_H_
#define HINDSIGHT_APP_RUN_OUTPUT_H_

#include <optional>
#include <string>
#include <vector>

#include "app/method_output.h"
#include "app/result_folder.h"
#include "app/run_request.h"
#include "evaluation/truth_comparison.h"
#include "io/config/config.h"
#include "io/write/summary.h"
#include "problems/reconstruction.h"

namespace hindsight {

/// "hindsight 0.1.0", as results name the program.
extern const char* const kProgram;

/// That the data are not as recorded; empty if they are.
std::string InjectionRemark(const Dataset& dataset);

/// The program and the remark, as comments of files have them.
std::string ProgramLine(const Dataset& dataset);

/// Name of the file with the figures of a run.
inline constexpr char kSummaryName[] = "summary.json";

OutputRequest OutputOf(const RunRequest& request);

/// How its configuration is read.
LoadOptions LoadOptionsOf(const RunRequest& request);

/// All files that the run reads, and those of streams that it leaves out.
ResultFolder::Paths InputsOf(const RunRequest& request);

/// The files that the run reads, without those of streams left out.
ResultFolder::Paths FilesReadBy(const RunRequest& request);

/// Tables of a method's solution beside its output (MethodOutput).
struct MethodTables {
  SolutionTable at;  ///< METHOD.at.csv, at the times of --at
  /// At the truth's times and the point it speaks of: what is compared with it. Of
  /// attitude alone it is the solution itself, which has each sample of the IMU.
  SolutionTable truth;
  SolutionTruth reference;  ///< that truth (TruthOf)
  std::optional<TruthComparison> comparison =
      {};  ///< of `truth` with the truth
};

/// Throws InputError if a time of --at is outside the solution's span, if it has one.
void CheckTimesCovered(const RunRequest& request, const Solution& solution);

/// Samples the solution through the IMU, once for the tables and for the
/// output, which takes its rows meanwhile: the nodes, or at --rate, and those at the
/// truth's times, but of attitude alone, which has them anyway. Nothing for a
/// solution without states.
MethodTables SampleMethod(const RunRequest& request, const Dataset& dataset,
                          const Reconstruction& reconstruction,
                          const Solution& solution, MethodOutput* output);

/// Fills `comparison`, if there is a truth.
void CompareTables(const Dataset& dataset, MethodTables* tables);

/// Writes the tables that have rows, mode probabilities, errors against the
/// truth and constants over time; nothing for a solution without states.
void WriteMethodFiles(const Dataset& dataset, const Solution& solution,
                      const MethodTables& tables, ResultFolder* folder);

/// Writes report.html, the page that shows what the folder holds so far.
void WriteReport(const RunRequest& request, const RunSummary& summary,
                 ResultFolder* folder);

/// The line that says where the page is; "" without.
std::string DescribeReport(const RunRequest& request);

/// The figures of one solution; of one without states, only that it failed.
MethodSummary Summarize(const Dataset& dataset, const Solution& solution,
                        const MethodTables& tables);

/// The most memory that the process has held [MB].
double PeakRssMb();

/// Nothing of no report.
std::optional<StartSummary> SummarizeStart(const StartReport* start);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_RUN_OUTPUT_H_
