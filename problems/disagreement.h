#ifndef HINDSIGHT_PROBLEMS_DISAGREEMENT_H_
#define HINDSIGHT_PROBLEMS_DISAGREEMENT_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "state/solution.h"

namespace hindsight {

/// Where a method had the vehicle.
struct Pose {
  double t;
  Eigen::Vector3d p_e;
  Eigen::Quaterniond q_eb;
};

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
  std::string method_;
  std::vector<Pose> poses_;
};

/// Which solutions a MethodComparison asks, and what it says of two that are
/// apart.
struct ComparisonTerms {
  /// Also those of forward methods and those that are not usable.
  bool of_all = false;
  /// Of about so many nodes at most, evenly chosen.
  std::size_t most_nodes = std::numeric_limits<std::size_t>::max();
  /// The arguments are the earlier method, the later one, how many sigmas they
  /// are apart, in which component, and the limit.
  const char* what;
  std::vector<std::string> causes;
  std::vector<std::string> remedies = {};
};

/// Of methods that see the whole interval, and have positions.
ComparisonTerms TrajectoryTerms();
/// Of attitude alone, causal or not.
ComparisonTerms AttitudeTerms();

/// Compares methods on the same data, which have one truth: two must be within
/// the errors that they state.
class MethodComparison {
 public:
  explicit MethodComparison(ComparisonTerms terms) : terms_(std::move(terms)) {}

  /// Evidence that makes `solution`, which is graded, doubtful: an earlier one
  /// from which a component of position or attitude, as far as its layout has
  /// them, is kUnusableBias of the larger standard deviation away, in the root
  /// mean square over the interval. Solutions on other nodes say nothing.
  std::optional<Evidence> Compare(const Solution& solution);

  /// Evidence, by method, that makes methods doubtful which take the sensors at their
  /// word: by the one that seeks their errors (MethodTrait::kSearches) a component of
  /// position or attitude is kUnusableBias of the method's own standard deviation off, in
  /// the root mean square of
  ///   sqrt(d^2 + P_s) / sqrt(P_m)
  /// over the interval, P_s and P_m being the variances of the one that seeks and of the
  /// method, d the distance between them, which is left out on other nodes. `solution` is
  /// graded, and not compared yet; the other is an earlier one.
  std::vector<std::pair<std::string, Evidence>> TooSure(
      const Solution& solution) const;

 private:
  /// Of position and attitude [m^2, rad^2].
  using Variances = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
  struct Course {
    std::string method;
    bool seeks = false;  ///< the errors of sensors
    std::vector<Pose> poses = {};
    std::vector<Variances> variances = {};
  };

  /// In sigmas of `sure`, by component, the mean square of what `searched` holds it to err.
  static Variances ExpectedSquares(const ErrorLayout& layout,
                                   const Course& sure, const Course& searched);

  bool Asks(const Solution& solution) const;
  Course CourseOf(const Solution& solution) const;

  ComparisonTerms terms_;
  std::vector<Course> courses_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_DISAGREEMENT_H_
