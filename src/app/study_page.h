#ifndef HINDSIGHT_APP_STUDY_PAGE_H_
#define HINDSIGHT_APP_STUDY_PAGE_H_

#include <string>

#include "problems/montecarlo.h"

namespace hindsight {

/// A page that shows a comparison: the tables; of each case the figures against
/// time, a line a method, among them ANEES with its 95 % bounds; and of every
/// label that has several numbers ("0.1 deg/sqrt(h)") the errors against them.
/// It needs no script and no network.
std::string StudyPage(const Study& study, const StudyResult& result,
                      const MonteCarloOptions& options);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_STUDY_PAGE_H_
