#ifndef HINDSIGHT_EVALUATION_INNOVATION_TEST_H_
#define HINDSIGHT_EVALUATION_INNOVATION_TEST_H_

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "state/state.h"

namespace hindsight {

/// The innovation of an accepted measurement about the converged solution, each
/// row over its predicted standard deviation: of a right model the innovations
/// of a row are independent N(0, 1).
struct NormalisedInnovation {
  double t = 0.0;  ///< of its node [s]
  int sensor = 0;
  /// Of the measurement, in its stream; kOwn of what the program itself added.
  std::size_t index = 0;
  RowVector rows;
  RowVector white;  ///< L^-1 nu, S = L L': also independent of each other
  /// Of each row (ComponentOf); empty: the row.
  std::vector<int> components = {};

  static constexpr std::size_t kOwn = static_cast<std::size_t>(-1);
};

/// By what the sigmas that a solution states fall short of its errors, as far
/// as the innovations of one component of a sensor tell. The mean square of their
/// sums over m in a row,
///   V(m) = mean over blocks of (sum of m innovations)^2 / m,
/// is chi^2(n/m)/(n/m) of the right model, for each m. Errors that are larger
/// than stated raise V(1); errors that last, and all that biases or turns a
/// sensor, V(m) of as many as they last. An estimate that averages over m
/// innovations has errors of sqrt(V(m)) of its sigmas.
struct InnovationFigure {
  int sensor = 0;
  int component = 0;
  std::size_t count = 0;
  double mean = 0.0;  ///< [sigma]
  double rms = 0.0;   ///< sqrt V(1)
  /// Share beyond 3 sigmas, where .27 % is right.
  double beyond = 0.0;
  /// The largest over m of sqrt(V(m) / q), q the quantile of its distribution
  /// that a right model exceeds with the rate of false alarms: the least excess
  /// that explains it.
  double excess = 0.0;
  std::size_t length = 1;  ///< the m of it
  double duration = 0.0;   ///< of so many innovations [s]
  double t_begin = 0.0;    ///< of the blocks that have most of it [s]
  double t_end = 0.0;
};

/// Figures of every component of every sensor with kFewest innovations or more. m
/// runs over powers of two up to all. `false_alarms`: probability that any
/// figure of a right model has an excess above 1 (Bonferroni over all m, components
/// and sensors).
std::vector<InnovationFigure> TestInnovations(
    std::span<const NormalisedInnovation> innovations, double false_alarms);

/// Fewer innovations of a component are not judged.
inline constexpr std::size_t kFewestInnovations = 4;

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_INNOVATION_TEST_H_
