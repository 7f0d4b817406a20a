#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/chi_square.h"
#include "base/random.h"
#include "base/units.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "problems/reconstruction.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

/// A drive whose sensors keep no common clock: IMU stamps jitter by 40 % of
/// their interval, fixes come at odd rates, each sensor at times of its own.
class RaggedDrive {
 public:
  RaggedDrive() : trajectory_(MakeTrajectory(FindScenario("short_drive"))) {}

  Dataset Make(std::uint64_t seed) {
    Random random(seed);
    Dataset dataset;
    dataset.name = "ragged";
    dataset.stationary.enabled = false;
    MakeImu(&random, &dataset);
    const Eigen::Vector3d l_b(0.5, -0.3, -1.2);
    // The stream that begins last stands first.
    AidingStream& height = AddStream("barometer", HeightKind(), &dataset);
    for (const double t : Stamps(20.3, 165.0, 1.0 / 13.0, &random)) {
      const Motion m = trajectory_->At(t);
      const double h = GeodeticFromEcef(m.p_e).height;
      height.measurements.push_back(
          {t, 0, false, HeightFix{h + 1.0 * random.Normal(), 1.0}});
    }
    AidingStream& gnss = AddStream("gnss", PositionKind(), &dataset);
    gnss.sensor.lever_arm_b = l_b;
    for (const double t : Stamps(4.1, 150.0, 1.0 / 3.0, &random)) {
      const Motion m = trajectory_->At(t);
      const Eigen::Matrix3d C_en = NedAxes(m.p_e);
      PositionFix fix;
      fix.R_n = Eigen::Vector3d(0.25, 0.25, 1.0).asDiagonal();
      fix.p_e = m.p_e + m.q_eb * l_b +
                C_en * Eigen::Vector3d(0.5 * random.Normal(),
                                       0.5 * random.Normal(), random.Normal());
      gnss.measurements.push_back({t, 1, false, fix});
    }
    AidingStream& doppler = AddStream("doppler", VelocityKind(), &dataset);
    for (const double t : Stamps(0.7, 171.9, 1.0 / 0.7, &random)) {
      const Motion m = trajectory_->At(t);
      VelocityFix fix;
      fix.R_n = 0.01 * Eigen::Matrix3d::Identity();
      fix.v_n =
          NedAxes(m.p_e).transpose() * m.v_e + 0.1 * random.NormalVector3();
      doppler.measurements.push_back({t, 2, false, fix});
    }
    return dataset;
  }

  /// Whole error state at a node, with its covariance: e' P^-1 e.
  double Nees(const Solution& solution, std::size_t k) {
    State truth = solution.states[k];
    const Motion m = trajectory_->At(truth.t);
    truth.p_e = m.p_e;
    truth.v_e = m.v_e;
    truth.q_eb = m.q_eb;
    truth.b_g = b_g_;
    truth.b_a = b_a_;
    const ErrorVector e = Local(solution.layout, solution.states[k], truth);
    return e.dot(solution.covariances.Get(k).llt().solve(e));
  }

 private:
  static constexpr double kDt = 0.01;

  static std::vector<double> Stamps(double from, double to, double step,
                                    Random* random) {
    std::vector<double> stamps;
    for (double t = from; t < to; t += step) {
      stamps.push_back(t + 0.3 * step * random->Uniform());
    }
    return stamps;
  }

  static AidingStream& AddStream(const std::string& name,
                                 const SensorKind& kind, Dataset* dataset) {
    dataset->streams.reserve(3);
    AidingStream& stream = dataset->streams.emplace_back();
    stream.sensor.name = name;
    stream.sensor.kind = &kind;
    return stream;
  }

