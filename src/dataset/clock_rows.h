#ifndef HINDSIGHT_DATASET_CLOCK_ROWS_H_
#define HINDSIGHT_DATASET_CLOCK_ROWS_H_

#include <Eigen/Core>
#include <vector>

#include "dataset/dataset.h"

namespace hindsight {

/// Rows of a stream as vectors: positions in e, velocities in n or in the body,
/// fields in the body, or heights in x; stamps ascend.
struct TimedRows {
  std::vector<double> t;
  std::vector<Eigen::Vector3d> value;
  std::vector<double> sigma;

  /// Passes over a row that is not later than the one before.
  void Add(double time, const Eigen::Vector3d& v, double s);
};

/// The rows of a stream that say how it moves or turns, as one vector: of a
/// DVL those with three beams, of speed and course those with a course, of
/// counted distances their mean speed; none that is withheld.
TimedRows RowsOf(const AidingStream& stream);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_CLOCK_ROWS_H_
