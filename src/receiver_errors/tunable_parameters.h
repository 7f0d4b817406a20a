#ifndef HINDSIGHT_RECEIVER_ERRORS_TUNABLE_PARAMETERS_H_
#define HINDSIGHT_RECEIVER_ERRORS_TUNABLE_PARAMETERS_H_

#include <vector>

#include "receiver_errors/mode_sequence.h"

namespace hindsight {

/// A parameter that the likelihood decides, with its prior: normal in the
/// logarithm.
struct Tunable {
  double ErrorParameters::*member;
  double least;
  double most;
  double typical;
  double spread;  ///< standard deviation of the logarithm
  /// Of the quantity, where its bounds mean something.
  const char* name = nullptr;
  const char* unit = "";
};

/// Those of a sequence; priors of what it has beyond noise are about `from`.
std::vector<Tunable> TunablesOf(const ModeSequence& sequence,
                                const ErrorParameters& from);

/// The least factor on the stated sigma that is sought.
inline constexpr double kLeastScale = 0.1;
/// The least factor on the stated noise of the IMU: a vibration is often stated as white
/// noise of its amplitude, of which what is integrated keeps next to nothing.
inline constexpr double kLeastImuScale = 0.01;

/// Of ln of a slight bias's sigma a priori, about that as stated: what remains of
/// ionosphere, orbits and antenna.
inline constexpr double kSpreadOfSlight = 1.0;
/// Of ln of its correlation time where it lasts throughout: a factor of 5, from the seconds
/// of multipath of a moving antenna to the half hour of the atmosphere.
inline constexpr double kSpreadOfSlightTau = 1.6;

/// Each that is beyond a bound at it.
ErrorParameters Bounded(const std::vector<Tunable>& tunables,
                        ErrorParameters p);

/// ln of the prior of all, but for constants.
double LogPriorOf(const std::vector<Tunable>& tunables,
                  const ErrorParameters& p);

/// Of the prior of the logarithm of one: 1 / spread^2.
double PriorCurvature(const Tunable& tunable);

/// ln of the share of a parameter's prior that is within its bounds; they are wide
/// above.
double LogOfPriorWithin(const Tunable& tunable);

/// ln of the integral of exp(-curvature u^2 / 2) over all u.
double LogOfIntegral(double curvature);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_TUNABLE_PARAMETERS_H_
