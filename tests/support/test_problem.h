#ifndef HINDSIGHT_TESTS_SUPPORT_TEST_PROBLEM_H_
#define HINDSIGHT_TESTS_SUPPORT_TEST_PROBLEM_H_

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>
#include <vector>

#include "measurements/sensor_kind.h"
#include "support/test_motion.h"
#include "timeline/problem.h"

namespace hindsight::testing {

struct TestProblemOptions {
  ImuNoise noise;
  ErrorLayout layout;
  State start = TypicalState();  ///< true state at t = 0, biases included
  double duration = 20.0;        ///< [s]
  double imu_rate = 50.0;        ///< [Hz]
  double spacing = 1.0;          ///< of nodes and fixes [s]
  double position_sigma = 0.05;  ///< an axis [m]
  double velocity_sigma = 0.02;  ///< an axis [m/s]; 0: no velocity fixes
  /// Draws IMU noise, bias walks, measurement errors and the error of the prior
  /// mean; otherwise everything is exact.
  bool errors = false;
};

/// A short lively drive with position (sensor 0) and velocity fixes (sensor 1)
/// of an antenna 1.3 m from the IMU, every node a fix.
struct TestProblem {
  ImuStream imu;
  ErrorLayout layout;
  Prior prior;
  std::vector<State> truth;  ///< at the nodes
  std::vector<Node> nodes;
  std::vector<Measurement> measurements;
  std::vector<Sensor> sensors;

  /// What is to be solved; the IMU's record must outlive it.
  Problem Pose(GateDecisions decisions = {}) const {
    return {layout, prior, MakeTimeline(), std::move(decisions)};
  }

  /// The problem must outlive the timeline.
  Timeline MakeTimeline() const {
    const bool scale =
        layout.Has(BlockKind::kGyroScale) || layout.Has(BlockKind::kAccelScale);
    Timeline timeline(nodes, measurements, sensors, imu, scale);
    timeline.LinearizeTimeOffsets(layout, truth);
    return timeline;
  }
};

inline Eigen::Vector3d AntennaLeverArm() { return {0.5, -0.3, -1.2}; }

/// Parameters as the sensors have them: lever arms, everything else zero.
inline ParameterVector NominalParameters(const ErrorLayout& layout) {
  ParameterVector parameters = ParameterVector::Zero(layout.parameter_count());
  for (const Block& block : layout.blocks()) {
    if (block.key.kind == BlockKind::kLeverArm) {
      parameters.segment<3>(block.parameter_offset) = AntennaLeverArm();
    }
  }
  return parameters;
}

inline ErrorVector Draw(const ErrorMatrix& P, Random* random) {
  ErrorVector u(P.rows());
  for (Eigen::Index i = 0; i < u.size(); ++i) u(i) = random->Normal();
  return Eigen::LLT<ErrorMatrix>(P).matrixL() * u;
}

/// Adds biases, their walk and white noise to clean increments.
class ImuCorruption {
 public:
  ImuCorruption(const TestProblemOptions& options, Random* random)
      : noise_(options.noise),
        errors_(options.errors),
        b_g_(options.start.b_g),
        b_a_(options.start.b_a),
        random_(*random) {}

  void Apply(double dt, ImuSample* s) {
    s->gyro += dt * b_g_;
    s->accel += dt * b_a_;
    if (!errors_) return;
    const double root = std::sqrt(dt);
    s->gyro += noise_.gyro_noise_density * root * random_.NormalVector3();
    s->accel += noise_.accel_noise_density * root * random_.NormalVector3();
    b_g_ += noise_.gyro_bias_walk * root * random_.NormalVector3();
    b_a_ += noise_.accel_bias_walk * root * random_.NormalVector3();
  }

  const Eigen::Vector3d& b_g() const { return b_g_; }
  const Eigen::Vector3d& b_a() const { return b_a_; }

