#ifndef HINDSIGHT_FILTERS_MIXTURE_INNOVATIONS_H_
#define HINDSIGHT_FILTERS_MIXTURE_INNOVATIONS_H_

#include <cstddef>
#include <vector>

#include "filters/imm.h"

namespace hindsight {

/// An accepted measurement as all models of an IMM together predicted it.
struct MixtureInnovation {
  std::size_t epoch = 0;
  std::size_t measurement = 0;  ///< number on the tapes, within the epoch
  /// Normal scores: of right models independent N(0, 1), of each other, of
  /// those of other measurements and over time.
  RowVector scores;
};

/// The predicted density of a measurement is a mixture of normal ones, one a
/// model, so that its innovation over a standard deviation is not normal. What
/// is uniform of any density is the value of the distribution function at what
/// was measured, row after row (Rosenblatt 1952; Diebold, Gunther and Tay
/// 1998):
///   u_i = sum over j of w_ij Phi(x_ij),   x_j = L_j^-1 nu_j,  S_j = L_j L_j',
///   w_i+1,j ~ w_ij phi(x_ij) / (L_j)_ii,
/// with w_1 the predicted probabilities of the models; the score is
/// Phi^-1(u_i), at most 37. Of one model it is L^-1 nu. An IMM merges its
/// mixtures to one normal density a model, so that the scores are independent
/// as far as that is right.
std::vector<MixtureInnovation> MixtureInnovations(const ImmTape& tape);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_MIXTURE_INNOVATIONS_H_
