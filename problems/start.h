#ifndef HINDSIGHT_PROBLEMS_START_H_
#define HINDSIGHT_PROBLEMS_START_H_

#include "dataset/dataset.h"
#include "filters/forward_filter.h"
#include "problems/reconstruction.h"

namespace hindsight {

/// The start of an estimation: report in words, layout, prior.
struct Start {
  StartReport report;
  ErrorLayout layout;
  Prior prior;
};

/// Finds the initial state of a data set over [from, to].
///   time      given; else the first IMU sample if the vehicle rests from there
///             to the first position fix, else the first position fix.
///   position  given, else the first position fix less its lever arm.
///   attitude  given, else levelled from the mean specific force at rest
///             (roll = atan2(-f_y, -f_z), pitch = atan2(f_x, |f_yz|)), else
///             level over the first second with 5 deg.
///   heading   given, else the course of the first motion above 3 m/s, carried
///             back to the start with the gyros; forward motion is assumed.
///   velocity  given, else zero at rest, else from the first fixes.
///   gyro bias mean rate at rest less Earth rate, else as given.
/// Throws EstimationError if there is no position.
Start FindStart(const Dataset& dataset, double from, double to);

/// The error layout a data set asks for: the navigation blocks and every
/// calibration block with an a priori sigma in its sensor.
ErrorLayout BuildLayout(const Dataset& dataset, const NavigationPrior& prior);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_START_H_
