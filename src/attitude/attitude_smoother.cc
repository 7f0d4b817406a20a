#include "attitude/attitude_smoother.h"

#include "geometry/so3.h"

namespace hindsight {
namespace {

using Vector = AttitudeState::Vector;
using Matrix = AttitudeState::Matrix;

/// The adjoint of the error and its covariance.
class Adjoint {
 public:
  explicit Adjoint(bool covariances) : covariances_(covariances) {}

  /// Back over a reading.
  void Take(const ScalarUpdate& update) {
    const double inverse = 1.0 / update.S;
    const Vector K = inverse * update.PHt;
    lambda_ += (inverse * update.innovation - K.dot(lambda_)) * update.h;
    if (!covariances_) return;
    const Vector v = Lambda_ * K;
    const Vector u = 0.5 * (K.dot(v) + inverse) * update.h - v;
    // h u' + u h'
    Lambda_.noalias() += update.h * u.transpose();
    Lambda_.noalias() += u * update.h.transpose();
  }

  /// Back over an interval.
  void Take(const AttitudeTransition& transition) {
    const Eigen::Matrix<double, 3, 6>& A = transition.A;
    const double phi = transition.phi;
    lambda_.segment<3>(3) *= phi;
    lambda_.tail<6>() += A.transpose() * lambda_.head<3>();
    if (!covariances_) return;
    if (phi != 1.0) {
      Lambda_.middleRows<3>(3) *= phi;
      Lambda_.middleCols<3>(3) *= phi;
    }
    const Eigen::Matrix<double, 3, 6> L_ac = Lambda_.topRightCorner<3, 6>();
    const Eigen::Matrix<double, 3, 6> L_aa_A =
        Lambda_.topLeftCorner<3, 3>() * A;
    const Eigen::Matrix<double, 6, 6> cross = A.transpose() * L_ac;
    Lambda_.bottomRightCorner<6, 6>() +=
        cross + cross.transpose() + A.transpose() * L_aa_A;
    Lambda_.topRightCorner<3, 6>() += L_aa_A;
    Lambda_.bottomLeftCorner<6, 3>() =
        Lambda_.topRightCorner<3, 6>().transpose();
  }

  /// At a node with covariance P.
  void Smooth(const Matrix& P, SmoothedAttitude* out) const {
    out->d.noalias() = P * lambda_;
    if (!covariances_) return;
    const Matrix LP = Lambda_ * P;
    out->P = P;
    out->P.noalias() -= P * LP;
  }

 private:
  bool covariances_;
  Vector lambda_ = Vector::Zero();
  Matrix Lambda_ = Matrix::Zero();
};

}  // namespace

std::vector<SmoothedAttitude> SmoothAttitude(const AttitudeRun& run,
                                             bool covariances) {
  std::vector<SmoothedAttitude> smoothed(run.nodes.size());
  Adjoint adjoint(covariances);
  for (std::size_t k = run.nodes.size(); k-- > 0;) {
    const AttitudeNode& node = run.nodes[k];
    adjoint.Smooth(node.x.P, &smoothed[k]);
    const std::size_t begin = k > 0 ? run.nodes[k - 1].updates_end : 0;
    for (std::size_t i = node.updates_end; i-- > begin;) {
      adjoint.Take(run.updates[i]);
    }
    adjoint.Take(node.transition);
  }
  return smoothed;
}

AttitudeState StateOf(const AttitudeRun& run,
                      const std::vector<SmoothedAttitude>& smoothed,
                      std::size_t node) {
  AttitudeState x = run.nodes[node].x;
  const Vector& d = smoothed[node].d;
  x.q_nb = Exp(d.head<3>()) * x.q_nb;
  x.b_g += d.segment<3>(3);
  x.s_g += d.tail<3>();
  x.P = smoothed[node].P;
  return x;
}

std::vector<Eigen::Quaterniond> AttitudesAtSamples(
    const AttitudeRun& run, const std::vector<SmoothedAttitude>& smoothed,
    const ImuStream& imu) {
  std::vector<Eigen::Quaterniond> q_nb;
  q_nb.reserve(run.samples.size());
  std::size_t node = run.nodes.size();
  double t = 0.0;
  double slope = 0.0;  // of the part of the interval
  Eigen::Vector3d begin, change;
  for (std::size_t k = 0; k < run.samples.size(); ++k) {
    const AttitudeSample& sample = run.samples[k];
    if (sample.node != node) {
      node = sample.node;
      t = run.nodes[node].x.t;
      begin = smoothed[node].d.head<3>();
      change.setZero();
      if (node + 1 < run.nodes.size()) {
        slope = 1.0 / (run.nodes[node + 1].x.t - t);
        change =
            (run.nodes[node + 1].dx + smoothed[node + 1].d).head<3>() - begin;
      }
    }
    const double part = slope * (imu.samples[k].t - t);
    q_nb.push_back((Exp(begin + part * change) * sample.q_nb).normalized());
  }
  return q_nb;
}

}  // namespace hindsight
