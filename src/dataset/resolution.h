#ifndef HINDSIGHT_DATASET_RESOLUTION_H_
#define HINDSIGHT_DATASET_RESOLUTION_H_

#include <vector>

namespace hindsight {

/// What two readings of the same digits may differ by, as units are converted:
/// the larger of both.
struct ReadingRounding {
  double absolute = 0.0;  ///< in the unit of the readings
  double relative = 0.0;  ///< of a reading
};

/// What is known of the values that a series of readings takes.
enum class ReadingCourse {
  kToAndFro,  ///< they come back: some values are a single step apart
  kAnyhow,    ///< nothing: values that only grow may all be many steps apart
};

/// The step of which all differences of the readings are multiples, from above:
/// the least difference of two readings that is larger than their rounding. For
/// kAnyhow the readings are sorted, and the least difference between two of the
/// steps from one to the next is taken where it is smaller still. Infinity if
/// all readings are equal.
double Resolution(std::vector<double> readings, const ReadingRounding& rounding,
                  ReadingCourse course);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_RESOLUTION_H_
