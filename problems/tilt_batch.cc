#include "problems/tilt_batch.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "factors/attitude_factors.h"
#include "geometry/so3.h"
#include "imu/preintegration.h"
#include "linear/arrow_system.h"
#include "problems/attitude_samples.h"

namespace hindsight {
namespace {

constexpr int kTiltNodeDim = 9;

/// Of a component of the force at a node, whose error goes on for several.
double GravitySigma(const AhrsSettings& ahrs) {
  return ahrs.accel_sigma *
         std::sqrt(std::max(1.0, ahrs.correlation_time / kRoomNodeSpacing));
}

class TiltBatch {
 public:
  explicit TiltBatch(const RoomProblem& problem)
      : problem_(problem), times_(RoomNodeTimes(problem)) {
    ceres::Problem::Options options;
    options.disable_all_safety_checks = true;
    ceres_ = std::make_unique<ceres::Problem>(options);
    FillValues();
    AddPriors();
    AddGyros();
    AddGravity();
    AddField();
  }

  Solution Run(const std::function<void(double)>& progress);

 private:
  struct Node {
    Eigen::Quaterniond q;
    Eigen::Vector3d b;
    Eigen::Vector3d d = Eigen::Vector3d::Zero();
  };

  template <typename Residual, int kRows, int... kBlocks>
  static ceres::CostFunction* Cost(const Residual& residual) {
    return new ceres::AutoDiffCostFunction<Residual, kRows, kBlocks...>(
        new Residual(residual));
  }

  void FillValues();
  void AddPriors();
  void AddGyros();
  void AddGravity();
  void AddField();
  std::vector<double*> FreeConstants();
  CovarianceSeries Marginals();