  void MakeImu(Random* random, Dataset* dataset) {
    constexpr double kGyroBias = 3.0 * kDegree / kHour;
    constexpr double kAccelBias = 1e-3 * kStandardGravity;
    b_g_ = kGyroBias * random->NormalVector3();
    b_a_ = kAccelBias * random->NormalVector3();
    ImuStream& imu = dataset->imu;
    imu.kind = ImuStream::Kind::kRates;
    imu.noise.gyro_noise_density = 0.1 * kDegreePerSqrtHour;
    imu.noise.accel_noise_density = 0.05 / 60.0;
    imu.nominal_dt = kDt;
    dataset->initial.gyro_bias_sigma = Eigen::Vector3d::Constant(kGyroBias);
    dataset->initial.accel_bias_sigma = Eigen::Vector3d::Constant(kAccelBias);
    const double root = std::sqrt(1.0 / kDt);
    for (int k = 0; (k + 1) * kDt < trajectory_->t_end(); ++k) {
      const double t = kDt * (k + 0.4 * random->Uniform());
      const Kinematics truth = TrueKinematics(trajectory_->At(t));
      imu.samples.push_back(
          {t,
           truth.w_ib_b + b_g_ +
               imu.noise.gyro_noise_density * root * random->NormalVector3(),
           truth.f_b + b_a_ +
               imu.noise.accel_noise_density * root * random->NormalVector3()});
    }
  }

  std::unique_ptr<Trajectory> trajectory_;
  Eigen::Vector3d b_g_, b_a_;
};

/// Averages of e' P^-1 e over the runs at some instants.
template <typename Change>
std::vector<double> AverageNees(const std::vector<double>& instants, int runs,
                                const Change& change) {
  RaggedDrive drive;
  std::vector<double> nees(instants.size(), 0.0);
  for (int run = 1; run <= runs; ++run) {
    Dataset dataset = drive.Make(static_cast<std::uint64_t>(run));
    change(&dataset);
    ReconstructionOptions options;
    options.node_times = instants;
    const Solution solution = Solve(dataset, options);
    EXPECT_TRUE(solution.converged);
    EXPECT_NEAR(solution.states.front().t, dataset.imu.t_begin(), 1e-9);
    EXPECT_NEAR(solution.states.back().t, dataset.imu.t_end(), 1e-9);
    for (std::size_t i = 0; i < instants.size(); ++i) {
      const auto node = std::min_element(
          solution.states.begin(), solution.states.end(),
          [&](const State& a, const State& b) {
            return std::abs(a.t - instants[i]) < std::abs(b.t - instants[i]);
          });
      nees[i] +=
          drive.Nees(solution,
                     static_cast<std::size_t>(node - solution.states.begin())) /
          runs;
    }
  }
  return nees;
}

constexpr int kRuns = testing::kSanitized ? 4 : 25;

TEST(Streams, JitterOddRatesAndDifferentSpansStayConsistent) {
  // Before the first fix, while all sensors speak, after the last fix.
  const std::vector<double> instants = {0.5, 40.0, 90.0, 140.0, 175.0};
  const Interval bounds = AneesBounds(kRuns, 15, 0.999);
  const std::vector<double> nees =
      AverageNees(instants, kRuns, [](Dataset*) {});
  for (std::size_t i = 0; i < instants.size(); ++i) {
    EXPECT_TRUE(bounds.Contains(nees[i]))
        << "t = " << instants[i] << ": " << nees[i] << " outside "
        << bounds.lower << " to " << bounds.upper;
  }
}

TEST(Streams, BridgedDropOutsAreNoFalseConfidence) {
  // In the start-up, in a turn and while braking, half a second each.
  const std::vector<double> gaps = {24.0, 40.0, 84.0};
  const std::vector<double> instants = {25.0, 41.0, 85.0, 140.0};
  const Interval bounds = AneesBounds(kRuns, 15, 0.999);
  const auto cut = [&](Dataset* dataset) {
    dataset->imu.max_gap = 1.0;
    const auto is_lost = [&](const ImuSample& sample) {
      return std::any_of(gaps.begin(), gaps.end(), [&](double t) {
        return sample.t > t && sample.t < t + 0.5;
      });
    };
    EraseIf(is_lost, &dataset->imu.samples);
    EXPECT_EQ(DropOuts(dataset->imu).size(), gaps.size());
  };
  const std::vector<double> nees = AverageNees(instants, kRuns, cut);
  for (std::size_t i = 0; i < instants.size(); ++i) {
    EXPECT_LT(nees[i], bounds.upper) << "t = " << instants[i];
  }
  // Without the noise of the bridge it would be.
  constexpr int kFew = 5;
  const std::vector<double> feigned =
      AverageNees({instants[1]}, kFew, [&](Dataset* dataset) {
        cut(dataset);
        dataset->imu.nominal_dt = 0.0;
      });
  EXPECT_GT(feigned[0], AneesBounds(kFew, 15, 0.999).upper);
}

}  // namespace
}  // namespace hindsight
