#ifndef HINDSIGHT_APP_FINISHED_RUNS_H_
#define HINDSIGHT_APP_FINISHED_RUNS_H_

#include <functional>
#include <utility>
#include <vector>

#include "app/result_folder.h"
#include "problems/montecarlo.h"

namespace hindsight {

/// Standard deviations are over two runs or more.
inline constexpr int kLeastRuns = 2;

/// Runs behind the figures of a comparison.
inline int RunsOf(const MonteCarloResult& result) { return result.runs; }
template <typename Statistics>
int RunsOf(const std::vector<Statistics>& result) {
  return result.empty() ? 0 : result.front().runs;
}

/// Has an early end leave report(result, false) of the runs that are finished
/// then; `report` gives the files of a result, complete or not.
template <typename Result>
Watch<Result> KeepFinishedRuns(
    ResultFolder* folder,
    std::function<std::vector<OutputFile>(const Result&, bool complete)>
        report) {
  return [folder, report = std::move(report)](std::function<Result()> so_far) {
    folder->KeepAtEnd([so_far, report]() -> std::vector<OutputFile> {
      const Result result = so_far();
      if (RunsOf(result) < kLeastRuns) return {};
      return report(result, false);
    });
  };
}

/// Writes the files and puts them in place.
inline void CommitFiles(const std::vector<OutputFile>& files,
                        ResultFolder* folder) {
  for (const OutputFile& file : files) folder->Write(file);
  folder->Commit();
}

}  // namespace hindsight

#endif  // HINDSIGHT_APP_FINISHED_RUNS_H_
