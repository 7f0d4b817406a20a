#ifndef HINDSIGHT_IO_CONFIG_INJECTION_TEXT_H_
#define HINDSIGHT_IO_CONFIG_INJECTION_TEXT_H_

#include <string>

#include "dataset/dataset.h"

namespace hindsight {

/// An error to add to measurements as one text,
///   SENSOR:KIND=SIZE[,from=140s][,to=150s][,axes=ne][,share=10%][,tau=20s]
/// with KIND step, pulse, ramp, spikes or multipath (dataset/injection.h).
/// Throws std::invalid_argument saying what is wrong and what was expected.
Injection ParseInjection(const std::string& text);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_INJECTION_TEXT_H_
