#ifndef HINDSIGHT_PROBLEMS_IMU_LEAPS_H_
#define HINDSIGHT_PROBLEMS_IMU_LEAPS_H_

#include <cstddef>
#include <vector>

#include "problems/forward_stage.h"
#include "state/rival_solution.h"

namespace hindsight {

/// A drop-out of the IMU, which may be a leap of its clock instead.
struct ImuDropOut {
  std::size_t end = 0;  ///< number of the sample behind it
  double t = 0.0;       ///< stamp of the sample before it [s]
  double lost = 0.0;    ///< beyond the usual interval [s]
};

/// The longest kMostLeaps of an interval, the longest first.
std::vector<ImuDropOut> LongestDropOuts(const ImuStream& imu, double from,
                                        double to);
inline constexpr int kMostLeaps = 3;

/// `dataset` without a leap of the IMU's clock there.
Dataset WithoutLeap(const Dataset& dataset, const ImuDropOut& leap);

/// No data say how rare a leap is: it is taken to be as rare as what lies beyond
/// two sigmas, so that it alone makes nothing worse than doubtful.
inline constexpr double kLostForOneLeap = 20.0;

/// What a drop-out of the IMU may be instead: a leap of its clock, with no
/// sample lost, so that what follows is stamped late by the drop-out less the
/// usual sample interval. The longest kMostLeaps drop-outs of the interval are
/// tried, each solved to its end from the start of `chosen`, which has run, and
/// compared by LogEvidenceRatio, a leap being taken as twenty times rarer
/// beforehand. Told are those whose position, velocity or attitude is a standard
/// deviation or more from that of `chosen`, in the root mean square over the
/// nodes of both. Their evidence is above 0 where they are likelier, 30 at most;
/// the probabilities are not set yet.
std::vector<RivalSolution> ImuLeaps(ForwardStage* chosen);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_IMU_LEAPS_H_
