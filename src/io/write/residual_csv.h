#ifndef HINDSIGHT_IO_WRITE_RESIDUAL_CSV_H_
#define HINDSIGHT_IO_WRITE_RESIDUAL_CSV_H_

#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "state/solution.h"

namespace hindsight {

/// The fate of every measurement in every solution, one line for each of its
/// components:
///   method, t[s], sensor, component   0, 1, ... in the model's axes
///   residual                          measured - predicted, SI (m, m/s, rad/s)
///   sigma                             predicted standard deviation of it, SI
///   nis                               of the whole measurement
///   weight                            of a robust loss, 1 = full
///   status                            used, rejected (by the gate), withheld
/// after comments that begin with '#', one of which says what t = 0 is. Written
/// to a temporary name and renamed. Throws OutputError if the file
/// cannot be written.
void WriteResidualCsv(const std::string& path,
                      const std::vector<Solution>& solutions,
                      const Dataset& dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_RESIDUAL_CSV_H_
