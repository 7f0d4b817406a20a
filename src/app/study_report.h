#ifndef HINDSIGHT_APP_STUDY_REPORT_H_
#define HINDSIGHT_APP_STUDY_REPORT_H_

#include <string>
#include <vector>

#include "app/result_folder.h"
#include "problems/montecarlo.h"

namespace hindsight {

/// Name of the file with the figures of a Monte Carlo comparison.
inline constexpr char kMonteCarloJson[] = "montecarlo.json";

/// The tables of a study for a terminal: a row a case and method. Tables of
/// constants and the like that are long are left to their files.
std::string StudyText(const StudyResult& result);

/// A table as it is shown: case and method, and the figures; a case that goes on
/// is not named again.
struct StudyGrid {
  std::vector<std::string> heading;
  std::vector<std::vector<std::string>> rows;
};
StudyGrid GridOf(const StudyTable& table, const std::vector<FigureRow>& rows);

/// A page that shows a comparison: the tables; of each case the figures against
/// time, a line a method, among them ANEES with its 95 % bounds; and of every
/// label that has several numbers ("0.1 deg/sqrt(h)") the errors against them.
/// It needs no script and no network.
std::string StudyPage(const Study& study, const StudyResult& result,
                      const MonteCarloOptions& options);

/// "100 runs, seeds 1 to 100, of NAME, KEY VALUE".
std::string StudyHeading(const Study& study, const MonteCarloOptions& options);

/// The files of a result, complete or not, montecarlo.json first:
///   {"scenario", settings, "complete", "runs", "runs_asked", "first_seed",
///    "refused" (where data were: a line each), TABLE: [{labels, "runs", figures}]}
/// with TABLE "cells" and what else the study has ("constants", "agreement"); a
/// row a case and method, its labels by column, its figures by name, component
/// and unit ("end_std_n_m"); one that is infinite or does not exist is absent.
/// Figures are of the first `runs` seeds; complete is false if fewer than asked
/// were finished or not all cases are there.
///   TABLE.csv   the same figures but processor times, a row a case and method
///   runs.csv    the long table: a row a case, method and seed with grade,
///               failed and every value of the run, SI
///   curves.csv  figures against time, of studies that have them
/// The CSVs are the same to the last byte whatever the number of threads.
std::vector<OutputFile> StudyFiles(const Study& study,
                                   const StudyResult& result,
                                   const MonteCarloOptions& options);

/// Prints heading and text, writes the files, with --report a page besides
/// (StudyPage), and commits the folder. Throws OutputError.
void ReportStudy(const Study& study, const StudyResult& result,
                 const MonteCarloOptions& options, ResultFolder* folder);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_STUDY_REPORT_H_
