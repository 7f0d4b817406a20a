#ifndef HINDSIGHT_APP_GRADES_STUDY_H_
#define HINDSIGHT_APP_GRADES_STUDY_H_

#include "problems/montecarlo.h"

namespace hindsight {

/// Every vehicle of --faults, healthy and with every fault that it has a place
/// for. Throws UsageError, and InputError for a file that is no list of faults.
Study GradesStudy();

}  // namespace hindsight

#endif  // HINDSIGHT_APP_GRADES_STUDY_H_
