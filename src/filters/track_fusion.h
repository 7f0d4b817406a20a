#ifndef HINDSIGHT_FILTERS_TRACK_FUSION_H_
#define HINDSIGHT_FILTERS_TRACK_FUSION_H_

#include <array>
#include <memory>

#include "filters/linear_kalman.h"

namespace hindsight {

/// Fusion weighted by information, as if the errors of a and b were
/// independent (eq. (10) of Lee and Yoon 2011):
///   P = (P_a^-1 + P_b^-1)^-1,   x = P (P_a^-1 x_a + P_b^-1 x_b).
Track FuseByInformation(const Track& a, const Track& b);

/// Covariance intersection (Julier and Uhlmann 1997): never too sure, whatever
/// the errors of a and b have in common:
///   P^-1 = w P_a^-1 + (1 - w) P_b^-1,
///   x    = P (w P_a^-1 x_a + (1 - w) P_b^-1 x_b),
/// w in [0, 1] with the least trace of P.
Track FuseByCovarianceIntersection(const Track& a, const Track& b);

/// How the measurements of two sensors of one state become one estimate.
enum class FusionArchitecture {
  kCentral,       ///< one filter takes both sensors' measurements
  kTrackToTrack,  ///< two filters that know nothing of each other, outputs
                  ///< fused by information
  kEqualised,  ///< Lee and Yoon 2011: the two states are equalised by R before
               ///< the prediction, each filter corrects by its own sensor,
               ///< outputs are fused by P and fed back to the first filter
  kFederated,  ///< Carlson 1990, reset mode: two filters, each with half of the
               ///< process information, reset to the fused estimate
  kCovarianceIntersection,  ///< as track to track, fused by intersection
};
inline constexpr std::array kFusionArchitectures = {
    FusionArchitecture::kCentral, FusionArchitecture::kTrackToTrack,
    FusionArchitecture::kEqualised, FusionArchitecture::kFederated,
    FusionArchitecture::kCovarianceIntersection};

/// "central", "track_to_track", "equalised", "federated",
/// "covariance_intersection".
const char* FusionName(FusionArchitecture architecture);

/// An architecture over two filters, stepped from epoch to epoch.
class SensorFusion {
 public:
  virtual ~SensorFusion() = default;
  /// Predicts to the next epoch, corrects with the sensors' measurements and
  /// returns the fused estimate.
  virtual Track Step(const RowVector& z_first, const RowVector& z_second) = 0;
};

/// The two sensors observe one state; the central filter predicts as the second
/// says. `prior` is known to all filters.
std::unique_ptr<SensorFusion> MakeFusion(
    FusionArchitecture architecture, const std::array<LinearSensor, 2>& sensors,
    const Track& prior);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_TRACK_FUSION_H_
