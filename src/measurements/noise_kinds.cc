#include <stdexcept>
#include <string>

#include "measurements/noise_kind.h"

namespace hindsight {
namespace {

std::vector<const NoiseKind*>& TheNoiseList() {
  static std::vector<const NoiseKind*> list = {
      &WhiteNoise(), &GaussMarkovNoise(), &MixtureNoise()};
  return list;
}

}  // namespace

bool NoiseModel::correlated() const { return kind->evolution != nullptr; }

const std::vector<const NoiseKind*>& NoiseKinds() { return TheNoiseList(); }

void AddNoiseKind(const NoiseKind& kind) {
  for (const NoiseKind* known : NoiseKinds()) {
    if (known->name != kind.name) continue;
    throw std::invalid_argument("there is a model of noise named " +
                                std::string(kind.name));
  }
  TheNoiseList().push_back(&kind);
}

NoiseKey CorrelatedSigmaKey() {
  return {.name = "sigma",
          .help =
              "stationary standard deviation of each axis, in place of the "
              "file's",
          .at = [](Sensor& s) { return &s.noise.sigma; }};
}

NoiseKey WhiteSigmaKey() {
  return {.name = "white",
          .help = "what is left white beside it",
          .at = [](Sensor& s) { return &s.noise.white_sigma; },
          .fallback = [](const Sensor& s) { return 0.1 * s.noise.sigma; },
          .fallback_text = "a tenth of sigma"};
}

const NoiseKind& WhiteNoise() {
  static const NoiseKind kKind = {
      .name = "white", .help = "each error independent of all others"};
  return kKind;
}

}  // namespace hindsight
