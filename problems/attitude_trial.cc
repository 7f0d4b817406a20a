#include "problems/attitude_trial.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/chi_square.h"
#include "evaluation/statistics.h"
#include "problems/navigation_trial.h"

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

std::vector<TriedRule> TriedRules() {
  const std::vector<std::string> both = {"ahrs", "ahrs_smoother"};
  return {{"fixed", "fixed"},
          {"gate 0.3", "gate", 0.3},
          {"gate 0.88", "gate", 0.88, both},
          {"gate 3", "gate", 3.0},
          {"held gate 0.88", "held_gate"},
          {"adaptive", "adaptive"},
          {"smnc", "smnc", 0.88, both}};
}

Case VibrationCase(std::vector<std::string> labels, const Recording& recording,
                   const TriedRule& rule) {
  const Recording ruled = [=](std::uint64_t seed) {
    Dataset dataset = recording(seed);
    dataset.ahrs.rule = rule.rule;
    dataset.ahrs.gate = rule.gate;
    return dataset;
  };
  labels.push_back(rule.name);
  return {
      labels, [ruled] { return ruled; },
      NavigationTrialOf({.methods = rule.methods, .cells = VibrationTable()})};
}

StudyTable VibrationTable() {
  constexpr double kRounding = 1e-9;  // of stamps [s]
  StudyTable table = {"cells", {"method"}};
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
