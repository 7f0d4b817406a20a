#ifndef HINDSIGHT_MEASUREMENTS_NOISE_KIND_H_
#define HINDSIGHT_MEASUREMENTS_NOISE_KIND_H_

#include <optional>
#include <string_view>
#include <vector>

#include "base/quantity.h"
#include "measurements/sensor_block.h"
#include "measurements/sensor_key.h"

namespace hindsight {

/// One key of a model of noise: a number greater than zero.
struct NoiseKey {
  std::string_view name;
  std::string_view help;
  double* (*at)(Sensor&);
  /// Absent: a standard deviation of what the sensor measures.
  std::optional<Quantity> quantity = {};
  bool factor = false;  ///< a plain number, without a unit
  /// nullptr: the key must be given.
  double (*fallback)(const Sensor&) = nullptr;
  std::string_view fallback_text = {};
};

/// A model of the errors of a sensor, all of it: configuration, help, error
/// states, start and the search for noise walk the list of them (NoiseKinds).
struct NoiseKind {
  std::string_view name;  ///< `noise.model` in configurations
  std::string_view help;  ///< one line
  std::vector<NoiseKey> keys = {};
  /// What follows from the keys; an objection to what was read before.
  std::optional<KeyObjection> (*complete)(Sensor*) = nullptr;
  /// How the error changes, of a kind that is correlated in time: with the
  /// stationary standard deviation NoiseModel::sigma. nullptr: there is no
  /// error state, and the measurements keep their covariance.
  Evolution (*evolution)(const NoiseModel&) = nullptr;
  /// Values that `check --noise` looks for, of a correlated kind.
  std::vector<NoiseValue> searched = {};
};

/// The list of all kinds, in the order of documentation.
const std::vector<const NoiseKind*>& NoiseKinds();

/// Adds a kind that a program brings; it must outlive the use of the list.
/// Throws std::invalid_argument if the name is taken.
void AddNoiseKind(const NoiseKind& kind);

/// `sigma` and `white` of correlated kinds: the stationary standard deviation,
/// and what is left white beside the state.
NoiseKey CorrelatedSigmaKey();
NoiseKey WhiteSigmaKey();

/// e_k = phi e_k-1 + w,  phi = exp(-dt/tau),  w ~ (0, sigma^2 (1 - phi^2)).
const NoiseKind& GaussMarkovNoise();

/// Outliers among good values, which is a loss (measurements/robust_loss.h).
const NoiseKind& MixtureNoise();

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_NOISE_KIND_H_
