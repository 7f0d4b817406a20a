#ifndef HINDSIGHT_ALIGNMENT_WINDOW_MODEL_H_
#define HINDSIGHT_ALIGNMENT_WINDOW_MODEL_H_

#include <optional>
#include <vector>

#include "alignment/alignment.h"
#include "filters/iterated_smoother.h"

namespace hindsight {

/// Where a refinement begins: near the truth, P of psi in NED axes.
struct WindowStart {
  Eigen::Quaterniond q_eb = Eigen::Quaterniond::Identity();
  Eigen::Vector3d b_g = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::Vector3d b_a = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();    ///< [rad^2]
};

/// The attitude at input.t as it is known beforehand, and its covariance.
struct AttitudePrior {
  Eigen::Quaterniond q_eb = Eigen::Quaterniond::Identity();
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
};

/// The estimation over [input.t, t_end] with one gyro bias walk. Its prior says
/// of velocity and position nothing, of the attitude nothing but `known`, and
/// of the biases what `data` (CutOut) says; where it says nothing, the state
/// `near` is its mean.
class WindowModel {
 public:
  /// With the larger of the stated walk and `least_walk` [rad/s/sqrt(s)].
  /// `input` must outlive the model.
  WindowModel(const AlignmentInput& input, double t_end,
              const std::optional<AttitudePrior>& known, const Dataset& data,
              double least_walk);

  const ErrorLayout& layout() const { return problem_.layout; }
  double gyro_bias_walk() const { return dataset_.imu.noise.gyro_bias_walk; }

  /// Forward filter and RTS pass from a start. Throws EstimationError where the
  /// filter diverges, as the others.
  SmoothedTrajectory FilterFrom(const WindowStart& start);
  /// SmoothIterated without covariances, `rough` as in IterationOptions.
  IteratedResult Settle(const State& near, std::vector<State> states,
                        const CovarianceSeries& rough);
  /// One pass more, with covariances, which claim of the heading what the
  /// likelihood has (WidenHeading).
  SmoothedTrajectory Smooth(const State& near,
                            const std::vector<State>& states);
  /// Mean normalised squared residual of a row.
  double Nis(const std::vector<State>& states) const;

 private:
  Problem MakeProblem(double t_end) const;
  NavigationPrior BiasPrior() const;
  ErrorMatrix Covariance(double position, double velocity) const;
  /// Near enough to be filtered from: the attitude three times as uncertain as
  /// the coarse alignment says, and a degree.
  Prior NearPrior(const WindowStart& start) const;
  Prior VaguePrior(const State& near) const;

  const AlignmentInput& input_;
  std::optional<AttitudePrior> known_;
  Dataset dataset_;
  Problem problem_;  ///< its prior is that of the last estimation
};

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_WINDOW_MODEL_H_
