#ifndef HINDSIGHT_APP_STUDIES_H_
#define HINDSIGHT_APP_STUDIES_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/command.h"
#include "problems/montecarlo.h"

namespace hindsight {

/// A Monte Carlo comparison that comes with the program.
struct NamedStudy {
  std::string name;
  std::string help;  ///< one or more lines
  /// As the flags ask for. Throws UsageError for those that do not fit, before
  /// it computes anything.
  std::function<Study()> make;
  /// The flags of its own, with underscores for dashes.
  std::vector<std::string> flags = {"set", "sweep"};
  std::uint64_t default_runs = 100;
};

/// All of them.
const std::vector<NamedStudy>& NamedStudies();

/// Every vehicle of --faults, healthy and with every fault that it has a place
/// for. Throws UsageError, and InputError for a file that is no list of faults.
Study GradesStudy();

/// Of problems/papers and of attitude alone, as the flags ask for; what they
/// compare stands in NamedStudies. They throw UsageError.
///
/// Forward observers from bad attitudes.
Study InFlightStudy();
/// The same flight from no start value at all, the IMU mounted at any attitude.
Study VelocityAlignmentStudy();
Study GpsJumpsStudy();
/// The fusions of Lee and Yoon (2011) as printed, under every reading.
Study UuvSearchStudy();
Study VibrationAttitudeStudy();
/// With the field throughout, and with one that is of no use in motion.
Study FreeRotationStudy();

}  // namespace hindsight

#endif  // HINDSIGHT_APP_STUDIES_H_
