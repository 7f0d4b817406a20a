#include "problems/attitude_trial.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/chi_square.h"
#include "evaluation/state_errors.h"
#include "evaluation/statistics.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

/// Where the disturbances begin and end [s]; a stamp belongs to the interval
/// that begins there.
constexpr std::array<std::pair<double, double>, 6> kIntervals = {
    {{0.0, 5.0},
     {5.0, 10.0},
     {10.0, 40.0},
     {40.0, 45.0},
     {45.0, 60.1},
     {10.0, 60.1}}};

std::string SuffixOf(const std::pair<double, double>& interval) {
  return fmt::format("_{:g}_{:g}s", interval.first,
                     std::floor(interval.second));
}

/// At one in `every` of the states that are within the range.
StateErrors ErrorsWithin(const TimeRange& range, const Dataset& dataset,
                         const Solution& solution, std::size_t every = 1) {
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < solution.states.size(); k += every) {
    if (range.Contains(solution.states[k].t)) numbers.push_back(k);
  }
  return ErrorsOf(dataset, solution.layout, solution.states,
                  solution.covariances, numbers);
}

}  // namespace

std::vector<AttitudeWay> AccelerometerRules() {
  return {{"fixed", "ahrs", "fixed"},
          {"gate 0.3", "ahrs", "gate", 0.3},
          {"gate 0.88", "ahrs", "gate"},
          {"gate 3", "ahrs", "gate", 3.0},
          {"held gate 0.88", "ahrs", "held_gate"},
          {"adaptive", "ahrs", "adaptive"},
          {"smnc", "ahrs", "smnc"},
          {"gate 0.88, smoothed", "ahrs_smoother", "gate"},
          {"smnc, smoothed", "ahrs_smoother", "smnc"}};
}

std::vector<AttitudeWay> AttitudeMethods() {
  return {{"ahrs", "ahrs"}, {"ahrs_smoother", "ahrs_smoother"}};
}

Trial AttitudeTrial(const std::vector<AttitudeWay>& ways,
                    const AttitudeJudge& judge) {
  std::vector<std::vector<std::string>> names;
  for (const AttitudeWay& way : ways) names.push_back({way.name});
  return {names, [ways, judge](const Dataset& recording, CaseRun* run) {
            Dataset dataset = recording;
            for (const AttitudeWay& way : ways) {
              if (!way.rule.empty()) {
                dataset.ahrs.rule = way.rule;
                dataset.ahrs.gate = way.gate;
              }
              run->Try({way.name}, [&](RunRecord* record) {
                Reconstruction estimation(dataset, AttitudeAlone());
                judge(dataset, estimation.Run(way.method), record);
              });
            }
          }};
}

void JudgeIntervals(const Dataset& dataset, const Solution& solution,
                    RunRecord* record) {
  constexpr double kSigmas = 3.0;
  constexpr double kRounding = 1e-9;  // of stamps [s]
  for (const auto& interval : kIntervals) {
    const StateErrors errors = ErrorsWithin(
        {interval.first - kRounding, interval.second - 2.0 * kRounding},
        dataset, solution);
    const std::string suffix = SuffixOf(interval);
    record->values.insert(
        record->values.end(),
        {{"rms_total" + suffix, Rms(errors.attitude.Norms())},
         {"inside" + suffix, errors.attitude.ShareInside(kSigmas)},
         {"bias_rms" + suffix,
          Rms(errors.gyro_bias.Norms()) / std::sqrt(3.0)}});
  }
}

StudyTable VibrationTable() {
  StudyTable table = {"cells", {"rule"}};
  for (const auto& interval : kIntervals) {
    const std::string suffix = SuffixOf(interval);
    table.Add({{"rms_total" + suffix, kDegrees, OfRuns(Rms)},
               {"inside" + suffix, kPlain, OfRuns(Mean)},
               {"bias_rms" + suffix, {"deg/h", kDegree / kHour}, OfRuns(Rms)}});
  }
  return table;
}

AttitudeJudge MotionJudge(double begin, double end) {
  return [=](const Dataset& dataset, const Solution& solution,
             RunRecord* record) {
    constexpr std::size_t kEvery = 10;
    constexpr double kHalfStep = 0.05;
    constexpr double kThreeSigmas = 0.9973;
    const double middle = 0.5 * (begin + end);
    const PartErrors motion =
        ErrorsWithin({begin, end}, dataset, solution, kEvery).attitude;
    const PartErrors at_middle =
        ErrorsWithin({middle - kHalfStep, middle + kHalfStep}, dataset,
                     solution, kEvery)
            .attitude;
    const auto inside = std::ranges::count_if(
        motion.nees, [limit = ChiSquareQuantile(kThreeSigmas, 3.0)](
                         double nees) { return nees <= limit; });
    record->values = {{"heading_rms", Rms(motion.Component(2))},
                      {"tilt_rms", std::hypot(Rms(motion.Component(0)),
                                              Rms(motion.Component(1)))},
                      {"nees", Mean(at_middle.nees)},
                      {"inside", static_cast<double>(inside) /
                                     static_cast<double>(motion.nees.size())}};
  };
}

StudyTable FreeRotationTable() {
  StudyTable table = {"cells", {"method"}};
  table.Add({{"heading_rms", kDegrees, OfRuns(Rms)},
             {"tilt_rms", kDegrees, OfRuns(Rms)},
             {"nees", kPlain, OfRuns(Mean)},
             {"inside", kPlain, OfRuns(Mean)}});
  return table;
}

}  // namespace hindsight
