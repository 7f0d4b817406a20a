#ifndef HINDSIGHT_SIMULATION_SCENARIO_H_
#define HINDSIGHT_SIMULATION_SCENARIO_H_

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "simulation/bad_start.h"
#include "simulation/hand_motion.h"
#include "simulation/imu_simulator.h"
#include "simulation/sampled_trajectory.h"
#include "simulation/sensor_errors.h"
#include "simulation/way_points.h"

namespace hindsight {

/// Standard deviations from which the errors of the initial values are drawn.
struct StartErrors {
  Eigen::Vector3d position = Eigen::Vector3d::Ones();  ///< NED [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Ones();  ///< NED [m/s]
  Eigen::Vector3d attitude = Eigen::Vector3d::Ones();  ///< roll, pitch, heading
  /// Gives the initial position alone: velocity and attitude are for alignment.
  bool position_alone = false;
  std::optional<BadStart> bad_attitude;  ///< given in place of the drawn one
};

/// A simulation lasts at most 31 days [s].
inline constexpr double kLongestScenario = 31.0 * 86400.0;

/// Everything that decides a simulated recording but the seed.
struct Scenario {
  std::string name;
  std::string description;

  Geodetic start;
  double start_speed = 0.0;    ///< [m/s]
  double start_heading = 0.0;  ///< [rad]
  std::vector<Segment> segments;
  /// If there are any, the motion instead of segments.
  WayPoints way_points;
  /// If it lasts, the motion instead of these.
  HandMotion hand;
  /// If not empty, the motion instead of all these.
  std::vector<ProfilePoint> profile;
  /// Longest duration [s]; the motion may end before.
  double duration = std::numeric_limits<double>::infinity();

  ImuStream::Kind imu_kind = ImuStream::Kind::kIncrements;
  double imu_rate_hz = 200.0;
  ImuErrorModel imu;
  std::vector<AidingModel> aiding;
  /// Of the truth in the data set, rounded to a whole number of IMU samples.
  double truth_rate_hz = 10.0;

  /// Absent: the data set has no initial values and alignment must find them.
  std::optional<StartErrors> start_errors;
  StationaryOptions stationary;
  std::vector<Withholding> withholdings;
  std::vector<Injection> injections;
  double max_node_spacing = 1.0;  ///< [s]
};

/// The true motion. Throws InputError for one that cannot be driven, or if a
/// rate of the scenario is not positive.
std::unique_ptr<Trajectory> MakeTrajectory(const Scenario& scenario);

/// One seed of a scenario, sample by sample: of a day, nothing but truth and
/// aiding is held. Throws InputError for a scenario of more than
/// kLongestScenario, 200 million IMU samples, or 10 million rows of truth or of
/// one sensor.
class Simulation {
 public:
  Simulation(const Scenario& scenario, std::uint64_t seed);

  std::size_t sample_count() const { return imu_.size(); }
  ImuStream::Kind imu_kind() const { return scenario_.imu_kind; }
  /// The next measured sample, or false after the last.
  bool Next(ImuSample* sample);
  /// The data set without IMU samples: truth up to the last sample taken,
  /// aiding, initial values.
  Dataset Finish();

 private:
  Scenario scenario_;
  std::uint64_t seed_;
  std::unique_ptr<Trajectory> trajectory_;
  double t_end_;
  ImuSimulator imu_;
  ImuErrors errors_;
  std::size_t index_ = 0;
  std::size_t truth_every_;
  TruthSeries truth_;
};

/// One seed of a scenario as a data set in memory. Truth carries the biases.
Dataset Simulate(const Scenario& scenario, std::uint64_t seed);

/// What the perfect sensors of a scenario measure, and the attitudes that
/// PerfectMeasurements gives with it.
struct PerfectAiding {
  std::vector<std::vector<Measurement>> measurements;
  std::vector<std::vector<Eigen::Quaterniond>> q_nb;
};

/// Many seeds of one scenario: the motion and the perfect sensors are computed
/// once, Realize(seed) adds errors and equals Simulate(scenario, seed).
class PerfectRecording {
 public:
  explicit PerfectRecording(const Scenario& scenario);
  Dataset Realize(std::uint64_t seed) const;
  /// A realisation with perfect readings of IMU and sensors in place of its own;
  /// a sensor of which rows were lost keeps its own.
  Dataset WithoutErrors(Dataset dataset) const;

 private:
  Scenario scenario_;
  std::size_t truth_every_;
  PagedVector<ImuSample> samples_;
  std::vector<Motion> truth_;
  PerfectAiding aiding_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_SCENARIO_H_
