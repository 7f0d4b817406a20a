#ifndef HINDSIGHT_IO_WRITE_COMPARISON_H_
#define HINDSIGHT_IO_WRITE_COMPARISON_H_

#include <string>

#include "evaluation/trajectory_error.h"
#include "io/write/summary.h"
#include "io/write/table.h"

namespace hindsight {

/// A table that compares the methods of a run, a row each: errors in the
/// outages, errors against truth, mean normalised squared errors, of attitude
/// alone the BROAD benchmark's errors and the share of disturbed field, seconds,
/// peak memory, grade. Columns without any figure are left out.
std::string ComparisonTable(const RunSummary& summary,
                            const TableStyle& style = {});

/// A row for each sensor: its measurements, how many of them the best method
/// rejected, and the root mean square of the residuals over their sigma of each
/// method. "" without residuals.
std::string ResidualOverview(const RunSummary& summary,
                             const TableStyle& style = {});

/// The error statistics of one trajectory as a table: a row for each component,
/// RMS, std, mean, 50/68/95/99 % and max; then the matched percentage and the
/// mean normalised squared errors.
std::string ErrorTable(const TrajectoryStatistics& statistics,
                       const TableStyle& style = {});

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_COMPARISON_H_
