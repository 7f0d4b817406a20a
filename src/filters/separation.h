#ifndef HINDSIGHT_FILTERS_SEPARATION_H_
#define HINDSIGHT_FILTERS_SEPARATION_H_

#include "filters/information.h"
#include "filters/linear_tape.h"
#include "state/filter_separation.h"

namespace hindsight {

/// What a backward filter says alone at an epoch of a tape, against the forward
/// estimate (x_f, P_f) with the epoch's measurements, in the tape's tangent.
class BackwardSide {
 public:
  /// `alone` as Information::AloneAbout(x_f) gives it; a standard deviation
  /// beyond a million of `scale` says that nothing is known.
  BackwardSide(const LinearTape& tape, std::size_t k,
               const Information::Estimate& alone, const ErrorVector& scale);

  /// Distance of the positions in sigmas of their difference:
  /// sqrt(e' (P_f + P_b)^-1 e). NaN without a backward position.
  double Distance() const;

  /// Component by component; angles to first order,
  /// d(roll, pitch, heading) = J psi (EulerErrorJacobian).
  FilterSeparation Components() const;

  OneSidedState Alone() const;

 private:
  bool Knows(int component) const;
  void FillVector(BlockKind kind, int first, FilterSeparation* out) const;
  void FillAngles(FilterSeparation* out) const;

  const LinearTape& tape_;
  const std::size_t k_;
  const ErrorVector difference_;  ///< x_b - x_f
  const ErrorMatrix P_b_;
  const ErrorMatrix P_f_;
  const ErrorVector most_;  ///< standard deviations that still say something
};

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_SEPARATION_H_
