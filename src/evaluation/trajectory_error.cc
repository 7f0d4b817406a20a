#include "evaluation/trajectory_error.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <functional>

#include "base/chi_square.h"
#include "evaluation/interpolation.h"
#include "geometry/so3.h"
#include "state/euler_error.h"

namespace hindsight {
namespace {

using OptionalVector = std::optional<Eigen::Vector3d>;

/// Absent for a covariance that is not positive definite: no normalised error
/// exists then.
std::optional<double> Nees(const OptionalVector& error,
                           const std::optional<Eigen::Matrix3d>& P,
                           const Eigen::Matrix3d& R) {
  if (!error || !P) return std::nullopt;
  const Eigen::LLT<Eigen::Matrix3d> llt(*P + R);
  if (llt.info() != Eigen::Success) return std::nullopt;
  return error->dot(llt.solve(*error));
}

Eigen::Matrix3d Variances(const OptionalVector& sigma) {
  if (!sigma) return Eigen::Matrix3d::Zero();
  return sigma->cwiseAbs2().asDiagonal();
}

/// Of a rotation vector in NED axes, as the truth's sigmas of roll, pitch and
/// heading say.
Eigen::Matrix3d AttitudeVariance(const TruthPoint& truth,
                                 const OptionalVector& sigma) {
  if (!sigma || !truth.q_nb) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d M =
      EulerErrorJacobian(EulerFromQuaternion(*truth.q_nb)).inverse();
  return M * sigma->cwiseAbs2().asDiagonal() * M.transpose();
}

Eigen::Vector3d EulerDifference(const Eigen::Matrix3d& C_nb_truth,
                                const Eigen::Matrix3d& C_nb) {
  const Eigen::Vector3d d =
      EulerFromQuaternion(Eigen::Quaterniond(C_nb_truth)) -
      EulerFromQuaternion(Eigen::Quaterniond(C_nb));
  return {WrapAngle(d.x()), WrapAngle(d.y()), WrapAngle(d.z())};
}

TrajectoryError Compare(const InterpolatedState& x, const TruthPoint& truth,
                        const TrajectoryErrorOptions& options) {
  const Eigen::Vector3d& l_b = options.truth_lever_arm_b;
  TrajectoryError error;
  error.t = truth.t;
  const Eigen::Matrix3d C_en =
      x.p_e ? NedAxes(*x.p_e) : Eigen::Matrix3d::Identity().eval();
  // A truth without place speaks of the solution's axes; one with a place
  // where the solution has none can only be compared as it stands.
  const Eigen::Matrix3d C_en_truth =
      x.p_e && truth.p_e ? NedAxes(*truth.p_e) : C_en;
  const Eigen::Matrix3d C_eb =
      x.q_eb ? x.q_eb->toRotationMatrix() : Eigen::Matrix3d::Identity().eval();
  const bool can_move = x.q_eb || l_b.isZero(0.0);
  if (x.p_e && truth.p_e && can_move) {
    error.position = C_en.transpose() * (*truth.p_e - *x.p_e - C_eb * l_b);
  }
  if (x.v_e && truth.v_n && can_move) {
    const Eigen::Vector3d v_e = *x.v_e + C_eb * x.w_eb_b.cross(l_b);
    error.velocity = C_en.transpose() * (C_en_truth * *truth.v_n - v_e);
  }
  if (x.q_eb && truth.q_nb) {
    const Eigen::Matrix3d C_nb = C_en.transpose() * C_eb;
    const Eigen::Matrix3d C_nb_truth = truth.q_nb->toRotationMatrix();
    error.euler = EulerDifference(C_nb_truth, C_nb);
    error.rotation = Log(Eigen::Quaterniond(C_en.transpose() * C_en_truth *
                                            C_nb_truth * C_nb.transpose()));
  }
  const TruthSigma& sigma = options.truth_sigma;
  error.position_nees =
      Nees(error.position, x.P_position, Variances(sigma.position));
  error.velocity_nees =
      Nees(error.velocity, x.P_velocity, Variances(sigma.velocity));
  error.attitude_nees = Nees(error.rotation, x.P_attitude,
                             AttitudeVariance(truth, sigma.attitude));
  return error;
}

std::vector<Eigen::Vector3d> Collect(const std::vector<TrajectoryError>& errors,
                                     OptionalVector TrajectoryError::*part) {
  std::vector<Eigen::Vector3d> values;
  for (const TrajectoryError& error : errors) {
    if (error.*part) values.push_back(*(error.*part));
  }
  return values;
}

ErrorStatistics StatisticsOf(
    const std::vector<Eigen::Vector3d>& vectors,
    const std::function<double(const Eigen::Vector3d&)>& component) {
  std::vector<double> values;
  values.reserve(vectors.size());
  for (const Eigen::Vector3d& v : vectors) values.push_back(component(v));
  return ComputeStatistics(values);
}

double Norm(const Eigen::Vector3d& v) { return v.norm(); }
double HorizontalNorm(const Eigen::Vector3d& v) { return v.head<2>().norm(); }

std::array<ErrorStatistics, 3> AxisStatistics(
    const std::vector<Eigen::Vector3d>& vectors) {
  std::array<ErrorStatistics, 3> axes;
  for (std::size_t i = 0; i < 3; ++i) {
    axes[i] = StatisticsOf(vectors, [i](const Eigen::Vector3d& v) {
      return v(static_cast<Eigen::Index>(i));
    });
  }
  return axes;
}

std::optional<VectorErrorStatistics> VectorStatistics(
    const std::vector<Eigen::Vector3d>& vectors) {
  if (vectors.empty()) return std::nullopt;
  return VectorErrorStatistics{AxisStatistics(vectors),
                               StatisticsOf(vectors, HorizontalNorm),
                               StatisticsOf(vectors, Norm)};
}

std::optional<double> Mean(const std::vector<TrajectoryError>& errors,
                           std::optional<double> TrajectoryError::*part) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const TrajectoryError& error : errors) {
    if (!(error.*part)) continue;
    sum += *(error.*part);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

}  // namespace

std::vector<TrajectoryError> ComputeTrajectoryErrors(
    const SolutionTable& solution, const TruthSeries& truth,
    const TrajectoryErrorOptions& options) {
  const TrajectoryInterpolator interpolator(solution, options.max_gap);
  std::vector<TrajectoryError> errors;
  for (const TruthPoint& point : truth) {
    const std::optional<InterpolatedState> x = interpolator.At(point.t);
    if (!x) continue;
    const TrajectoryError error = Compare(*x, point, options);
    if (error.position || error.velocity || error.rotation) {
      errors.push_back(error);
    }
  }
  return errors;
}

double TrajectoryStatistics::matched_percent() const {
  if (truth_count == 0) return 0.0;
  return 100.0 * static_cast<double>(matched_count) /
         static_cast<double>(truth_count);
}

namespace {

/// Part of the normalised squared errors that lie within the ellipsoid.
std::optional<double> PartInside(const std::vector<TrajectoryError>& errors,
                                 std::optional<double> TrajectoryError::*nees) {
  constexpr double kThreeSigmas = 0.9973;
  const double limit = ChiSquareQuantile(kThreeSigmas, 3.0);
  double count = 0.0;
  double inside = 0.0;
  for (const TrajectoryError& error : errors) {
    const std::optional<double>& value = error.*nees;
    if (!value) continue;
    count += 1.0;
    if (*value <= limit) inside += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  return inside / count;
}

}  // namespace

TrajectoryStatistics SummarizeErrors(const std::vector<TrajectoryError>& errors,
                                     std::size_t truth_count) {
  TrajectoryStatistics s;
  s.truth_count = truth_count;
  s.matched_count = errors.size();
  s.position = VectorStatistics(Collect(errors, &TrajectoryError::position));
  s.velocity = VectorStatistics(Collect(errors, &TrajectoryError::velocity));
  const auto euler = Collect(errors, &TrajectoryError::euler);
  const auto rotation = Collect(errors, &TrajectoryError::rotation);
  if (!euler.empty()) {
    s.attitude = AttitudeErrorStatistics{AxisStatistics(euler),
                                         StatisticsOf(rotation, HorizontalNorm),
                                         StatisticsOf(rotation, Norm)};
  }
  s.position_nees = Mean(errors, &TrajectoryError::position_nees);
  s.velocity_nees = Mean(errors, &TrajectoryError::velocity_nees);
  s.attitude_nees = Mean(errors, &TrajectoryError::attitude_nees);
  s.attitude_inside = PartInside(errors, &TrajectoryError::attitude_nees);
  return s;
}

std::string Contradiction(const TrajectoryStatistics& statistics) {
  constexpr double kBeyondDoubt = 100.0;
  std::string text;
  const auto add = [&text](const char* name, std::optional<double> nees) {
    if (!nees || *nees <= kBeyondDoubt) return;
    text += fmt::format("{}{} {:.4g}", text.empty() ? "" : ", ", name, *nees);
  };
  add("position", statistics.position_nees);
  add("velocity", statistics.velocity_nees);
  add("attitude", statistics.attitude_nees);
  if (text.empty()) return "";
  return "its covariances are not credible against the truth: mean NEES of " +
         text + ", where 3 is right";
}

TrajectoryStatistics SummarizeErrors(const std::vector<TrajectoryError>& errors,
                                     const TruthSeries& truth) {
  TrajectoryStatistics s = SummarizeErrors(errors, truth.size());
  if (!s.position) return s;
  std::optional<Eigen::Vector3d> last;
  double distance = 0.0;
  for (const TruthPoint& point : truth) {
    if (!point.p_e || point.t < errors.front().t || point.t > errors.back().t) {
      continue;
    }
    if (last) distance += (*point.p_e - *last).norm();
    last = point.p_e;
  }
  for (const TrajectoryError& error : errors) {
    if (error.position) s.final_horizontal = error.position->head<2>().norm();
  }
  s.distance = distance;
  return s;
}

TrajectoryStatistics EvaluateTrajectory(const SolutionTable& solution,
                                        const TruthSeries& truth,
                                        const TrajectoryErrorOptions& options) {
  return SummarizeErrors(ComputeTrajectoryErrors(solution, truth, options),
                         truth);
}

}  // namespace hindsight
