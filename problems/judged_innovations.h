#ifndef HINDSIGHT_PROBLEMS_JUDGED_INNOVATIONS_H_
#define HINDSIGHT_PROBLEMS_JUDGED_INNOVATIONS_H_

#include <vector>

#include "dataset/dataset.h"
#include "evaluation/innovation_test.h"
#include "filters/linear_tape.h"
#include "timeline/timeline.h"

namespace hindsight {

/// What names the measurements on a tape, and which of them are judged: the
/// accepted ones that are not withheld, but of sensors with a robust loss, whose
/// errors are not said to be normal.
class Judgeable {
 public:
  /// The arguments must outlive the object.
  Judgeable(const Timeline& timeline, const Dataset& dataset);

  bool Judges(const TapeMeasurement& z) const;
  /// A measurement z of epoch k with its innovation by rows, over their sigmas,
  /// and whitened among themselves.
  NormalisedInnovation Of(std::size_t k, const TapeMeasurement& z,
                          RowVector rows, RowVector white) const;

 private:
  const Timeline& timeline_;
  std::vector<std::vector<double>> stamps_;  ///< of the measurements, a stream
};

/// Of all that are judged, in order of time.
std::vector<NormalisedInnovation> InnovationsOf(const LinearTape& tape,
                                                const Timeline& timeline,
                                                const Dataset& dataset);

/// The largest excess over what chance explains.
double LargestExcess(const std::vector<InnovationFigure>& figures);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_JUDGED_INNOVATIONS_H_
