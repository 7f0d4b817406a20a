#ifndef HINDSIGHT_IO_WRITE_TUM_H_
#define HINDSIGHT_IO_WRITE_TUM_H_

#include <string>

#include "evaluation/solution_table.h"

namespace hindsight {

/// TUM trajectory, `t tx ty tz qx qy qz qw`, separated by single blanks, no
/// header: t [s] of the data set; position [m] in the east-north-up tangent
/// plane of the ellipsoid at the first epoch, origin there; quaternion of the
/// rotation from body forward-left-up to these axes (the ROS convention),
/// qw >= 0. `remark`, if not empty, goes before them as a comment line, "#
/// ...", which readers of the format skip. Throws InputError if the file cannot
/// be written, and EstimationError if the table has no positions or no
/// attitudes.
void WriteTum(const std::string& path, const SolutionTable& table,
              const std::string& remark = "");

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_TUM_H_
