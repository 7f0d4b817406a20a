#ifndef HINDSIGHT_EVALUATION_RESIDUAL_STATISTICS_H_
#define HINDSIGHT_EVALUATION_RESIDUAL_STATISTICS_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "state/solution.h"

namespace hindsight {

/// How one sensor's measurements agree with a solution.
struct ResidualStatistics {
  std::string sensor;  ///< name of the stream
  const SensorKind* kind = &PositionKind();
  std::size_t count = 0;     ///< offered to the estimator, withheld ones not
  std::size_t rejected = 0;  ///< of these, by the gate
  std::size_t withheld = 0;  ///< predicted only
  /// sqrt(mean of nis/rows) over the accepted: one if the noise is as stated.
  /// Absent if none was accepted.
  std::optional<double> normalized_rms;
};

/// One entry for each sensor that has residuals, in the order of the streams.
std::vector<ResidualStatistics> ComputeResidualStatistics(
    const Solution& solution, const Dataset& dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_RESIDUAL_STATISTICS_H_
