#ifndef HINDSIGHT_FILTERS_IMM_SMOOTHER_H_
#define HINDSIGHT_FILTERS_IMM_SMOOTHER_H_

#include "filters/imm.h"

namespace hindsight {

/// A smoothed IMM tape.
struct ImmSmoothed {
  ImmTrajectory trajectory;  ///< probabilities are p(m_k = j | z_1 ... z_N)
  /// Smoothed error of each model about its nominal x_plus, by node and model, if
  /// asked for: of long intervals they are most of the memory.
  std::vector<std::vector<Gaussian>> models;
  /// p(m_k-1 = i, m_k = j | z_1 ... z_N), row i; empty where the mode could not
  /// switch.
  std::vector<Eigen::MatrixXd> pairs;
};

/// Fixed-interval smoother of a Markov-switching system, one normal
/// distribution a mode, on the tapes of an IMM filter. Every pair of modes
/// (i at k, j at k+1) gets a Rauch-Tung-Striebel step of its own, as in Lopez
/// and Danes (ICASSP 2010) and Nadarajah et al. (IEEE TAES 48(3), 2012); its
/// weight is, as in the two-filter form of Helmick, Blair and Hoffman (IEEE
/// Trans. Inf. Theory 41(6), 1995),
///   p(i | j, z_1..z_N) ~ pi_ij mu_i(k) int N(x; x-_ij, P-_ij) l_j(x) dx,
/// where l_j(x) = p(z_k+1 .. z_N | x_k+1 = x, m_k+1 = j). No backward filter is
/// run: the likelihood of the future is what the smoothed density of mode j
/// adds to its predicted one,
///   l_j(x) ~ N(x; s_j, S_j) / N(x; x-_j, P-_j),
/// taken in the axes in which P-_j is the unit matrix and S_j diagonal, where
/// it is a measurement for each component. The steps are exact but for merging
/// the pairs into one normal density a mode. With one mode it is SmoothRts.
ImmSmoothed SmoothImm(const ImmTape& tape, bool with_models = false);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_IMM_SMOOTHER_H_
