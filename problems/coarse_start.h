#ifndef HINDSIGHT_PROBLEMS_COARSE_START_H_
#define HINDSIGHT_PROBLEMS_COARSE_START_H_

#include <optional>

#include "alignment/start.h"
#include "dataset/dataset.h"
#include "problems/reconstruction.h"

namespace hindsight {

/// The start that FindStart finds at a fraction of its cost, as the attitude is given
/// to it: that which AlignCoarsely finds from the first kAlignmentWindow of motion.
/// Nothing where the configuration says something of the start or there is none.
/// `dataset` is given back as it was.
std::optional<Start> CoarseStart(const ReconstructionOptions& options,
                                 Dataset* dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_COARSE_START_H_
