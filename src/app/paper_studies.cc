#include <string>
#include <vector>

#include "app/observer_flags.h"
#include "app/studies.h"
#include "app/study_cases.h"
#include "problems/attitude_trial.h"
#include "problems/papers/alignment_trial.h"
#include "problems/papers/jump_comparison.h"
#include "problems/papers/observer_comparison.h"
#include "problems/papers/uuv_fusion.h"
#include "simulation/free_rotation.h"
#include "simulation/vibration_attitude.h"

namespace hindsight {
namespace {

const Axis kVelocityRates = {"aiding.velocity.rate", "10 Hz|1 Hz"};

UuvTruth SearchTruth() {
  const WayPointPath path(FindScenario("uuv_survey").way_points);
  UuvTruth truth;
  for (double t = 0.0; t <= path.duration(); t += 1.0) {
    const PathPoint at = path.At(t);
    ErrorVector x(6);
    x << at.p_n.x(), at.v_n.x(), at.p_n.y(), at.v_n.y(), at.p_n.z(), at.v_n.z();
    truth.push_back(x);
  }
  return truth;
}

Case AttitudeCase(const std::string& label, const Recording& recording,
                  const Trial& trial) {
  return {{label}, [recording] { return recording; }, trial};
}

}  // namespace

Study InFlightStudy() {
  return StudyOf({"in_flight_alignment",
                  {kVelocityRates,
                   {"start_errors.tilt", "10 deg|30 deg"},
                   {"start_errors.heading", "30 deg|60 deg|120 deg|175 deg"}},
                  OnAll(ObserverTrial(ReadObserverModels())),
                  {ObserverTable()}});
}

Study VelocityAlignmentStudy() {
  const Trial align = AlignmentTrial(20.0);
  const Trial trial = {align.methods,
                       [align](const Dataset& flight, CaseRun* run) {
                         Dataset dataset = flight;
                         MountAnywhere(run->seed, &dataset);
                         align.run(dataset, run);
                       }};
  return StudyOf({"in_flight_alignment",
                  {kVelocityRates},
                  OnAll(trial),
                  {AlignmentTable()}});
}

Study GpsJumpsStudy() {
  return StudyOf({"gps_jumps",
                  {{"errors", "pulses|spikes|steps|ramp|multipath|none"},
                   {"aiding.gnss.sigma", "1 m"},
                   {"aiding.*.rate", "1 Hz"}},
                  OnAll(JumpTrial()),
                  {JumpTable()}});
}

Study UuvSearchStudy() {
  constexpr int kEpochs = 1000;
  Study study = {.tables = {FusionTable()}};
  for (const UuvReading& reading : UuvReadings()) {
    study.cases.push_back(UuvSearch(reading, SearchTruth()));
  }
  study.cases.push_back(MatchedSearch("matched: sensors of 9.8 m and 0.02 m",
                                      kEpochs, {9.8, 0.02}));
  study.cases.push_back(
      MatchedSearch("matched: two sensors of 9.8 m", kEpochs, {9.8, 9.8}));
  return study;
}

Study VibrationAttitudeStudy() {
  Study study = {.tables = {Under({"disturbance"}, VibrationTable())}};
  const auto add = [&](const std::string& name,
                       const VibrationAttitudeOptions& options) {
    study.cases.push_back(AttitudeCase(
        name,
        [options](std::uint64_t seed) {
          return SimulateVibrationAttitude(options, seed);
        },
        AttitudeTrial(AccelerometerRules(), JudgeIntervals)));
  };
  for (const std::string& axis : VibrationAxes()) {
    add("acceleration along " + axis, {.axis = axis});
  }
  add("acceleration and vibration along north", {.vibration_along_axis = true});
  return study;
}

Study FreeRotationStudy() {
  const auto disturbed_by = [](double disturbance) -> Recording {
    return [disturbance](std::uint64_t seed) {
      FreeRotationOptions options = DrawFreeRotation(seed);
      options.motion_disturbance = disturbance;
      return SimulateFreeRotation(options, seed);
    };
  };
  const Trial trial = AttitudeTrial(
      AttitudeMethods(), MotionJudge(kFreeRotationBegin, kFreeRotationEnd));
  return {.tables = {Under({"field"}, FreeRotationTable())},
          .cases = {AttitudeCase("throughout", disturbed_by(0.0), trial),
                    AttitudeCase("at rest alone", disturbed_by(60.0), trial)}};
}

}  // namespace hindsight
