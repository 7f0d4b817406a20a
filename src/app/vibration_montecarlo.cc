#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/montecarlo_scenarios.h"
#include "base/text.h"
#include "io/table.h"
#include "problems/vibration_comparison.h"
#include "simulation/vibration_attitude.h"

namespace hindsight {
namespace {

std::string IntervalName(const VibrationInterval& interval) {
  return Format("%g-%g s", interval.begin, std::min(interval.end, 60.0));
}

nlohmann::ordered_json Json(const std::vector<VibrationResult>& results) {
  const auto axes = [](const Eigen::Vector3d& v) {
    return nlohmann::ordered_json{v.x() / kDegree, v.y() / kDegree,
                                  v.z() / kDegree};
  };
  nlohmann::ordered_json json;
  for (const VibrationResult& result : results) {
    for (std::size_t i = 0; i < result.intervals.size(); ++i) {
      const VibrationStatistics& s = result.intervals[i];
      json[result.name][IntervalName(VibrationIntervals()[i])] = {
          {"rms_deg", axes(s.rms)},
          {"max_deg", axes(s.largest)},
          {"rms_total_deg", s.rms_total / kDegree},
          {"inside_3_sigma", s.inside},
          {"gyro_bias_rms_degph", s.bias_rms / kDegree * kHour},
          {"gyro_bias_inside_3_sigma", s.bias_inside}};
    }
  }
  return json;
}

/// 3-D RMS, largest component and share inside 3 sigma of every interval.
std::string Text(const std::vector<VibrationResult>& results) {
  std::vector<std::string> heading = {"3-D RMS, max [deg],\ninside [%]"};
  for (const VibrationInterval& interval : VibrationIntervals()) {
    heading.push_back(IntervalName(interval));
  }
  heading.push_back("gyro bias 45-60 s\nRMS [deg/h], inside [%]");
  ReportTable table(heading);
  for (const VibrationResult& result : results) {
    std::vector<std::string> row = {result.name};
    for (const VibrationStatistics& s : result.intervals) {
      row.push_back(Format("%.3f %.2f %.1f", s.rms_total / kDegree,
                           s.largest.maxCoeff() / kDegree, 100.0 * s.inside));
    }
    const VibrationStatistics& last = result.intervals[4];
    row.push_back(Format("%.2f %.1f", last.bias_rms / kDegree * kHour,
                         100.0 * last.bias_inside));
    table.AddRow(row);
  }
  return table.Render();
}

}  // namespace

void RunVibrationAttitude(MonteCarloOptions options, Progress* progress,
                          ResultFolder* folder) {
  std::vector<VibrationAttitudeOptions> variants;
  for (const std::string& axis : VibrationAxes()) {
    variants.emplace_back().axis = axis;
  }
  variants.emplace_back().vibration_along_axis = true;
  const double work =
      static_cast<double>(options.runs) * static_cast<double>(variants.size());
  nlohmann::ordered_json json = {{"scenario", kVibrationAttitudeName},
                                 {"complete", false},
                                 {"runs", options.runs},
                                 {"first_seed", options.first_seed}};
  std::string text;
  int before = 0;
  for (const VibrationAttitudeOptions& scenario : variants) {
    const auto results = CompareUnderVibration(
        [&](std::uint64_t seed) {
          return SimulateVibrationAttitude(scenario, seed);
        },
        options.runs, options.first_seed,
        [&](int done) { progress->Update("runs", (before + done) / work); },
        nullptr);
    before += options.runs;
    const std::string along =
        scenario.vibration_along_axis ? " and vibration" : "";
    json["axes"][scenario.axis + along] = Json(results);
    text += "\nacceleration" + along + " along " + scenario.axis + "\n" +
            Text(results);
    folder->Keep(kMonteCarloJson, json.dump(2) + "\n");
  }
  progress->Clear();
  std::cout << kVibrationAttitudeName << ", " << options.runs << " runs\n"
            << text;
  json["complete"] = true;
  folder->Commit(kMonteCarloJson, json.dump(2) + "\n");
}

}  // namespace hindsight
