#include "measurements/axle.h"

namespace hindsight {

const SensorKind& NonHolonomicKind() {
  static const SensorKind kKind = {
      .name = "non_holonomic",
      .help = "wheels neither slip sideways nor leave the ground",
      .generated = true,
      .residual_unit = "m/s",
      .of_vehicle = true,
      .in_vehicle_axes = true,
      .has_clock = false,
      .columns = AxleColumns(),
      .keys = {{.name = "rate",
                .quantity = Quantity::kFrequency,
                .value = SensorKey::Number{[](SensorSettings& s) {
                                             return &s.rate_hz;
                                           },
                                           SensorKey::Range::kPositive},
                .help = "constraints a second",
                .needed = Always},
               {.name = "sigma",
                .quantity = Quantity::kSpeed,
                .value = SensorKey::SidesSigma{[](SensorSettings& s) {
                  return &s.sigma;
                }},
                .help = "[side, down]",
                .needed = Always,
                .missing = kAxleSigmaMissing},
               AxleLevelKey(),
               MountingKey(true),
               LeverArmKey(),
               LeverArmSigmaKey(),
               MountingSigmaKey()},
      .blocks = {MountingBlock(), LeverArmBlock()},
      .prepare =
          [](SensorSettings* s) {
            Odometer odometer;
            odometer.form = Odometer::Form::kNonHolonomic;
            s->pattern = odometer;
          },
      .complete = TakeAxleSigma,
      .uncomplete = GiveAxleSigma,
  };
  return kKind;
}

}  // namespace hindsight
