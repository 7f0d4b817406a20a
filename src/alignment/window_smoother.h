#ifndef HINDSIGHT_ALIGNMENT_WINDOW_SMOOTHER_H_
#define HINDSIGHT_ALIGNMENT_WINDOW_SMOOTHER_H_

#include <map>
#include <optional>
#include <vector>

#include "alignment/window_model.h"
#include "state/covariance_series.h"

namespace hindsight {

/// The motion over a window with its covariances, by all that position,
/// velocity, speed, height and standstill measurements say.
struct WindowSolution {
  ErrorLayout layout;
  std::vector<State> states;  ///< the first at input.t
  CovarianceSeries P;
  double nis = 1.0;  ///< mean normalised squared residual of a row; right is 1
  /// Of all measurements, linearised about the solution.
  double log_likelihood = 0.0;
  /// With which the gyro biases were let drift [rad/s/sqrt(s)].
  double gyro_bias_walk = 0.0;
};

/// With which a gyro bias changes in a minute by its a priori sigma (the worst
/// axis), for both come from temperature [rad/s/sqrt(s)].
double WarmUpWalk(const AlignmentInput& input);

/// Refines an attitude over [input.t, t_end] with the full models of IMU noise,
/// lever arms and time offsets: forward filter and RTS pass from the start,
/// then SmoothIterated about that from a prior which says of velocity and
/// position nothing, of the attitude nothing but `known`, and of the biases
/// GyroBiasBefore and the configuration say. P therefore holds what the window
/// tells, and no more; it is scaled up by `nis` where that exceeds one, and of
/// the heading it claims what the likelihood has (WidenHeading).
class WindowSmoother {
 public:
  /// `input` must outlive it.
  WindowSmoother(const AlignmentInput& input, double t_end,
                 std::optional<AttitudePrior> known = std::nullopt);

  /// A gyro that warms up drifts faster than its data sheet says: besides with
  /// the stated walk, or `least_walk` if that is larger, the window is smoothed
  /// with walks of 0.003 to 0.3 deg/s/sqrt(s), at most five times WarmUpWalk,
  /// and a larger one is taken where it raises the log-likelihood, over `nis`,
  /// by more than 5. A steady drift looks like a small walk, whose independent
  /// steps carry it on far too surely to where it is not seen: of the walks up
  /// to WarmUpWalk the largest is taken below which none lowers the
  /// log-likelihood by as much as that again. Where a solution explains the
  /// measurements that with the next walk begins there, else from `start`, for
  /// it may lie in a wrong minimum. Empty if no iteration settles.
  std::optional<WindowSolution> Smooth(const WindowStart& start,
                                       double least_walk);

 private:
  /// Where an iteration begins, and covariances that are roughly the result's.
  struct Beginning {
    State near;  ///< mean of what the prior does not know
    std::vector<State> states;
    CovarianceSeries rough;
  };
  /// What one walk leads to.
  struct Trial {
    double walk = 0.0;
    State near;
    std::vector<State> states;
    double nis = 1.0;             ///< of a row of the residuals
    double innovation_nis = 1.0;  ///< the same of the innovations
    double log_likelihood = 0.0;
  };
  /// Empty if it does not settle, neither from where the last did nor from the
  /// start.
  const Trial* Try(const WindowStart& start, double walk);
  static std::optional<Beginning> Begin(const WindowStart& start,
                                        WindowModel* model);
  static std::optional<Trial> Settle(const Beginning& from, WindowModel* model);
  const Trial* Likeliest(const WindowStart& start, double usual);
  const Trial* LargestWalk(const WindowStart& start, const Trial* likeliest);
  WindowSolution WithCovariances(const Trial& trial) const;

  const AlignmentInput& input_;
  double t_end_;
  std::optional<AttitudePrior> known_;
  Dataset data_;
  std::optional<Beginning> next_;
  std::map<double, Trial> trials_;  ///< that settled, by walk
  const Trial* solved_ = nullptr;   ///< of these, the one that was taken last
  std::optional<WindowSolution> solution_;  ///< WithCovariances of that
};

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_WINDOW_SMOOTHER_H_
