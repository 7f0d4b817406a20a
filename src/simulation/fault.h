#ifndef HINDSIGHT_SIMULATION_FAULT_H_
#define HINDSIGHT_SIMULATION_FAULT_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/quantity.h"
#include "dataset/dataset.h"

namespace hindsight {

struct FaultKind;

/// Something that is wrong with a recording, or with what is said of it.
struct Fault {
  const FaultKind* kind = nullptr;
  /// Kind of the sensors that have it; empty where FaultKind::of is not a
  /// sensor. Of several such sensors the first has it, so that the others
  /// contradict it.
  std::string sensor;
  double size = 0.0;  ///< SI, of the kind's quantity
};

/// A kind of fault: a word, what its size means, and what it does to a
/// recording.
struct FaultKind {
  enum class Of { kSensor, kImu, kStart };
  /// What the size is: a quantity of its own, one of the sensor's values, as a
  /// sensor of positions has lengths, or a number: a factor above 0, an axis of
  /// 0, 1 and 2, a count of 1 and more.
  enum class Size { kQuantity, kOfSensor, kFactor, kAxis, kCount };

  std::string_view name;
  Of of;
  Size size;
  Quantity quantity;
  std::string_view help;
  /// `random` of the seed; `sensor` is the number of the stream, -1 of others.
  void (*apply)(double size, int sensor, std::uint64_t seed, Dataset* dataset);
};

/// All kinds, in the order of documentation.
const std::vector<FaultKind>& FaultKinds();
/// nullptr if there is none.
const FaultKind* FindFaultKind(std::string_view name);

/// Quantity of the values of a sensor of that kind, a length of what places.
Quantity ReadingQuantity(const SensorKind& kind);

/// Whether the recording has what the fault is of.
bool HasPlaceFor(const Fault& fault, const Dataset& dataset);

/// Puts the fault into a recording. The same for the same seed; nothing else of
/// the recording changes. Requires HasPlaceFor.
void ApplyFault(const Fault& fault, std::uint64_t seed, Dataset* dataset);

/// The same, of what the fault does to perfect readings alone: the errors of the
/// readings of `healthy`, which `perfect` is without, stay on the rows and axes
/// that they are on. Nothing where the fault leaves these alone anyway.
std::optional<Dataset> WithErrorsAsTheyWere(const Fault& fault,
                                            std::uint64_t seed,
                                            const Dataset& healthy,
                                            Dataset perfect);

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_FAULT_H_
