#ifndef HINDSIGHT_PROBLEMS_DISAGREEMENT_H_
#define HINDSIGHT_PROBLEMS_DISAGREEMENT_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "state/solution.h"

namespace hindsight {

/// Compares methods that minimise the same cost. If two have converged by their
/// own criteria, their solutions must agree to a fraction of a sigma; if they
/// do not, the cost has several minima, or one of them stopped too early.
class OptimumComparison {
 public:
  /// Evidence that makes `solution` doubtful: a component of position or
  /// attitude that is more than one sigma from where an earlier method ended,
  /// at the worst time. The first solution, or one on other nodes, is kept for
  /// the next. Solutions that did not converge say nothing.
  std::optional<Evidence> Compare(const std::string& method,
                                  const Solution& solution);

 private:
  struct Pose {
    double t;
    Eigen::Vector3d p_e;
    Eigen::Quaterniond q_eb;
  };

  bool HasNodesOf(const Solution& solution) const;

  std::string method_;
  std::vector<Pose> poses_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_DISAGREEMENT_H_
