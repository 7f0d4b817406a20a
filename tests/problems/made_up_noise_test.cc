#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>

#include "alignment/backward_extension.h"
#include "alignment/start.h"
#include "base/chi_square.h"
#include "base/error.h"
#include "base/random.h"
#include "dataset/speed_evidence.h"
#include "evaluation/trajectory_error.h"
#include "imu/imu_link.h"
#include "imu/preintegration.h"
#include "io/config/config.h"
#include "io/config/config_help.h"
#include "io/config/scenario_config.h"
#include "io/write/dataset_writer.h"
#include "measurements/noise_kind.h"
#include "problems/noise_estimation.h"
#include "problems/reconstruction.h"
#include "simulation/scenario.h"
#include "support/temporary_folder.h"
#include "support/truth_at.h"

namespace hindsight {
namespace {

/// Multipath, which nothing but this file knows: it changes as satellites move
/// and as the vehicle travels, phi = exp(-dt/tau - distance/reach).
double Exponent(const Evolution& e, double dt, double distance) {
  return dt / e.tau + distance / e.length;
}

constexpr Process kMultipathProcess = {
    [](const Evolution& e, double dt, double distance) {
      return std::exp(-Exponent(e, dt, distance));
    },
    [](const Evolution& e, double dt, double distance) {
      return -e.density * e.density *
             std::expm1(-2.0 * Exponent(e, dt, distance));
    },
    [](const Evolution& e) { return e.density * e.density; }};

double* Reach(Sensor& sensor) { return &sensor.noise.own; }

const NoiseKind& Multipath() {
  static const NoiseKind kKind = {
      .name = "multipath",
      .help = "made up for a test",
      .keys = {CorrelatedSigmaKey(),
               {.name = "tau",
                .help = "correlation time",
                .at = [](Sensor& s) { return &s.noise.tau; },
                .quantity = Quantity::kTime},
               {.name = "reach",
                .help = "correlation length",
                .at = Reach,
                .quantity = Quantity::kLength,
                .fallback = [](const Sensor&) { return 50.0; },
                .fallback_text = "50 m"},
               WhiteSigmaKey()},
      .complete = [](Sensor* sensor) -> std::optional<KeyObjection> {
        if (sensor->noise.tau >= 1.0) return std::nullopt;
        return KeyObjection{"tau", "satellites do not move that fast"};
      },
      .evolution =
          [](const NoiseModel& noise) {
            return Evolution{&kMultipathProcess, noise.sigma, noise.tau,
                             noise.own};
          },
      .searched = {{"multipath", [](Sensor& s) { return &s.noise.sigma; }},
                   {"multipath_reach", Reach}}};
  return kKind;
}

constexpr double kSigma = 2.0;
constexpr double kTau = 100.0;
constexpr double kReach = 30.0;

/// Errors of the fixes as the model has them, by the true way between them.
void Disturb(std::uint64_t seed, Dataset* dataset) {
  Random random(seed);
  const Evolution e{&kMultipathProcess, kSigma, kTau, kReach};
  Eigen::Vector3d error = kSigma * random.NormalVector3();
  std::optional<TruthPoint> last;
  for (Measurement& z : dataset->streams.front().measurements.Edited()) {
    const TruthPoint truth = testing::TruthAt(*dataset, z.t);
    if (last) {
      const double way = (*truth.p_e - *last->p_e).norm();
      error = e.Phi(truth.t - last->t, way) * error +
              std::sqrt(e.Q(truth.t - last->t, way)) * random.NormalVector3();
    }
    last = truth;
    std::get<PositionFix>(z.model).p_e += error;
  }
}

class MadeUpNoise : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { AddNoiseKind(Multipath()); }

  /// A drive of a minute at 10 m/s with turns; fixes at 2 Hz, 5 cm white.
  Dataset Drive(std::uint64_t seed, const std::string& noise) const {
    folder_.Write(
        "scenario.yaml",
        "start: {position: [48 deg, 11 deg, 500 m], speed: 10 m/s}\n"
        "segments:\n"
        "  - {type: straight, duration: 20 s}\n"
        "  - {type: turn, angle: 90 deg, rate: 10 deg/s}\n"
        "  - {type: straight, duration: 15 s}\n"
        "  - {type: turn, angle: -90 deg, rate: 10 deg/s}\n"
        "  - {type: straight, duration: 10 s}\n"
        "imu: {rate: 50 Hz, noise: {gyro: 0.1 deg/sqrt(h), accel: "
        "100 ug/sqrt(Hz)}}\n"
        "start_errors: {position: 1 m, velocity: 0.1 m/s, attitude: 0.5 deg}\n"
        "aiding:\n  gnss: {type: position, rate: 2 Hz, sigma: 5 cm}\n");
    WriteDataset(Simulate(LoadScenario(folder_.Path("scenario.yaml")), seed),
                 folder_.Path("drive"));
    std::ifstream file(folder_.Path("drive/config.yaml"));
    std::string config{std::istreambuf_iterator<char>(file), {}};
    const std::string sigma = "    sigma: ";
    const std::size_t at = config.find(sigma);
    if (at != config.npos) {
      config.erase(at, config.find('\n', at) + 1 - at);
    }
    const std::string line = "    file: gnss.csv\n";
    config.insert(config.find(line) + line.size(),
                  "    noise: " + noise + "\n");
    Dataset dataset = LoadDataset(folder_.Write("drive/noise.yaml", config));
    Disturb(seed + 1000, &dataset);
    return dataset;
  }

