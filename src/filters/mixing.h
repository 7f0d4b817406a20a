#ifndef HINDSIGHT_FILTERS_MIXING_H_
#define HINDSIGHT_FILTERS_MIXING_H_

#include <Eigen/Core>
#include <vector>

#include "state/error_layout.h"

namespace hindsight {

/// A normal distribution of an error over some layout, about some nominal.
struct Gaussian {
  ErrorVector mean;
  ErrorMatrix P;
};

/// For each component of `target` the same component of `source` (block key and
/// axis), or -1 if `source` does not have it.
using ComponentMap = std::vector<int>;
ComponentMap SharedComponents(const ErrorLayout& target,
                              const ErrorLayout& source);

/// What `from` says, over the layout of `own`: the components s that both have
/// are those of `from`; the others, e, follow them as in `own`,
///   p(s, e) = p_from(s) p_own(e | s),
///   m_e = m_e,own + G (m_s - m_s,own),   G = P_es,own P_ss,own^-1,
///   P_es = G P_ss,   P_ee = P_ee,own - G P_se,own + G P_ss G'.
/// Throws EstimationError if P_ss,own is not positive definite.
Gaussian Transfer(const Gaussian& from, const Gaussian& own,
                  const ComponentMap& shared);

/// Mean and covariance of a mixture,
///   m = sum w_i m_i,   P = sum w_i (P_i + (m_i - m)(m_i - m)').
/// The weights sum to one.
Gaussian Merge(const std::vector<Gaussian>& parts,
               const Eigen::Ref<const Eigen::VectorXd>& weights);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_MIXING_H_
