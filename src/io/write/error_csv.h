#ifndef HINDSIGHT_IO_WRITE_ERROR_CSV_H_
#define HINDSIGHT_IO_WRITE_ERROR_CSV_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/solution_table.h"
#include "evaluation/trajectory_error.h"

namespace hindsight {

/// One column, NaN where truth or solution lacks the quantity.
struct ErrorColumn {
  std::string title;
  std::vector<double> values;
};
using ErrorColumns = std::vector<ErrorColumn>;

/// Truth minus solution at the truth's times, and what the solution says of it:
///   t[s]
///   n[m] e[m] d[m], v_n[m/s] v_e[m/s] v_d[m/s]   errors, north-east-down
///   roll[deg] pitch[deg] heading[deg]            differences, (-180, 180]
///   sd_n[m] ... sd_heading[deg]                  of the solution, each
///   nees_position[1] nees_velocity[1] nees_attitude[1]
///                              normalised squared errors, 3 degrees of freedom
/// Standard deviations are of the first row of `solution` that is not before
/// the error.
ErrorColumns ColumnsOf(const std::vector<TrajectoryError>& errors,
                       const SolutionTable& solution);

/// The columns as a file, fields empty for NaN. `program` and what t = 0 is go
/// into the comments. Throws OutputError if the file cannot be written.
void WriteErrorCsv(const std::string& path, const ErrorColumns& columns,
                   const std::string& program,
                   std::optional<std::int64_t> epoch_gps_ns);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_ERROR_CSV_H_