  Dataset Drive(std::uint64_t seed) const {
    return Drive(seed,
                 "{model: multipath, sigma: 2 m, tau: 100 s, reach: 30 m, "
                 "white: 5 cm}");
  }

  std::string Error(const std::string& noise) const {
    try {
      Drive(1, noise);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  TemporaryFolder folder_;
};

TEST_F(MadeUpNoise, IsReadAndRefusedByItsOwnKeys) {
  const Dataset dataset = Drive(1, "{model: multipath, sigma: 2 m, tau: 9 s}");
  const NoiseModel& noise = dataset.streams.front().sensor.noise;
  EXPECT_EQ(noise.kind, &Multipath());
  EXPECT_EQ(noise.sigma, 2.0);
  EXPECT_EQ(noise.tau, 9.0);
  EXPECT_EQ(noise.own, 50.0);
  EXPECT_EQ(noise.white_sigma, 0.2);
  EXPECT_NE(Error("{model: multipath, tau: 9 s}").find("noise.sigma"),
            std::string::npos);
  EXPECT_NE(Error("{model: multipath, sigma: 2 m, tau: 0.5 s}")
                .find("noise.tau: satellites do not move that fast"),
            std::string::npos);
  EXPECT_NE(Error("{model: gauss_markov, sigma: 2 m, tau: 1 s, reach: 3 m}")
                .find("reach"),
            std::string::npos);
  EXPECT_NE(ConfigHelp("noise").find("reach  (50 m; with model: multipath)"),
            std::string::npos)
      << ConfigHelp("noise");
  EXPECT_THROW(AddNoiseKind(Multipath()), std::invalid_argument);
}

/// Position NEES of single instants over seeds; the errors are known to the
/// model exactly but for the way between fixes, which it estimates.
TEST_F(MadeUpNoise, LeavesFilterAndSmootherAndBatchConsistent) {
  constexpr int kRuns = 20;
  std::map<std::string, double> nees;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const Dataset dataset = Drive(static_cast<std::uint64_t>(seed));
    Reconstruction reconstruction(dataset, {});
    for (const char* method : {"ekf", "rts", "batch"}) {
      const Solution solution = reconstruction.Run(method);
      const auto errors = ComputeTrajectoryErrors(TableFromSolution(solution),
                                                  dataset.truth, {});
      nees[method] += *errors[errors.size() / 2].position_nees / kRuns;
    }
  }
  for (const auto& [method, mean] : nees) {
    EXPECT_TRUE(AneesBounds(kRuns, 3, 0.999).Contains(mean))
        << method << " " << mean;
  }
}

TEST_F(MadeUpNoise, IsFoundByTheSearchForNoise) {
  constexpr double kFourSigma = 4.0;
  Dataset dataset = Drive(3);
  dataset.streams.front().sensor.noise.sigma = 6.0;
  const NoiseEstimate estimate = EstimateNoise(dataset);
  const auto factor = std::find_if(
      estimate.factors.begin(), estimate.factors.end(),
      [](const NoiseFactor& f) { return f.name == "gnss.multipath"; });
  ASSERT_NE(factor, estimate.factors.end());
  EXPECT_LT(std::abs(std::log(factor->factor * 6.0 / kSigma)),
            kFourSigma * factor->log_sigma)
      << factor->factor;
  EXPECT_LT(factor->log_sigma, 0.5);
}

/// As much as two errors so far apart differ.
TEST_F(MadeUpNoise, SpoilsASpeedTakenFromPositions) {
  const Dataset dataset = Drive(4);
  const std::vector<SpeedEvidence> speeds =
      SpeedRecord(dataset).Over({5.0, 7.0});
  ASSERT_EQ(speeds.size(), 1U);
  const double T = speeds[0].end - speeds[0].begin;
  const double way = T * speeds[0].v.norm();
  const double change =
      std::sqrt(2.0 * kSigma * kSigma * -std::expm1(-T / kTau - way / kReach));
  EXPECT_GT(speeds[0].sigma.x(), change / T);
  EXPECT_LT(speeds[0].sigma.x(), 1.1 * change / T);
}

/// A stationary process looks the same backwards: what was v is phi v.
TEST_F(MadeUpNoise, IsCarriedBackBeforeTheStart) {
  const Dataset dataset = Drive(5);
  const Start start = FindStart(dataset, 0.0, dataset.imu.t_end());
  const Block* block = start.layout.Find(BlockKind::kColouredNoise, 0);
  ASSERT_NE(block, nullptr);
  State x = start.prior.x;
  x.parameters.segment<3>(block->parameter_offset).setConstant(1.0);
  ImuIntegrator integrator(dataset.imu, false);
  const ImuSummary summary =
      integrator.Summarize(x.t, x.t + 1.0, CalibrationOf(start.layout, x));
  State later = Predict(start.layout, x, summary);
  later.parameters.segment<3>(block->parameter_offset).setConstant(1.0);
  const State before = PredictBackward(start.layout, later, summary);
  const double way = (before.p_e - later.p_e).norm();
  EXPECT_NEAR(before.parameters(block->parameter_offset),
              std::exp(-1.0 / kTau - way / kReach), 1e-2);
}

}  // namespace
}  // namespace hindsight
