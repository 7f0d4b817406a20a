#ifndef HINDSIGHT_IO_READ_FIX_MOTION_H_
#define HINDSIGHT_IO_READ_FIX_MOTION_H_

#include <cstddef>
#include <vector>

#include "io/read/fix_guess.h"

namespace hindsight {

/// How positions move, from each to the next that is another.
struct FixMotion {
  std::vector<double> speed;     ///< [m/s]
  std::vector<double> course;    ///< from north to east [rad]
  std::vector<std::size_t> row;  ///< at the later of both
};

/// Of latitudes and longitudes [rad] at times t [s]; how many are repeated and
/// the top speed go into `guess`.
FixMotion MotionOf(const std::vector<double>& lat,
                   const std::vector<double>& lon, const std::vector<double>& t,
                   FixGuess* guess);

/// Columns without a title that move as the positions do, and titled ones.
void FindSpeedAndCourse(const FileColumns& file,
                        const std::vector<ColumnMeaning>& meanings,
                        const FixMotion& motion, FixGuess* guess);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_FIX_MOTION_H_
