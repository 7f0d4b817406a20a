#include "measurements/noise_kind.h"

namespace hindsight {

const NoiseKind& GaussMarkovNoise() {
  static const NoiseKind kKind = {
      .name = "gauss_markov",
      .help = "errors correlated as exp(-dt/tau)",
      .keys = {CorrelatedSigmaKey(),
               {.name = "tau",
                .help = "correlation time",
                .at = [](Sensor& s) { return &s.noise.tau; },
                .quantity = Quantity::kTime},
               WhiteSigmaKey()},
      .evolution =
          [](const NoiseModel& noise) {
            return Evolution::GaussMarkov(noise.sigma, noise.tau);
          },
      .searched = {
          {"white", [](Sensor& s) { return &s.noise.white_sigma; }},
          {"gauss_markov", [](Sensor& s) { return &s.noise.sigma; }},
          {"gauss_markov_tau", [](Sensor& s) { return &s.noise.tau; }}}};
  return kKind;
}

}  // namespace hindsight
