#ifndef HINDSIGHT_FILTERS_HEADING_PROFILE_H_
#define HINDSIGHT_FILTERS_HEADING_PROFILE_H_

#include <vector>

#include "base/units.h"
#include "filters/forward_filter.h"
#include "state/covariance_series.h"

namespace hindsight {

/// How much of the information about heading that covariances claim the
/// likelihood has. A heading error turns the specific force, dv' = -[f_n x]
/// psi, and f_n is known as measured: the energy of the accelerometer's white
/// noise in it counts as information although it says nothing, about 1/rad^2 a
/// second where aiding is as good as the IMU (errors in variables; Fuller,
/// Measurement Error Models, 1987, section 1.2). Where a vehicle stands, hovers
/// or rises, that is all.
///
/// The profile of the likelihood L over the heading psi at the first state, all
/// else solved anew for each, tells:
///   curvature = (L(0) - (L(-d) + L(d)) / 2) / (d^2 / (2 sigma^2)),
/// d = 2 sigma, at most a quarter turn, with sigma as P has it; 1 where the
/// problem is linear, 0 where the data fit any heading. Information that is all
/// noise makes a likelihood that is a random sum of sines of the heading: about
/// its maximum the curvature exceeds c by chance with the probability
/// exp(-(c I - I_0)^2 / (2 (I - I_0))), I = 1/sigma^2 and I_0 that of the prior
/// (Rayleigh). If that is more than one in ten thousand, it is told as 0.
/// Taken for 1 unless HeadingMayBeNoise; 0 if another heading cannot be solved
/// for.
struct HeadingCredit {
  double curvature = 1.0;
  /// Variance of the heading by the prior alone, at most that of an angle of
  /// which nothing is known, (104 deg)^2 [rad^2].
  double open = kPi * kPi / 3.0;
};

HeadingCredit CreditHeading(const Problem& problem,
                            const std::vector<State>& states,
                            const CovarianceSeries& P);

/// ln of the likelihood of the trajectory turned round, heading + 180 deg and
/// all else solved anew, over that of the states; not above 0. The prior's
/// heading does not count: it is to come from the same measurements. Minus
/// infinity unless MayBeTurnedRound, or if that cannot be solved for.
double LogOddsOfTurnedRound(Problem problem, const std::vector<State>& states,
                            const CovarianceSeries& P);

/// Whether the trajectory might fit the data as well with the heading turned by
/// 180 deg: there is a non-holonomic constraint, which holds for a vehicle that
/// drives backwards too, and the energy of the horizontal force is below ten
/// thousand times that of the noise. Cheap.
bool MayBeTurnedRound(const Problem& problem, const std::vector<State>& states);

/// Whether CreditHeading has to look at the likelihood: the energy of the
/// changes of velocity by the horizontal force, over a second each, is below a
/// hundred times that of the noise, and P claims the heading at the first state
/// to better than 50 deg (an angle of which nothing is known has 104 deg).
/// Cheap.
bool HeadingMayBeNoise(const Problem& problem, const std::vector<State>& states,
                       const CovarianceSeries& P);

/// Curvature from which on the heading is taken to be as sure as its covariance
/// says: its sigma is then too small by a quarter at most.
inline constexpr double kCredibleHeading = 0.8;

/// Covariances that claim of the heading what the likelihood has: its gradient
/// has the variance 1/sigma^2 that the information claims, its curvature less,
/// so that the variance of its maximum is sigma^2 / curvature^2 (the sandwich
/// of Huber 1967), at most credit.open. The rest follows by its correlation
/// with the heading. Nothing is changed from kCredibleHeading on.
void WidenHeading(const ErrorLayout& layout, const HeadingCredit& credit,
                  CovarianceSeries* P);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_HEADING_PROFILE_H_
