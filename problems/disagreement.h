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

/// Compares methods that see the whole interval. Two that both may be used must
/// be within the errors that they state, as the same data have one truth.
class MethodComparison {
 public:
  /// Evidence that makes `solution`, which is graded, doubtful: an earlier one
  /// from which a component of position or attitude is kUnusableBias of the
  /// larger standard deviation away, in the root mean square over the interval.
  /// Solutions that are not usable, forward or on other nodes say nothing.
  std::optional<Evidence> Compare(const Solution& solution);

 private:
  using Variances = Eigen::Matrix<double, 6, 1>;  ///< position, attitude
  struct Course {
    std::string method;
    std::vector<State> states = {};  ///< without parameters
    std::vector<Variances> variances = {};
  };

  std::vector<Course> courses_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_DISAGREEMENT_H_
