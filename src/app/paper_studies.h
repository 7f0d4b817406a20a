#ifndef HINDSIGHT_APP_PAPER_STUDIES_H_
#define HINDSIGHT_APP_PAPER_STUDIES_H_

#include "problems/montecarlo.h"

namespace hindsight {

/// \file
/// Of problems/papers and of attitude alone, as the flags ask for; what they
/// compare stands in NamedStudies. They throw UsageError.

/// Forward observers from bad attitudes.
Study InFlightStudy();
/// The same flight from no start value at all, the IMU mounted at any attitude.
Study VelocityAlignmentStudy();
Study GpsJumpsStudy();
/// The fusions of Lee and Yoon (2011) as printed, under --reading.
Study UuvSearchStudy();
Study VibrationAttitudeStudy();
/// With the field throughout, and with one that is of no use in motion.
Study FreeRotationStudy();

}  // namespace hindsight

#endif  // HINDSIGHT_APP_PAPER_STUDIES_H_
