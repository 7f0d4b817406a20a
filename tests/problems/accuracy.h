#ifndef HINDSIGHT_PROBLEMS_ACCURACY_H_
#define HINDSIGHT_PROBLEMS_ACCURACY_H_

#include <cmath>
#include <string>

#include "dataset/dataset.h"
#include "earth/wgs84.h"
#include "problems/reconstruction.h"

namespace hindsight::testing {

struct Accuracy {
  double horizontal_rms = 0.0;
  double position_nees = 0.0;
};

/// Against the truth at the nodes.
inline Accuracy Judge(const Dataset& dataset, const Solution& solution) {
  double squares = 0.0;
  double nees = 0.0;
  int count = 0;
  std::size_t k = 0;
  for (const TruthPoint& truth : dataset.truth) {
    while (k + 1 < solution.states.size() &&
           solution.states[k].t < truth.t - 1e-6) {
      ++k;
    }
    const State& x = solution.states[k];
    if (std::abs(x.t - truth.t) > 1e-6) continue;
    const Eigen::Vector3d e = x.C_en().transpose() * (*truth.p_e - x.p_e);
    const Eigen::Matrix3d P = solution.covariances.Get(k).topLeftCorner<3, 3>();
    squares += e.head<2>().squaredNorm();
    nees += e.dot(P.llt().solve(e));
    ++count;
  }
  return {std::sqrt(squares / count), nees / count};
}

inline Solution SolveBy(const std::string& method, const Dataset& dataset) {
  ReconstructionOptions options;
  options.method = method;
  return Solve(dataset, options);
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_PROBLEMS_ACCURACY_H_
