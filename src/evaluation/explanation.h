#ifndef HINDSIGHT_EVALUATION_EXPLANATION_H_
#define HINDSIGHT_EVALUATION_EXPLANATION_H_

#include <optional>
#include <string>
#include <vector>

#include "evaluation/grade.h"

namespace hindsight {

/// Errors are sqrt(1 + 1) times as large as stated beside such a shift
/// (kDoubtfulError) [sigma].
inline constexpr double kDoubtfulShift = 1.0;

/// A deviation from the stated model that explains the innovations better than
/// chance does: of one sensor, or of the IMU, the likeliest of those that move
/// the solution by kDoubtfulShift, or of all if none does.
struct Explanation {
  std::string sensor;  ///< "" if it is of the IMU or of a state
  std::string what;    ///< a clause: "gnss is 0.20 s late"
  std::string remedy;  ///< what to try
  double z = 0.0;      ///< its size in its own sigmas, not negative
  /// That any of all deviations reaches with the rate of false alarms.
  double limit = 0.0;
  std::optional<double> onset;  ///< none: throughout [s]
  /// By what allowing for it moves the solution, in the root mean square over
  /// the interval, of the component with most; of constants at the end [sigma].
  double effect = 0.0;
  std::string component;
  double shift_that_matters = kDoubtfulShift;  ///< of `effect`
};

/// Doubtful: a solution that an explanation beyond its limit moves by what
/// matters or more. Only the one farthest beyond its limit is told:
/// the others are often its shadows.
void FindBetterExplanation(const Judged& judged,
                           std::vector<Evidence>* evidence);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_EXPLANATION_H_