 private:
  const ImuNoise& noise_;
  bool errors_;
  Eigen::Vector3d b_g_;
  Eigen::Vector3d b_a_;
  Random& random_;
};

inline void AddFixes(const TestProblemOptions& options,
                     const Kinematics& true_k, const State& x, Random* random,
                     TestProblem* problem) {
  const Eigen::Matrix3d C_eb = x.q_eb.toRotationMatrix();
  const Eigen::Vector3d l = AntennaLeverArm();
  const auto error = [&](double sigma) -> Eigen::Vector3d {
    if (!options.errors) return Eigen::Vector3d::Zero();
    return sigma * random->NormalVector3();
  };
  const Eigen::Vector3d p = x.p_e + C_eb * l;
  PositionFix position;
  position.p_e = p + NedAxes(p) * error(options.position_sigma);
  position.R_n *= options.position_sigma * options.position_sigma;
  problem->measurements.push_back({x.t, 0, false, position});
  if (options.velocity_sigma <= 0.0) return;
  const Eigen::Vector3d w_eb = true_k.w_ib_b - C_eb.transpose() * EarthRate_e();
  VelocityFix velocity;
  velocity.v_n = x.C_en().transpose() * (x.v_e + C_eb * w_eb.cross(l)) +
                 error(options.velocity_sigma);
  velocity.R_n *= options.velocity_sigma * options.velocity_sigma;
  problem->measurements.push_back({x.t, 1, false, velocity});
}

inline TestProblem MakeProblem(const TestProblemOptions& options,
                               std::uint64_t seed = 1) {
  TestProblem problem;
  problem.layout = options.layout;
  for (int i = 0; i < 2; ++i) {
    Sensor sensor;
    sensor.name = i == 0 ? "gnss" : "gnss_velocity";
    sensor.kind = i == 0 ? &PositionKind() : &VelocityKind();
    sensor.lever_arm_b = AntennaLeverArm();
    problem.sensors.push_back(sensor);
  }
  Random random(seed);
  const double dt = 1.0 / options.imu_rate;
  ImuStream clean =
      LivelyImu(options.duration, options.imu_rate, options.noise);
  clean.kind = ImuStream::Kind::kIncrements;
  for (ImuSample& s : clean.samples) {
    s.gyro *= dt;
    s.accel *= dt;
  }
  problem.imu = clean;
  ImuCorruption corruption(options, &random);
  ImuIntegrator integrator(clean);
  const ErrorLayout unbiased = NavigationLayout({});
  State x = options.start;
  x.t = 0.0;
  x.b_g.setZero();
  x.b_a.setZero();
  const auto every =
      static_cast<std::size_t>(std::lround(options.spacing / dt));
  for (std::size_t k = 0; k < clean.samples.size(); ++k) {
    corruption.Apply(dt, &problem.imu.samples[k]);
    if (k % every != 0) continue;
    const double t = clean.samples[k].t;
    if (k > 0) x = Predict(unbiased, x, integrator.Summarize(x.t, t, {}));
    State truth = x;
    truth.b_g = corruption.b_g();
    truth.b_a = corruption.b_a();
    truth.parameters = NominalParameters(options.layout);
    problem.truth.push_back(truth);
    Node node;
    node.t = t;
    node.first_measurement = static_cast<int>(problem.measurements.size());
    AddFixes(options, integrator.ReadingAt(t), x, &random, &problem);
    node.measurement_count =
        static_cast<int>(problem.measurements.size()) - node.first_measurement;
    problem.nodes.push_back(node);
  }
  problem.prior.x = problem.truth.front();
  problem.prior.P = options.layout.InitialCovariance();
  if (options.errors) {
    const ErrorVector d = Draw(problem.prior.P, &random);
    problem.prior.x = Retract(options.layout, problem.prior.x, -d);
  }
  return problem;
}

/// Noise of a tactical IMU whose biases walk, or stay if `walk` is false.
inline ImuNoise TacticalNoise(bool walk) {
  ImuNoise noise;
  noise.gyro_noise_density = 3e-5;
  noise.accel_noise_density = 1e-3;
  noise.gyro_bias_walk = walk ? 1e-6 : 0.0;
  noise.accel_bias_walk = walk ? 1e-5 : 0.0;
  return noise;
}

/// Largest |.| of the components of one kind over a trajectory's error.
inline double LargestError(const ErrorLayout& layout,
                           const std::vector<State>& a,
                           const std::vector<State>& b, BlockKind kind) {
  const Block& block = *layout.Find(kind);
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const ErrorVector d = Local(layout, a[k], b[k]);
    largest = std::max(
        largest, d.segment(block.offset, block.dim).cwiseAbs().maxCoeff());
  }
  return largest;
}

/// |A - B| with rows and columns scaled to unit diagonal of B: the largest
/// difference of a covariance in units of standard deviations.
inline double ScaledDifference(const Eigen::MatrixXd& A,
                               const Eigen::MatrixXd& B) {
  const Eigen::VectorXd scale = B.diagonal().cwiseSqrt().cwiseInverse();
  return (scale.asDiagonal() * (A - B) * scale.asDiagonal())
      .cwiseAbs()
      .maxCoeff();
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_SUPPORT_TEST_PROBLEM_H_
