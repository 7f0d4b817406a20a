#ifndef HINDSIGHT_DATASET_HELD_READINGS_H_
#define HINDSIGHT_DATASET_HELD_READINGS_H_

#include <Eigen/Core>
#include <optional>
#include <tuple>

#include "dataset/dataset.h"

namespace hindsight {

/// What a row reads.
struct RowReading {
  Eigen::Vector4d row = Eigen::Vector4d::Zero();  ///< all of it
  /// The part of one unit, to tell how far two readings are apart: metres
  /// north, east and up; metres a second; microtesla.
  Eigen::Vector4d value = Eigen::Vector4d::Zero();
  /// Of a position, north, east and up [m].
  std::optional<Eigen::Vector3d> position_sigma = std::nullopt;

  template <class Self>
  static auto Fields(Self& reading) {
    return std::tie(reading.row, reading.value, reading.position_sigma);
  }
};

/// Consecutive rows of a stream that read the same.
struct HeldReading {
  RowReading reading;
  double t_begin = 0.0;
  double t_end = 0.0;
  long rows = 1;

  template <class Self>
  static auto Fields(Self& held) {
    return std::tie(held.reading, held.t_begin, held.t_end, held.rows);
  }
};

using HeldSeries = PackedSeries<HeldReading>;

/// The readings of a stream, in time order, without what is no reading.
HeldSeries HeldReadings(const AidingStream& stream);

/// Whether it reads a speed: at rest those are zero and repeat by right.
bool ReadsSpeed(const Measurement& z);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_HELD_READINGS_H_
