#ifndef HINDSIGHT_EVALUATION_VALUE_ORIGIN_H_
#define HINDSIGHT_EVALUATION_VALUE_ORIGIN_H_

#include <string>

#include "evaluation/grade.h"

namespace hindsight {

/// Where a component of the start came from.
struct ValueOrigin {
  bool given = true;      ///< by the configuration
  std::string key;        ///< that says the value, or would
  std::string sigma_key;  ///< that says how well it is known
  /// What the component is away from, where that is no value that was given.
  std::string instead;
};

/// Of an axis of a block of the start, which `judged` has.
ValueOrigin OriginOf(const Judged& judged, const Block& block, int axis);
/// Of a constant that the method has beside its states: `key` in words.
ValueOrigin OriginOf(const ConstantEstimate& constant);
/// Of a gyro bias that was given, where the start is another.
ValueOrigin OriginOfGivenGyroBias(const InitialState& given);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_VALUE_ORIGIN_H_
