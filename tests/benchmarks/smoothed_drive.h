#ifndef HINDSIGHT_TESTS_BENCHMARKS_SMOOTHED_DRIVE_H_
#define HINDSIGHT_TESTS_BENCHMARKS_SMOOTHED_DRIVE_H_

#include <string>
#include <vector>

#include "alignment/start.h"
#include "dataset/timeline_builder.h"
#include "filters/iterated_smoother.h"
#include "io/config/scenario_config.h"
#include "timeline/problem.h"

namespace hindsight {

/// 30 min at 200 Hz with GNSS of `rate` ("1 Hz"); the biases walk, so that a node
/// has 15 unknowns.
inline Dataset WalkingDrive(const std::string& rate) {
  Scenario scenario = FindScenario("car_drive", {"aiding.gnss.rate=" + rate});
  scenario.imu.noise.gyro_bias_walk = 1e-7;
  scenario.imu.noise.accel_bias_walk = 1e-5;
  return Simulate(scenario, 1);
}

/// A node a fix from `begin` on.
inline Timeline WholeTimeline(const Dataset& dataset, double begin) {
  TimelineOptions options;
  options.t_begin = begin;
  options.t_end = dataset.imu.t_end();
  return BuildTimeline(dataset, options);
}

/// Such a drive as a problem, with its nodes preintegrated, and what solvers start
/// from.
struct SmoothedDrive {
  explicit SmoothedDrive(const Dataset& dataset)
      : start(FindStart(dataset, 0.0, dataset.imu.t_end())),
        problem{start.layout, start.prior,
                WholeTimeline(dataset, start.report.t)} {
    const LinearTape tape = RunExtendedKalmanFilter(&problem);
    problem.decisions = DecisionsOnTape(tape);
    for (std::size_t k = 0; k < tape.size(); ++k) {
      filtered.push_back(tape.epoch(k).x_plus);
    }
    states = SmoothRts(tape).states;
  }

  Start start;
  Problem problem;
  std::vector<State> filtered;
  std::vector<State> states;  ///< smoothed
};

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_BENCHMARKS_SMOOTHED_DRIVE_H_