  const RoomProblem& problem_;
  std::vector<double> times_;
  std::vector<std::size_t> samples_;      ///< last not later than each node
  std::vector<Eigen::Quaterniond> q_nb_;  ///< of the smoothed samples
  std::vector<Node> nodes_;
  Eigen::Vector3d scale_ = Eigen::Vector3d::Zero();
  Eigen::Vector2d field_;
  double declination_ = 0.0;
  bool declination_free_ = false;
  std::unique_ptr<ceres::Problem> ceres_;
};

void TiltBatch::FillValues() {
  const Eigen::Quaterniond q_ne(
      Eigen::Matrix3d(NedAxes(problem_.place.p_e).transpose()));
  for (const State& x : problem_.smoothed.states) {
    q_nb_.push_back((q_ne * x.q_eb).normalized());
  }
  std::size_t k = 0;
  for (const double t : times_) {
    while (k + 1 < q_nb_.size() && problem_.imu.samples[k + 1].t <= t) ++k;
    samples_.push_back(k);
    const Eigen::Vector3d& b = problem_.smoothed.states[k].b_g;
    const double age = t - problem_.imu.samples[k].t;
    nodes_.push_back(
        {q_nb_[k] * Exp(age * (problem_.imu.samples[k].gyro - b)), b});
  }
  field_ << problem_.survey.field_n.head<2>().norm(),
      problem_.survey.field_n.z();
  for (const AidingStream& stream : problem_.dataset.streams) {
    if (stream.sensor.type != SensorType::kMagnetometer) continue;
    declination_ = stream.sensor.magnetic.declination;
    declination_free_ = stream.sensor.magnetic.declination_sigma.has_value();
    break;
  }
  for (Node& node : nodes_) {
    ceres_->AddParameterBlock(node.q.coeffs().data(), 4,
                              new ceres::EigenQuaternionManifold);
    ceres_->AddParameterBlock(node.b.data(), 3);
    ceres_->AddParameterBlock(node.d.data(), 3);
  }
}

void TiltBatch::AddPriors() {
  constexpr double kBiasSigma = 0.5 * kDegree;
  constexpr double kDefaultScale = 0.005;
  const Eigen::Vector3d sigma(3.0 * kDegree, 3.0 * kDegree, 10.0 * kDegree);
  Node& first = nodes_.front();
  ceres_->AddResidualBlock(Cost<AttitudePriorResidual, 3, 4>({first.q, sigma}),
                           nullptr, first.q.coeffs().data());
  const auto normal = [&](double* block, const Eigen::VectorXd& mean,
                          const Eigen::VectorXd& sigmas) {
    const Eigen::MatrixXd A = sigmas.cwiseInverse().asDiagonal();
    ceres_->AddResidualBlock(new ceres::NormalPrior(A, mean), nullptr, block);
  };
  normal(first.b.data(), first.b,
         problem_.dataset.initial.gyro_bias_sigma.value_or(
             Eigen::Vector3d::Constant(kBiasSigma)));
  normal(scale_.data(), Eigen::Vector3d::Zero(),
         problem_.dataset.gyro_scale_sigma.value_or(
             Eigen::Vector3d::Constant(kDefaultScale)));
  normal(first.d.data(), Eigen::Vector3d::Zero(),
         Eigen::Vector3d::Constant(kDisturbanceSigma));
}

void TiltBatch::AddGyros() {
  constexpr double kStillBias = 1e-9;  // [rad/s]
  ImuIntegrator integrator(problem_.imu, true);
  for (std::size_t k = 0; k + 1 < nodes_.size(); ++k) {
    ImuCalibration calibration;
    calibration.b_g = nodes_[k].b;
    const ImuSummary summary =
        integrator.Summarize(times_[k], times_[k + 1], calibration);
    RotationResidual residual;
    residual.dR = summary.dR;
    residual.R_bg = summary.R_bg;
    residual.R_sg = summary.R_sg;
    residual.b_0 = nodes_[k].b;
    residual.earth = Exp(summary.dt() * problem_.place.w_ie_n);
    const Eigen::Matrix3d P = summary.noise.block<3, 3>(6, 6);
    residual.whitening = P.llt().matrixL().solve(Eigen::Matrix3d::Identity());
    residual.bias_sigma =
        std::max(std::sqrt(summary.gyro_bias_variance), kStillBias);
    Node& i = nodes_[k];
    Node& j = nodes_[k + 1];
    ceres_->AddResidualBlock(Cost<RotationResidual, 6, 4, 3, 4, 3, 3>(residual),
                             nullptr, i.q.coeffs().data(), i.b.data(),
                             j.q.coeffs().data(), j.b.data(), scale_.data());
    const double phi = std::exp(-summary.dt() / kDisturbanceTime);
    ceres_->AddResidualBlock(
        Cost<MarkovResidual, 3, 3, 3>(
            {phi, kDisturbanceSigma * std::sqrt(1.0 - phi * phi)}),
        nullptr, i.d.data(), j.d.data());
  }
}

void TiltBatch::AddGravity() {
  const double sigma = GravitySigma(problem_.dataset.ahrs);
  const std::vector<Eigen::Vector3d> f_n = AveragedForce(problem_.imu, q_nb_);
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Eigen::Vector3d f_b = nodes_[k].q.conjugate() * f_n[samples_[k]];
    ceres_->AddResidualBlock(Cost<GravityResidual, 2, 4>({f_b, sigma}), nullptr,
                             nodes_[k].q.coeffs().data());
  }
}

void TiltBatch::AddField() {
  std::size_t node = 0;
  for (std::size_t k = 0; k < problem_.readings.size(); ++k) {
    const SurveyedField& reading = problem_.readings[k];
    while (node + 1 < times_.size() && times_[node] < reading.t) ++node;
    const FieldResidual residual{reading.field_b - problem_.survey.hard_iron_b,
                                 kFieldScale};
    ceres_->AddResidualBlock(
        Cost<FieldResidual, 3, 4, 3, 2, 1>(residual),
        new ceres::ScaledLoss(nullptr,
                              reading.weight * problem_.survey.trust[k],
                              ceres::TAKE_OWNERSHIP),
        nodes_[node].q.coeffs().data(), nodes_[node].d.data(), field_.data(),
        &declination_);
  }
  if (problem_.readings.empty()) return;
  if (!declination_free_) ceres_->SetParameterBlockConstant(&declination_);
}

std::vector<double*> TiltBatch::FreeConstants() {
  std::vector<double*> blocks = {scale_.data()};
  if (!problem_.readings.empty()) blocks.push_back(field_.data());
  if (declination_free_) blocks.push_back(&declination_);
  return blocks;
}

/// Of (psi, b_g) at every node, from the normal equations at the solution.
CovarianceSeries TiltBatch::Marginals() {
  ceres::Problem::EvaluateOptions options;
  int border = 0;
  for (Node& node : nodes_) {
    for (double* block :
         {node.q.coeffs().data(), node.b.data(), node.d.data()}) {
      options.parameter_blocks.push_back(block);
    }
  }
  for (double* block : FreeConstants()) {
    options.parameter_blocks.push_back(block);
    border += ceres_->ParameterBlockSize(block);
  }
  ceres::CRSMatrix J;
  ceres_->Evaluate(options, nullptr, nullptr, nullptr, &J);
  const int count = static_cast<int>(nodes_.size());
  ArrowSystem system(count, kTiltNodeDim, border);
  const int chain = count * kTiltNodeDim;
  // Ceres's quaternion tangent is half the rotation vector.
  const auto value = [&](int i) {
    const int column = J.cols[static_cast<std::size_t>(i)];
    const bool attitude = column < chain && column % kTiltNodeDim < 3;
    return (attitude ? 0.5 : 1.0) * J.values[static_cast<std::size_t>(i)];
  };
  for (int row = 0; row < J.num_rows; ++row) {
    const int end = J.rows[static_cast<std::size_t>(row) + 1];
    for (int a = J.rows[static_cast<std::size_t>(row)]; a < end; ++a) {
      for (int b = J.rows[static_cast<std::size_t>(row)]; b < end; ++b) {
        const int i = J.cols[static_cast<std::size_t>(a)];
        const int j = J.cols[static_cast<std::size_t>(b)];
        if (j > i) continue;
        const double h = value(a) * value(b);
        const int in = i % kTiltNodeDim, jn = j % kTiltNodeDim;
        const int ik = i / kTiltNodeDim, jk = j / kTiltNodeDim;
        if (j >= chain) {
          system.border()(i - chain, j - chain) += h;
        } else if (i >= chain) {
          system.border_coupling(jk)(i - chain, jn) += h;
        } else if (ik == jk) {
          system.node(ik)(in, jn) += h;
        } else {
          system.coupling(jk)(in, jn) += h;
        }
      }
    }
  }
  system.Factor();
  CovarianceSeries series(6, nodes_.size());
  system.VisitMarginals([&](const ArrowSystem::NodeMarginal& marginal) {
    const Eigen::MatrixXd P = marginal.covariance.topLeftCorner(6, 6);
    series.Set(static_cast<std::size_t>(marginal.node), P);
  });
  return series;
}

Solution TiltBatch::Run(const std::function<void(double)>& progress) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 50;
  options.initial_trust_region_radius = 1e8;
  options.function_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  if (progress) progress(0.1);
  ceres::Solve(options, ceres_.get(), &summary);
  if (progress) progress(0.9);
  Solution nodes;
  nodes.layout = problem_.smoothed.layout;
  nodes.converged = summary.termination_type == ceres::CONVERGENCE;
  nodes.iterations = summary.num_successful_steps;
  const Eigen::Quaterniond q_en(NedAxes(problem_.place.p_e));
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    State x;
    x.t = times_[k];
    x.p_e = problem_.place.p_e;
    x.q_eb = (q_en * nodes_[k].q).normalized();
    x.b_g = nodes_[k].b;
    nodes.states.push_back(x);
  }
  nodes.covariances = Marginals();
  return nodes;
}

}  // namespace

Solution SolveTiltBatch(const RoomProblem& problem,
                        const std::function<void(double)>& progress) {
  TiltBatch batch(problem);
  Solution out =
      NodesAtSamples(batch.Run(progress), problem.imu, problem.smoothed.layout);
  out.accel_sigma.assign(out.states.size(), GravitySigma(problem.dataset.ahrs));
  return out;
}

}  // namespace hindsight
