#include "problems/attitude_trial.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/chi_square.h"
#include "evaluation/statistics.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

double InsideThreeSigma(const PartErrors& part) {
  return part.ShareInside(3.0);
}

double AxisRms(const PartErrors& part) {
  return TotalRms(part) / std::sqrt(3.0);
}

double InsideEllipsoid(const PartErrors& part) {
  static const double limit = ChiSquareQuantile(0.9973, 3.0);
  const auto inside = std::ranges::count_if(
      part.nees, [](double nees) { return nees <= limit; });
  return static_cast<double>(inside) / static_cast<double>(part.nees.size());
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

Trial AttitudeTrial(const std::vector<AttitudeWay>& ways,
                    const StudyTable& table, std::size_t every) {
  std::vector<std::string> names;
  for (const AttitudeWay& way : ways) names.push_back(way.name);
  return {Named(names), [=](const Dataset& recording, CaseRun* run) {
            Dataset dataset = recording;
            for (const AttitudeWay& way : ways) {
              if (!way.rule.empty()) {
                dataset.ahrs.rule = way.rule;
                dataset.ahrs.gate = way.gate;
              }
              run->Try({way.name}, [&](RunRecord* record) {
                Reconstruction estimation(dataset, AttitudeAlone());
                const Solution solution = estimation.Run(way.method);
                table.Record(ErrorsOf(dataset, solution.layout, solution.states,
                                      solution.covariances, every),
                             record);
              });
            }
          }};
}

StudyTable VibrationTable() {
  constexpr double kRounding = 1e-9;  // of stamps [s]
  StudyTable table = {"cells", {"rule"}};
  // Where the disturbances begin and end; a stamp belongs to the interval that
  // begins there.
  for (const auto& [begin, end] : {std::pair(0.0, 5.0),
                                   {5.0, 10.0},
                                   {10.0, 40.0},
                                   {40.0, 45.0},
                                   {45.0, 60.1},
                                   {10.0, 60.1}}) {
    const TimeRange range = {begin - kRounding, end - 2.0 * kRounding};
    const std::string suffix =
        fmt::format("_{:g}_{:g}s", begin, std::floor(end));
    const auto attitude = &StateErrors::attitude;
    table.Add({Measured("rms_total" + suffix, kDegrees, Rms,
                        OfPart(attitude, TotalRms, range)),
               Measured("inside" + suffix, kPlain, Mean,
                        OfPart(attitude, InsideThreeSigma, range)),
               Measured("bias_rms" + suffix, {"deg/h", kDegree / kHour}, Rms,
                        OfPart(&StateErrors::gyro_bias, AxisRms, range))});
  }
  return table;
}

StudyTable RotationTable(double begin, double end) {
  constexpr double kHalfStep = 0.05;  // [s]
  const double middle = 0.5 * (begin + end);
  const auto attitude = &StateErrors::attitude;
  const TimeRange motion = {begin, end};
  StudyTable table = {"cells", {"method"}};
  table.Add(
      {Measured("heading_rms", kDegrees, Rms,
                OfPart(attitude, DownRms, motion)),
       Measured("tilt_rms", kDegrees, Rms, OfPart(attitude, LevelRms, motion)),
       Measured("nees", kPlain, Mean,
                OfPart(attitude, MeanNees,
                       {middle - kHalfStep, middle + kHalfStep})),
       Measured("inside", kPlain, Mean,
                OfPart(attitude, InsideEllipsoid, motion))});
  return table;
}

}  // namespace hindsight
