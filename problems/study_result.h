#ifndef HINDSIGHT_PROBLEMS_STUDY_RESULT_H_
#define HINDSIGHT_PROBLEMS_STUDY_RESULT_H_

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "evaluation/run_table.h"
#include "evaluation/series_fold.h"

namespace hindsight {

/// \file
/// From the records of runs to the figures of a study.

/// What one case made of some runs.
struct CaseRuns {
  /// By run; empty of those that are not there.
  std::map<int, std::vector<RunRecord>> records;
  FoldTree folds;  ///< of their series, which the records have no more

  /// The records of a run that is not there yet.
  void Add(int run, std::vector<RunRecord> of_run);
};

/// What all cases of a study made of the runs begin to end - 1.
struct StudyShard {
  int begin = 0;
  int end = 0;
  std::vector<CaseRuns> cases;

  /// The runs that follow, of the same study. Throws std::invalid_argument for
  /// others.
  void Append(StudyShard next);
};

/// What is known of a study: of all its cases the seeds of all, or of those that
/// are finished; of a study of one case the first seeds without a gap.
struct StudyResult {
  int runs = 0;  ///< behind every row
  bool complete = true;
  std::vector<StudyTable> tables;
  std::vector<std::vector<FigureRow>> rows;  ///< by table
  std::vector<RunRecord> records;
  /// A line each run whose data were refused: case, method, seed, what is wrong.
  std::vector<std::string> refusals;

  /// Of runs from 0 on, of which so many cases have all.
  StudyResult(const std::vector<StudyTable>& of, const StudyShard& shard,
              std::size_t finished);

  /// Data were refused and no run was answered.
  bool refused() const;
  /// Throws InputError with the first refusal if that is so.
  void RequireAnswer() const;

 private:
  /// What a case made of its runs 0 to first_runs - 1.
  void Add(const CaseRuns& one, int first_runs);
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_STUDY_RESULT_H_
