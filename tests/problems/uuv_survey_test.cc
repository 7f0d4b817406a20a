#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "alignment/start.h"
#include "base/chi_square.h"
#include "base/units.h"
#include "evaluation/trajectory_error.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "problems/reconstruction.h"
#include "support/navigation_study.h"
#include "support/study.h"

namespace hindsight {
namespace {

/// The first `duration` seconds of the dive at 50 Hz, which is quick.
Scenario ShortDive(double duration, const std::string& form = "three_axis") {
  Scenario s =
      FindScenario("uuv_survey", {"aiding.fix=~", "aiding.dvl.form=" + form});
  s.duration = duration;
  s.imu_rate_hz = 50.0;
  return s;
}

/// The data set without any error but what rounding makes; noise as stated.
Dataset Perfect(const Scenario& scenario) {
  Scenario exact = scenario;
  exact.imu = ImuErrorModel{};
  Dataset dataset = Simulate(exact, 1);
  dataset.imu.noise = scenario.imu.noise;
  const auto trajectory = MakeTrajectory(exact);
  for (std::size_t k = 0; k < exact.aiding.size(); ++k) {
    dataset.streams[k].sensor = exact.aiding[k].sensor;
    dataset.streams[k].measurements = MeasurementSeries(
        PerfectMeasurements(exact.aiding[k], static_cast<int>(k),
                            trajectory.get(), exact.duration));
  }
  const TruthPoint start = dataset.truth.front();
  dataset.initial.position = GeodeticFromEcef(*start.p_e);
  dataset.initial.v_n = start.v_n;
  dataset.initial.euler = EulerFromQuaternion(*start.q_nb);
  return dataset;
}

double LargestPositionError(const Dataset& dataset, const Solution& solution) {
  double largest = 0.0;
  for (const State& x : solution.states) {
    for (const TruthPoint& point : dataset.truth) {
      if (std::abs(point.t - x.t) > 1e-6) continue;
      largest = std::max(largest, (*point.p_e - x.p_e).norm());
    }
  }
  return largest;
}

TEST(UuvSurvey, SmoothMotionIsNotTakenForRest) {
  const Dataset dataset = Perfect(ShortDive(60.0));
  constexpr double kEver = std::numeric_limits<double>::infinity();
  const Start start = FindStart(dataset, -kEver, kEver);
  EXPECT_EQ(start.prior.x.b_g, Eigen::Vector3d(Eigen::Vector3d::Zero()));
}

TEST(UuvSurvey, NoiselessDataGiveNoError) {
  for (const char* form : {"three_axis", "beams"}) {
    const Dataset dataset = Perfect(ShortDive(120.0, form));
    Reconstruction reconstruction(dataset, {});
    for (const std::string method : {"ekf", "rts", "batch"}) {
      // Sampling the rates at 50 Hz between the spline's knots leaves this.
      EXPECT_LT(LargestPositionError(dataset, reconstruction.Run(method)), 2e-3)
          << method;
    }
  }
}

TEST(UuvSurvey, ClockThatDoesNotSettleIsNotUsable) {
  // One wild ping, and the time offset takes the blame for it.
  Scenario scenario = ShortDive(60.0);
  Dataset dataset = Simulate(scenario, 1);
  dataset.streams[0].sensor.time_offset_sigma = 0.05;
  dataset.streams[0].measurements.Edit(
      4, [](Measurement& z) { std::get<Dvl>(z.model).speed.x() = 1000.0; });
  Reconstruction reconstruction(dataset, {});
  for (const std::string method : {"ekf", "rts"}) {
    const Solution solution = reconstruction.Run(method);
    EXPECT_FALSE(solution.usable()) << solution.verdict;
    EXPECT_NE(solution.verdict.find("time offset of dvl"), std::string::npos)
        << solution.verdict;
  }
}

TEST(UuvSurvey, SmoothersAndBatchAgree) {
  Scenario scenario = FindScenario("uuv_survey", {"aiding.dvl.form=beams"});
  scenario.imu_rate_hz = 50.0;
  scenario.aiding[0].truth.beam_dropout = 0.3;
  const Dataset dataset = Simulate(scenario, 3);
  Reconstruction reconstruction(dataset, {});
  const Solution rts = reconstruction.Run("rts");
  const Solution two_filter = reconstruction.Run("two_filter");
  const Solution iterated = reconstruction.Run("iterated");
  const Solution batch = reconstruction.Run("batch");
  const int p = rts.layout.Find(BlockKind::kPosition)->offset;
  for (std::size_t k = 0; k < rts.states.size(); ++k) {
    EXPECT_LT((rts.states[k].p_e - two_filter.states[k].p_e).norm(), 1e-5);
    EXPECT_LT((iterated.states[k].p_e - batch.states[k].p_e).norm(), 1e-5);
    // The first linearisation is a small part of a sigma away.
    const double sigma =
        std::sqrt(batch.covariances.Get(k).block<3, 3>(p, p).trace());
    EXPECT_LT((rts.states[k].p_e - batch.states[k].p_e).norm(), 0.3 * sigma);
  }
}

TEST(UuvSurvey, PositionsAreAsGoodAsTheySay) {
  for (const std::string path : {"lawnmower", "straight"}) {
    Scenario scenario = FindScenario("uuv_survey", {"path=" + path});
    scenario.imu_rate_hz = 50.0;
    const PerfectRecording recording(scenario);
    const StudyResult result = testing::RunStudy(
        testing::NavigationStudy(recording, {.methods = {"ekf", "rts"}}),
        {.runs = 12});
    for (const char* method : {"ekf", "rts"}) {
      EXPECT_EQ(testing::ValueOf(result, {method}, "failed"), 0);
      // A dive is worth some five independent errors of the position: 99.9 %
      // of chi-square with 12 * 5 * 3 degrees of freedom is 0.68 to 1.38.
      const double nees = testing::ValueOf(result, {method}, "position_nees");
      EXPECT_GT(nees / 3.0, 0.68) << path << " " << method;
      EXPECT_LT(nees / 3.0, 1.38) << path << " " << method;
    }
    // A later fix improves what came before.
    EXPECT_LT(testing::ValueOf(result, {"rts"}, "position_rms"),
              testing::ValueOf(result, {"ekf"}, "position_rms"));
  }
}

/// The short dive with lasting errors of the log, constant in its axes and
/// Gauss-Markov over the ground.
Scenario LastingErrors(const std::string& form) {
  Scenario scenario = ShortDive(300.0, form);
  Sensor& log = scenario.aiding[0].sensor;
  log.bias.sigma = Eigen::Vector3d(5e-3, 5e-3, 2e-3);
  log.ground_bias.sigma = Eigen::Vector3d(2e-2, 2e-2, 5e-3);
  log.ground_bias.tau = 200.0;
  return scenario;
}

TEST(UuvSurvey, LastingErrorsThatAreNotThereGiveNone) {
  const Dataset dataset = Perfect(LastingErrors("three_axis"));
  Reconstruction reconstruction(dataset, {});
  for (const std::string method : {"ekf", "rts", "batch"}) {
    EXPECT_LT(LargestPositionError(dataset, reconstruction.Run(method)), 2e-3)
        << method;
  }
}

TEST(UuvSurvey, LastingErrorsOfTheLogAreInTheSigmas) {
  constexpr int kRuns = 20;
  // What lasts for the dive is one draw an axis.
  const Interval bounds = AneesBounds(kRuns, 3, 0.999);
  const auto nees = [](const Scenario& scenario) {
    const PerfectRecording recording(scenario);
    const StudyResult result = testing::RunStudy(
        testing::NavigationStudy(recording, {.methods = {"rts", "batch"}}),
        {.runs = kRuns});
    EXPECT_EQ(testing::ValueOf(result, {"rts"}, "failed"), 0);
    EXPECT_NEAR(testing::ValueOf(result, {"rts"}, "position_nees"),
                testing::ValueOf(result, {"batch"}, "position_nees"), 0.2);
    return testing::ValueOf(result, {"rts"}, "position_nees");
  };
  EXPECT_PRED2([](const Interval& i, double x) { return i.Contains(x); },
               bounds, nees(LastingErrors("beams")));
}

TEST(UuvSurvey, ALastingErrorThatIsNotModelledShows) {
  Scenario scenario = LastingErrors("three_axis");
  double nees = 0.0;
  constexpr int kRuns = 8;
  for (int seed = 1; seed <= kRuns; ++seed) {
    Dataset dataset = Simulate(scenario, static_cast<std::uint64_t>(seed));
    dataset.streams[0].sensor.bias.sigma.reset();
    dataset.streams[0].sensor.ground_bias.sigma.reset();
    const Solution solution = Reconstruction(dataset, {}).Run("rts");
    nees += *EvaluateTrajectory(TableFromSolution(solution), dataset.truth, {})
                 .position_nees /
            kRuns;
  }
  EXPECT_GT(nees, AneesBounds(kRuns, 3, 0.999).upper);
}

/// Water track over the ground's GNSS: the current is what is left.
Scenario WaterTrack(const Eigen::Vector3d& current) {
  Scenario s = FindScenario("uuv_calibration");
  s.duration = 120.0;
  s.imu_rate_hz = 50.0;
  AidingModel& dvl = s.aiding[0];
  dvl.sensor.scale_sigma.reset();
  dvl.sensor.mounting_sigma.reset();
  dvl.sensor.lever_arm_sigma.reset();
  PatternOf<Dvl>(dvl).water = true;
  dvl.sensor.current_sigma = 0.5;
  dvl.truth.current_n = current;
  return s;
}

void ExpectCurrent(const Scenario& scenario, const Eigen::Vector3d& current) {
  const Dataset dataset = Simulate(scenario, 5);
  Reconstruction reconstruction(dataset, {});
  for (const std::string method : {"rts", "batch"}) {
    const Solution solution = reconstruction.Run(method);
    const Block& block = *solution.layout.Find(BlockKind::kCurrent, 0);
    const std::size_t middle = solution.states.size() / 2;
    const Eigen::Vector3d estimate =
        solution.states[middle].parameters.segment<3>(block.parameter_offset);
    const ErrorMatrix P = solution.covariances.Get(middle);
    for (int i = 0; i < 3; ++i) {
      const double sigma = std::sqrt(P(block.offset + i, block.offset + i));
      EXPECT_LT(sigma, 0.1) << method;
      EXPECT_LT(std::abs(estimate(i) - current(i)), 4.0 * sigma)
          << method << " axis " << i;
    }
  }
}

TEST(UuvSurvey, WaterTrackObservesTheCurrent) {
  const Eigen::Vector3d current(0.3, -0.2, 0.0);
  Scenario constant = WaterTrack(current);
  ExpectCurrent(constant, current);
  Scenario in_time = constant;
  in_time.aiding[0].sensor.current_tau = 600.0;
  ExpectCurrent(in_time, current);
  Scenario in_space = constant;
  in_space.aiding[0].sensor.current_length = 500.0;
  ExpectCurrent(in_space, current);
}

TEST(UuvSurvey, SpatialCurrentIsTheSameForSmootherAndBatch) {
  Scenario scenario = WaterTrack({0.3, -0.2, 0.0});
  scenario.aiding[0].sensor.current_length = 100.0;
  const Dataset dataset = Simulate(scenario, 6);
  Reconstruction reconstruction(dataset, {});
  const Solution iterated = reconstruction.Run("iterated");
  const Solution batch = reconstruction.Run("batch");
  for (std::size_t k = 0; k < batch.states.size(); ++k) {
    // The batch holds the way between nodes at its start's.
    EXPECT_LT((iterated.states[k].p_e - batch.states[k].p_e).norm(), 1e-3);
  }
}

TEST(UuvSurvey, CalibrationFindsScaleBoresightAndHorizontalLeverArm) {
  Scenario scenario = FindScenario("uuv_calibration");
  scenario.imu_rate_hz = 50.0;
  const Dataset dataset = Simulate(scenario, 2);
  const Solution solution = Reconstruction(dataset, {}).Run("batch");
  int found = 0;
  for (const ConstantEstimate& c : solution.constants) {
    const auto truth = dataset.true_constants.find(c.name);
    if (truth == dataset.true_constants.end()) continue;
    ++found;
    EXPECT_LT(std::abs(c.value - truth->second), 4.0 * c.sigma) << c.name;
    const bool level_arm =
        c.name == "dvl_lever_arm[x]" || c.name == "dvl_lever_arm[y]";
    if (level_arm || c.name == "dvl_scale" || c.name == "dvl_mounting[z]") {
      EXPECT_EQ(c.verdict, ConstantEstimate::Verdict::kObserved) << c.name;
    }
    // Without roll and pitch nothing tells how deep the transducer sits.
    if (c.name == "dvl_lever_arm[z]") {
      EXPECT_NE(c.verdict, ConstantEstimate::Verdict::kObserved);
    }
  }
  EXPECT_EQ(found, 8);  // scale, mounting, lever arm, offset of the depth
}

TEST(UuvSurvey, RangesToATransponderBoundTheDrift) {
  Scenario free = FindScenario("uuv_survey", {"aids=no fix"});
  free.imu_rate_hz = 50.0;
  Scenario ranged = free;
  for (const double north : {-200.0, 800.0}) {
    AidingModel beacon(AcousticKind());
    beacon.sensor.name = north < 0.0 ? "lbl_south" : "lbl_north";
    beacon.sensor.scale_sigma = 2e-3;
    beacon.rate_hz = 0.1;
    const Eigen::Vector3d p_e = EcefFromGeodetic(free.start);
    PatternOf<AcousticFix>(beacon).p_t_e =
        p_e + NedAxes(p_e) * Eigen::Vector3d(north, 500.0, 120.0);
    beacon.sigma.emplace().setConstant(0.5);
    ranged.aiding.push_back(beacon);
  }
  const auto error = [](const Scenario& scenario) {
    const Dataset dataset = Simulate(scenario, 4);
    return LargestPositionError(dataset,
                                Reconstruction(dataset, {}).Run("ekf"));
  };
  EXPECT_LT(error(ranged), 0.5 * error(free));
}

}  // namespace
}  // namespace hindsight
