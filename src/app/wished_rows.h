#ifndef HINDSIGHT_APP_WISHED_ROWS_H_
#define HINDSIGHT_APP_WISHED_ROWS_H_

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "evaluation/solution_table.h"
#include "problems/reconstruction.h"

namespace hindsight {

/// Ascending times: a list, or multiples of an interval, of which none is held.
class Times {
 public:
  explicit Times(std::vector<double> list);
  /// The multiples of 1/rate within the solution's span.
  Times(const Solution& solution, double rate);

  bool IsAtEnd() const { return at_ == count_; }
  double Next() const;
  /// Whether `t`, not after Next(), is among them; goes on behind it.
  bool Take(double t);

 private:
  double first_ = 0.0;
  double rate_ = 0.0;
  std::size_t count_ = 0;
  std::size_t at_ = 0;
  std::vector<double> list_;
};

/// Rows of a solution that are wanted.
struct Wish {
  Times times;
  Eigen::Vector3d point_b;  ///< of which point, from the IMU [m]
};

/// The rows of a solution as they are, of a point that many metres from the IMU.
SolutionTable TableAt(const Eigen::Vector3d& point_b, const Dataset& dataset,
                      const Solution& solution);

/// Gives the rows of TableAt to `take`, some at a time, in order.
void TakeNodes(const Eigen::Vector3d& point_b, const Dataset& dataset,
               const Solution& solution,
               const std::function<void(const SolutionTable&)>& take);

/// Fulfils all wishes in one walk, piece by piece, since a row of a solution,
/// with its whole covariance, is several times as large as that of a table: `take` is
/// given one table a wish, of the same span of time, without rows if it has none there.
void SampleRows(
    const Dataset& dataset, const Reconstruction& reconstruction,
    const Solution& solution, std::vector<Wish> wishes,
    const std::function<void(const std::vector<SolutionTable>&)>& take);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_WISHED_ROWS_H_
