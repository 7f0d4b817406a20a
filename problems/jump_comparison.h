#ifndef HINDSIGHT_PROBLEMS_JUMP_COMPARISON_H_
#define HINDSIGHT_PROBLEMS_JUMP_COMPARISON_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "problems/montecarlo.h"

namespace hindsight {

/// One method over the runs that it finished.
struct JumpStatistics {
  std::string name;
  int failed = 0;
  double seconds = 0.0;  ///< processor time of the method alone, mean
  std::vector<double> t;
  /// Root mean squares over the runs, (north, east) [m] and [m/s].
  std::vector<Eigen::Vector2d> position_rms;
  std::vector<Eigen::Vector2d> velocity_rms;
  /// Mean over the runs of e' P^-1 e, e the horizontal position error; right
  /// is 2.
  std::vector<double> anees;
  std::vector<Eigen::VectorXd> probabilities;  ///< of the modes, mean; or empty

  /// Root mean square of an axis of the position over [from, to].
  double PositionRms(double from, double to) const;
  double VelocityRms(double from, double to) const;
  double Anees(double from, double to) const;
};

/// The recordings of a scenario by every method of the jump comparison:
/// kf0, kf1, imm and imm_smoother are those of Baek (2019), see
/// problems/position_imm.h; gated_ekf, rts, batch and robust_batch those of
/// Reconstruction.
/// `options` are as in RunMonteCarlo; legs and bounds are not used. Throws as
/// that.
std::vector<JumpStatistics> CompareOnJumps(
    const std::function<Dataset(std::uint64_t seed)>& dataset,
    const MonteCarloOptions& options);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_JUMP_COMPARISON_H_
