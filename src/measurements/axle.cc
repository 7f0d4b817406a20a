#include "measurements/axle.h"

namespace hindsight {

const std::vector<FieldName>& AxleColumns() {
  static const std::vector<FieldName> kColumns = {
      {"speed", Quantity::kSpeed},     {"side", Quantity::kSpeed},
      {"down", Quantity::kSpeed},      {"quality", Quantity::kRatio},
      {"distance", Quantity::kLength},
  };
  return kColumns;
}

SensorKey AxleLevelKey() {
  return {.name = "level_on_average",
          .quantity = Quantity::kAngle,
          .value = SensorKey::OptionalNumber{[](SensorSettings& s) {
            return &s.level_sigma;
          }},
          .help =
              "sigma with which the vehicle's mean roll over the record is "
              "zero, without which the mounting's roll is not observed"};
}

std::optional<KeyObjection> TakeAxleSigma(SensorSettings* settings) {
  if (settings->sigma) PatternOf<Odometer>(*settings).sigma = *settings->sigma;
  return std::nullopt;
}

void GiveAxleSigma(SensorSettings* settings) {
  settings->sigma = PatternOf<Odometer>(*settings).sigma;
}

}  // namespace hindsight
