#ifndef HINDSIGHT_FILTERS_SIDE_AGREEMENT_H_
#define HINDSIGHT_FILTERS_SIDE_AGREEMENT_H_

#include <span>
#include <vector>

#include "filters/linear_tape.h"
#include "filters/mean_shift.h"

namespace hindsight {

/// How far apart two estimates of a block of the state are at an epoch, of a
/// right system the root of a chi-square variable.
struct SideAgreement {
  enum class Of {
    /// d = Lambda^-1 lambda: the forward prediction against what the backward
    /// filter knows alone, with P_f + P_b (Fraser and Potter 1969).
    kForwardAndBackward,
    /// d = P_f lambda: the filter against the smoother, with P_f - P_s, of
    /// which P_f Lambda P_f is the exact form (Rauch, Tung, Striebel 1965).
    kFilterAndSmoother,
  };
  Of of = Of::kForwardAndBackward;
  BlockKind block = BlockKind::kPosition;
  std::size_t epoch = 0;
  double distance = 0.0;  ///< sqrt(d' Cov(d)^-1 d) [sigma]
  int dof = 0;
};

/// Both of position, velocity and attitude at the epochs of `scores`, before
/// their measurements. Directions of which the one side knows nothing that the
/// other does not are left out of d, and so is what has none left.
std::vector<SideAgreement> AgreementOfSides(const LinearTape& tape,
                                            std::span<const StateScore> scores);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_SIDE_AGREEMENT_H_
