#ifndef HINDSIGHT_TESTS_SUPPORT_STUDY_H_
#define HINDSIGHT_TESTS_SUPPORT_STUDY_H_

#include <stdexcept>
#include <string>
#include <vector>

#include "problems/montecarlo.h"

namespace hindsight::testing {

/// All runs of a study.
inline StudyResult RunStudy(const Study& study,
                            const MonteCarloOptions& options) {
  StudyRun run(study, options, 0, options.runs);
  run.Do();
  const StudyResult result = run.SoFar();
  result.RequireAnswer();
  return result;
}

/// A row of table 0; throws std::out_of_range.
inline const FigureRow& RowOf(const StudyResult& result,
                              const std::vector<std::string>& labels,
                              std::size_t table = 0) {
  for (const FigureRow& row : result.rows.at(table)) {
    if (row.labels == labels) return row;
  }
  throw std::out_of_range("no row of that case and method");
}

/// A figure of it, in SI; throws std::bad_optional_access for one that there is
/// not.
inline double ValueOf(const StudyResult& result,
                      const std::vector<std::string>& labels,
                      const std::string& name, std::size_t table = 0) {
  return FigureOf(result.tables.at(table), RowOf(result, labels, table), name)
      .value();
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_SUPPORT_STUDY_H_
