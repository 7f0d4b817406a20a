#ifndef HINDSIGHT_FILTERS_MEAN_SHIFT_H_
#define HINDSIGHT_FILTERS_MEAN_SHIFT_H_

#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "filters/forward_filter.h"
#include "filters/linear_tape.h"

namespace hindsight {

/// Constants that a linear-Gaussian system does not have, in groups: by which
/// columns they would enter it. A group has as many everywhere.
struct ShiftColumns {
  using Group = int;
  struct Columns {
    Group group = 0;
    Eigen::MatrixXd B;
    bool may_grow = true;  ///< whether deviations that grow are looked for too
  };
  /// What the deviation would add to a measurement of epoch k.
  std::function<std::vector<Columns>(std::size_t k, const TapeMeasurement& z)>
      measured;
  /// By what the state at x_minus of epoch k >= 1 would be another after the
  /// interval before it; none: never. Of one group, which no measurement has.
  std::function<Columns(std::size_t k)> driven = nullptr;
};

/// One way to deviate from the system, by a size of its own: from an epoch on
/// there is B theta, or B (t - t_onset) theta, too much, or the state is another
/// than the system leads to.
struct MeanShift {
  bool of_state = false;
  ShiftColumns::Group group = 0;  ///< unless of the state
  int column = 0;                 ///< of the group's, or component of the state
  bool grows = false;             ///< with the time since the onset
  std::size_t onset = 0;
  /// With g the innovations that it causes at the size of one, and nu and S
  /// those found and their covariances: sums of g' S^-1 nu and g' S^-1 g.
  double score = 0.0;
  double information = 0.0;

  double size() const { return score / information; }
  double sigma() const { return 1.0 / std::sqrt(information); }
  /// N(0, 1) where there is no such deviation, N(size / sigma, 1) of one: the
  /// most powerful test of it (Willsky and Jones, IEEE Trans. AC-21, 1976; the
  /// w-test of Baarda 1968).
  double z() const { return score / std::sqrt(information); }
};

/// What the innovations from an epoch on, its own included, say of the error of
/// its predicted state: the backward filter against the forward one. Of a right
/// system lambda ~ N(0, Lambda).
struct StateScore {
  std::size_t epoch = 0;
  ErrorVector lambda;
  ErrorMatrix Lambda;
};

struct Scores {
  std::vector<MeanShift> shifts;
  std::vector<StateScore> states;  ///< of each onset but the first, descending
};

/// At most `count` epochs about equally far apart in time, the first included.
std::vector<std::size_t> SpreadOnsets(const LinearTape& tape, int count);

/// Every such deviation that the innovations of a tape could show, from each of
/// some epochs on (ascending); constants from the first on are there throughout.
/// One backward pass of the adjoint of the filter (TapeAdjoint) with the constants
/// beside its states, H and Phi of both, K of the states alone: at the onset, lambda is the score
/// and Lambda the information. The cost does not depend on how many epochs are
/// asked for. Requires a tape about a fixed nominal. `callback` hears of each epoch.
Scores ScoreShifts(const LinearTape& tape, const ShiftColumns& columns,
                   std::span<const std::size_t> onsets,
                   const EpochCallback& callback = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_MEAN_SHIFT_H_
