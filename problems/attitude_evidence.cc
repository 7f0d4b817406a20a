#include "problems/attitude_evidence.h"

#include <string>
#include <utility>

#include "base/units.h"
#include "dataset/bias_sigma.h"
#include "dataset/magnetic_check.h"
#include "dataset/repeated_readings.h"
#include "earth/wgs84.h"
#include "problems/attitude.h"

namespace hindsight {

std::vector<Sensor> JudgedSources() {
  std::vector<Sensor> sources(3);
  // That what the body accelerates averages out is the model of this one.
  sources[0].name = "the accelerometer";
  sources[1].name = "the velocities";
  sources[2].name = "the headings";
  return sources;
}

std::vector<NormalisedInnovation> InnovationsOf(const AttitudeRun& run) {
  std::vector<NormalisedInnovation> innovations;
  innovations.reserve(run.innovations.size());
  for (const AttitudeInnovation& innovation : run.innovations) {
    NormalisedInnovation& one = innovations.emplace_back();
    one.t = innovation.t;
    one.sensor = static_cast<int>(innovation.source);
    one.index = innovations.size() - 1;
    one.rows = innovation.rows;
    one.white = innovation.rows;
  }
  return innovations;
}

std::vector<Evidence> AttitudeEstimation::ExamineRecording() const {
  std::vector<Evidence> recording =
      FindRepeatedReadings(dataset_, imu_.t_begin(), imu_.t_end());
  recording.insert(recording.end(), evidence_.begin(), evidence_.end());
  for (std::string& warning : CheckMagnetometers(dataset_)) {
    recording.push_back({.rule = "magnetic_field",
                         .grade = Grade::kDoubtful,
                         .what = std::move(warning),
                         .is_cause = true});
  }
  if (!RoughPosition(dataset_) &&
      GyroBiasSigma(dataset_.initial).maxCoeff() < kEarthRate) {
    recording.push_back(
        {.rule = "unknown_place",
         .grade = Grade::kDoubtful,
         .what =
             "nothing says where on the Earth this is, and it turns by more "
             "than gyro_bias_sigma leaves open: 15 deg/h",
         .remedies = {"place: [lat, lon, h]"}});
  }
  if (velocities_.empty() && !VelocitySamples(dataset_).empty()) {
    recording.push_back(
        {.rule = "unused_velocities",
         .grade = Grade::kDoubtful,
         .what = "velocities that nothing tells the heading of are not used: "
                 "the tilt is wrong by whatever the body accelerates",
         .remedies = {"initial.heading, a magnetometer or headings"}});
  }
  return recording;
}

}  // namespace hindsight
