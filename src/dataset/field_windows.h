#ifndef HINDSIGHT_DATASET_FIELD_WINDOWS_H_
#define HINDSIGHT_DATASET_FIELD_WINDOWS_H_

#include <array>

#include "dataset/dataset.h"

namespace hindsight {

/// Which axes of a magnetometer have their sign changed; the eight choices by
/// number, 0 being none.
using AxisSigns = std::array<bool, 3>;
AxisSigns AxisSignsOf(int number);

/// How a magnetometer's readings fare under each choice of signs, on average
/// over windows of 10 s, which the gyros turn back to their begin.
struct SignCosts {
  /// Mean squared norm about the mean over the mean squared norm, of windows
  /// with turns of more than 20 deg.
  std::array<double, 8> scatter = {};
  /// Sine of the dip against the mean specific force.
  std::array<double, 8> dip_sine = {};
  int turned = 0;     ///< windows with a turn
  double norm = 0.0;  ///< root mean square [uT]
};

/// The costs of a stream of magnetic fields, from which the hard iron is taken
/// off, over at most 60 windows inside the IMU's record.
SignCosts ReadFieldWindows(const Dataset& dataset, const AidingStream& stream);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_FIELD_WINDOWS_H_
