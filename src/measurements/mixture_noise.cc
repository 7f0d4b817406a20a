#include "measurements/noise_kind.h"

namespace hindsight {
namespace {

std::optional<KeyObjection> CompleteMixture(Sensor* sensor) {
  RobustLoss& loss = sensor->loss;
  if (loss.kind != RobustLoss::Kind::kNone) {
    return KeyObjection{"model", "a mixture does not go with a loss"};
  }
  if (loss.outlier_share >= 1.0) {
    return KeyObjection{"outliers", "expected a share of less than 100 %"};
  }
  if (loss.outlier_ratio <= 1.0) {
    return KeyObjection{"ratio", "expected a number above 1"};
  }
  loss.kind = RobustLoss::Kind::kMixture;
  loss.scale = 1.0;
  return std::nullopt;
}

}  // namespace

const NoiseKind& MixtureNoise() {
  static const NoiseKind kKind = {
      .name = "mixture",
      .help = "outliers among good values, by their likelihood",
      .keys =
          {{.name = "outliers",
            .help = "share of outliers",
            .at = [](Sensor& s) { return &s.loss.outlier_share; },
            .quantity = Quantity::kRatio,
            .fallback = [](const Sensor& s) { return s.loss.outlier_share; },
            .fallback_text = "5 %"},
           {.name = "ratio",
            .help = "standard deviation of an outlier over the stated one",
            .at = [](Sensor& s) { return &s.loss.outlier_ratio; },
            .factor = true,
            .fallback = [](const Sensor& s) { return s.loss.outlier_ratio; },
            .fallback_text = "20"}},
      .complete = CompleteMixture};
  return kKind;
}

}  // namespace hindsight
