#ifndef HINDSIGHT_DATASET_MEDIAN_FIELD_H_
#define HINDSIGHT_DATASET_MEDIAN_FIELD_H_

#include <optional>

#include "dataset/dataset.h"

namespace hindsight {

/// The field of a magnetometer along and across gravity [uT].
struct MedianField {
  double horizontal = 0.0;
  double down = 0.0;
};

/// Medians of the field's parts across and against the specific force of the
/// sample that follows each reading. Nothing if there are no readings of vectors.
std::optional<MedianField> FindMedianField(const ImuStream& imu,
                                           const AidingStream& stream);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_MEDIAN_FIELD_H_
