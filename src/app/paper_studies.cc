#include "app/paper_studies.h"

#include <string>
#include <utility>
#include <vector>

#include "app/flags.h"
#include "app/list_flags.h"
#include "app/observer_flags.h"
#include "app/study_cases.h"
#include "base/error.h"
#include "base/units.h"
#include "problems/free_rotation_trial.h"
#include "problems/papers/alignment_trial.h"
#include "problems/papers/jump_comparison.h"
#include "problems/papers/uuv_fusion.h"
#include "problems/papers/vibration_comparison.h"
#include "simulation/free_rotation.h"
#include "simulation/vibration_attitude.h"

namespace hindsight {
namespace {

constexpr double kDivergedTilt = 2.0 * kDegree;
constexpr double kDivergedHeading = 10.0 * kDegree;
constexpr double kLast = 20.0;  // [s]

const Axis kVelocityRates = {"aiding.velocity.rate", "10 Hz|1 Hz", "velocity"};

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

/// Of recordings that need no preparation, a job each.
Study AttitudeStudy(
    const StudyTable& table, const Trial& trial,
    const std::vector<std::pair<std::string, Recording>>& recordings) {
  std::vector<Case> cases;
  for (const auto& [label, recording] : recordings) {
    cases.push_back(
        {{label}, [recording = recording] { return recording; }, trial});
  }
  return {"", {}, {table}, JobEach(cases)};
}

}  // namespace

Study InFlightStudy() {
  const std::vector<ObserverModel> models = ReadObserverModels();
  const CaseList list =
      MakeCases({kVelocityRates,
                 {"start_errors.tilt", "10 deg|30 deg", "start", "tilt ", true},
                 {"start_errors.heading", "30 deg|60 deg|120 deg|175 deg",
                  "start", " heading ", true}});
  const Trial trial =
      ObserverTrial(models, {.settled_tilt = 0.5 * kDegree,
                             .settled_heading = 2.0 * kDegree,
                             .diverged_tilt = kDivergedTilt,
                             .diverged_heading = kDivergedHeading,
                             .last = kLast});
  return StudyOf(list, {ObserverTable(list.columns)},
                 {JobOf(CasesOf("in_flight_alignment", list, trial))});
}

Study VelocityAlignmentStudy() {
  const CaseList list = MakeCases({kVelocityRates});
  const Trial trial = AlignmentTrial({.t_early = 20.0,
                                      .diverged_tilt = kDivergedTilt,
                                      .diverged_heading = kDivergedHeading,
                                      .last = kLast});
  std::vector<Case> cases = CasesOf("in_flight_alignment", list, trial);
  for (Case& one : cases) {
    one.prepare = [prepare = one.prepare]() -> Recording {
      return [flight = prepare()](std::uint64_t seed) {
        Dataset dataset = flight(seed);
        MountAnywhere(seed, &dataset);
        dataset.initial.alignment = AlignmentKind::kVelocity;
        return dataset;
      };
    };
  }
  return StudyOf(list, {AlignmentTable(list.columns)}, {JobOf(cases)});
}

Study GpsJumpsStudy() {
  const CaseList list = MakeCases(
      {{"errors", "pulses|spikes|steps|ramp|multipath|none", "profile"},
       {"aiding.gnss.sigma", "1 m", "gps_sigma[m]", "", true},
       {"aiding.*.rate", "1 Hz", "gps_rate[Hz]", "", true}});
  return StudyOf(list, {JumpTable(list.columns)},
                 JobEach(CasesOf("gps_jumps", list, JumpTrial())));
}

Study UuvSearchStudy() {
  constexpr int kEpochs = 1000;
  ReadWords("reading", FLAGS_reading);
  std::vector<UuvReading> readings;
  try {
    readings = UuvReadings(FLAGS_reading);
  } catch (const InputError& error) {
    throw UsageError("--reading: " + std::string(error.what()));
  }
  Study study = UuvFusionStudy(SearchTruth(), readings);
  AddMatchedFusion("matched: sensors of 9.8 m and 0.02 m", kEpochs, {9.8, 0.02},
                   &study);
  AddMatchedFusion("matched: two sensors of 9.8 m", kEpochs, {9.8, 9.8},
                   &study);
  return study;
}

Study VibrationAttitudeStudy() {
  std::vector<std::pair<std::string, Recording>> recordings;
  const auto add = [&](const std::string& name,
                       const VibrationAttitudeOptions& options) {
    recordings.emplace_back(name, [options](std::uint64_t seed) {
      return SimulateVibrationAttitude(options, seed);
    });
  };
  for (const std::string& axis : VibrationAxes()) {
    add("acceleration along " + axis, {.axis = axis});
  }
  add("acceleration and vibration along north", {.vibration_along_axis = true});
  return AttitudeStudy(VibrationTable(), VibrationTrial(), recordings);
}

Study FreeRotationStudy() {
  const auto disturbed_by = [](double disturbance) -> Recording {
    return [disturbance](std::uint64_t seed) {
      FreeRotationOptions options = DrawFreeRotation(seed);
      options.motion_disturbance = disturbance;
      return SimulateFreeRotation(options, seed);
    };
  };
  return AttitudeStudy(FreeRotationTable(kFreeRotationBegin, kFreeRotationEnd),
                       FreeRotationTrial(),
                       {{"throughout", disturbed_by(0.0)},
                        {"at rest alone", disturbed_by(60.0)}});
}

}  // namespace hindsight
