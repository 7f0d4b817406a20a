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
    constexpr int kGyro = AttitudeState::kGyroBias;
    Scale(kGyro, transition.phi);
    Scale(AttitudeState::kAccelBias, transition.phi_accel);
    if (transition.learns_dip) TakeDip(transition.dip_by_psi);
    lambda_.segment<6>(kGyro) += A.transpose() * lambda_.head<3>();
    if (!covariances_) return;
    // Rows, then columns, of the gyros' errors: Lambda F, then F' of that.
    Lambda_.middleCols<6>(kGyro).noalias() += Lambda_.leftCols<3>().eval() * A;
    Lambda_.middleRows<6>(kGyro).noalias() +=
        A.transpose() * Lambda_.topRows<3>().eval();
  }

  /// At a node with covariance P.
  void Smooth(const Matrix& P, SmoothedAttitude* out) const {
    out->d.noalias() = P * lambda_;
    if (!covariances_) return;
    // Matrices of this size are faster without Eigen's blocking.
    const Matrix LP = Lambda_.lazyProduct(P);
    out->P = P - P.lazyProduct(LP);
  }

 private:
  /// Back over where the dip was learned, a' psi.
  void TakeDip(const Eigen::Vector3d& a) {
    constexpr int kDip = AttitudeState::kDip;
    lambda_.head<3>() += lambda_(kDip) * a;
    lambda_(kDip) = 0.0;
    if (!covariances_) return;
    Lambda_.leftCols<3>() += (Lambda_.col(kDip) * a.transpose()).eval();
    Lambda_.topRows<3>() += (a * Lambda_.row(kDip)).eval();
    Lambda_.row(kDip).setZero();
    Lambda_.col(kDip).setZero();
  }
  void Scale(int begin, double phi) {
    if (phi == 1.0) return;
    lambda_.segment<3>(begin) *= phi;
    if (!covariances_) return;
    Lambda_.middleRows<3>(begin) *= phi;
    Lambda_.middleCols<3>(begin) *= phi;
  }

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
  x.b_g += d.segment<3>(AttitudeState::kGyroBias);
  x.s_g += d.segment<3>(AttitudeState::kGyroScale);
  x.b_a += d.segment<3>(AttitudeState::kAccelBias);
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
