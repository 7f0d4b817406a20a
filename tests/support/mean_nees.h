#ifndef HINDSIGHT_TESTS_SUPPORT_MEAN_NEES_H_
#define HINDSIGHT_TESTS_SUPPORT_MEAN_NEES_H_

#include <Eigen/Cholesky>
#include <vector>

#include "dataset/dataset.h"
#include "evaluation/true_states.h"
#include "state/solution.h"

namespace hindsight {

/// Mean over the nodes of e' P^-1 e of position, velocity or attitude, where 3 is
/// right. The truth must have every node's time.
inline double MeanNees(const Dataset& dataset, const Solution& solution,
                       BlockKind kind) {
  const std::vector<State> truth =
      TrueStates(dataset, solution.layout, solution.states);
  const int offset = solution.layout.Find(kind)->offset;
  double sum = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const Eigen::Vector3d e =
        Local(solution.layout, solution.states[k], truth[k]).segment<3>(offset);
    const Eigen::Matrix3d P =
        solution.covariances.Get(k).block<3, 3>(offset, offset);
    sum += e.dot(P.llt().solve(e));
  }
  return sum / static_cast<double>(truth.size());
}

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_SUPPORT_MEAN_NEES_H_
