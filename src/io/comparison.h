#ifndef HINDSIGHT_IO_COMPARISON_H_
#define HINDSIGHT_IO_COMPARISON_H_

#include <string>

#include "evaluation/trajectory_error.h"
#include "io/summary.h"

namespace hindsight {

/// One table that compares the methods of a run, a row each: errors in the
/// outages, errors against truth, mean normalised squared errors, normalised
/// residuals of every sensor, seconds, peak memory. Columns without any figure
/// are left out.
std::string ComparisonTable(const RunSummary& summary);

/// The error statistics of one trajectory as a table: a row for each component,
/// RMS, std, mean, 50/68/95/99 % and max; then the matched percentage and the
/// mean normalised squared errors.
std::string ErrorTable(const TrajectoryStatistics& statistics);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_COMPARISON_H_
