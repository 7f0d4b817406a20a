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

/// How readings go on.
enum class ReadingCourse {
  kToAndFro,  ///< some lie next to each other in order of size
  kAnyhow,    ///< of what only grows all may be far from each other
};

/// The step that all differences of the readings are multiples of, or less: the
/// least difference of two of them beyond their rounding; of kAnyhow the least
/// difference of two such differences, of neighbours in order of size, if that
/// is less. Infinity if all are equal.
double Resolution(std::vector<double> readings, const ReadingRounding& rounding,
                  ReadingCourse course);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_RESOLUTION_H_
