#ifndef HINDSIGHT_IO_READ_UNIT_GRAMMAR_H_
#define HINDSIGHT_IO_READ_UNIT_GRAMMAR_H_

#include <optional>
#include <string_view>

namespace hindsight {

/// What a unit says of a number.
struct UnitMeaning {
  /// Exponents in halves, so that square roots stay integers.
  struct Dimension {
    int length = 0;
    int time = 0;
    int angle = 0;
    int field = 0;
    bool operator==(const Dimension&) const = default;
  };
  double factor = 1.0;  ///< to SI, of magnetic fields to uT
  Dimension dimension = {};
};

/// Of a product or quotient of units in any of the spellings that UnitFactor
/// lists (io/read/units.h); nothing for a unit that is unknown.
std::optional<UnitMeaning> MeaningOfUnit(std::string_view unit);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_UNIT_GRAMMAR_H_
