#include "app/studies.h"

#include <algorithm>
#include <iterator>

#include "app/asked_methods.h"
#include "app/flags.h"
#include "app/grades_study.h"
#include "app/list_flags.h"
#include "app/study_cases.h"
#include "base/error.h"
#include "base/units.h"
#include "evaluation/statistics.h"
#include "problems/free_rotation_trial.h"
#include "problems/navigation_trial.h"
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

void AddJobEach(const std::vector<Case>& cases, Study* study) {
  for (const Case& one : cases) study->jobs.push_back(JobOf({one}));
}

/// Both forms of the odometer on one seed, so that the first seeds are those of
/// both; of the forward speed alone the methods that differ.
Study TunnelStudy() {
  const std::vector<double> kLegEnds = {502.5, 1002.5, 1502.5, 2005.0};
  const CaseList list = MakeCases({{"path", "winding"}, {"noise", "sample"}});
  std::vector<Case> cases;
  for (const bool forward : {false, true}) {
    CaseList of_form = list;
    for (CaseList::Entry& entry : of_form.cases) {
      entry.labels.emplace_back(forward ? "forward" : "three axes");
      if (forward) entry.changes.push_back("aiding.odometer.form=forward");
    }
    const std::vector<std::string> methods =
        forward
            ? std::vector<std::string>{"ekf", "two_filter", "iterated", "batch"}
            : std::vector<std::string>{"ekf",
                                       "two_filter",
                                       "two_filter_conventional",
                                       "two_filter_euler",
                                       "rts",
                                       "iterated",
                                       "batch"};
    const Trial trial =
        NavigationTrialOf({.methods = methods, .leg_ends = kLegEnds});
    std::ranges::move(CasesOf("tunnel_survey", of_form, trial),
                      std::back_inserter(cases));
  }
  std::vector<std::string> columns = list.columns;
  columns.emplace_back("odometer");
  return {
      "", list.settings, NavigationTables(columns, kLegEnds), {JobOf(cases)}};
}

/// Largest standard deviations by distance of the reference points and noise of
/// the odometer.
Study TunnelSweepStudy() {
  const CaseList list = MakeCases(
      {{"path", "winding"},
       {"noise", "sample"},
       {"aiding.reference.spacing", "250 m|500 m|1000 m|2000 m|4000 m|8000 m",
        "reference_spacing[m]", "", true},
       {"aiding.odometer.sigma", "0.005 m/s|0.01 m/s|0.02 m/s|0.05 m/s|0.1 m/s",
        "odometer_sigma[m/s]", "", true}});
  Study study = {"", list.settings, NavigationTables(list.columns, {}), {}};
  AddJobEach(CasesOf("tunnel_survey", list,
                     NavigationTrialOf({.methods = {"two_filter", "batch"}})),
             &study);
  return study;
}

/// Judged away from the ends, at times that have truth whatever the clocks.
Study ConstantsStudy(const std::string& scenario) {
  const CaseList list = MakeCases({});
  const Trial trial =
      NavigationTrialOf({.methods = {"ekf", "rts", "iterated", "batch"},
                         .judged_every = 10.0,
                         .judged_to = 599.0});
  return {"",
          list.settings,
          NavigationTables(list.columns, {}),
          {JobOf(CasesOf(scenario, list, trial))}};
}

double LengthOf(const Scenario& scenario) {
  constexpr double kStep = 0.5;
  const WayPointPath path(scenario.way_points);
  double length = 0.0;
  for (double t = 0.5 * kStep; t < path.duration(); t += kStep) {
    length += kStep * path.At(t).v_n.norm();
  }
  return length;
}

double DriftOf(const RunCell& cell, const std::string& end, const TimeRange&) {
  return Rms(cell.Values(end)) / Mean(cell.Values("length"));
}

/// Dives, whose length each run has as a value.
Study UuvSurveyStudy() {
  const CaseList list =
      MakeCases({{"path", "lawnmower|straight|returning", "dive"},
                 {"aids", "no fix|final fix|final fix, 120 s without DVL",
                  "dive", ", "}});
  Study study = {"", list.settings, NavigationTables(list.columns, {}), {}};
  Figure drift =
      Share("end_drift", "end, of\ndistance [%]", "end_horizontal", DriftOf);
  drift.format = "{:.3f}";
  drift.part = 1;
  study.tables[kCells].figures.push_back(drift);
  for (const CaseList::Entry& entry : list.cases) {
    const Scenario scenario = FindScenario("uuv_survey", entry.changes);
    study.jobs.push_back(JobOf(
        {{entry.labels, [scenario] { return RecordingOf(scenario); },
          NavigationTrialOf({.methods = {"ekf", "two_filter", "rts", "batch"},
                             .values = {{"length", LengthOf(scenario)}}})}}));
  }
  return study;
}

const Axis kVelocityRates = {"aiding.velocity.rate", "10 Hz|1 Hz", "velocity"};

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
  return {"",
          list.settings,
          {ObserverTable(list.columns)},
          {JobOf(CasesOf("in_flight_alignment", list, trial))}};
}

/// The same flight from no start value at all, the IMU mounted at any attitude.
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
  return {"", list.settings, {AlignmentTable(list.columns)}, {JobOf(cases)}};
}

Study GpsJumpsStudy() {
  const CaseList list = MakeCases(
      {{"errors", "pulses|spikes|steps|ramp|multipath|none", "profile"},
       {"aiding.gnss.sigma", "1 m", "gps_sigma[m]", "", true},
       {"aiding.*.rate", "1 Hz", "gps_rate[Hz]", "", true}});
  Study study = {"", list.settings, {JumpTable(list.columns)}, {}};
  AddJobEach(CasesOf("gps_jumps", list, JumpTrial()), &study);
  return study;
}

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

/// The fusions of Lee and Yoon (2011) as printed, under --reading.
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
  std::vector<std::pair<std::string, VibrationAttitudeOptions>> disturbances;
  for (const std::string& axis : VibrationAxes()) {
    disturbances.push_back({"acceleration along " + axis, {.axis = axis}});
  }
  disturbances.push_back({"acceleration and vibration along north",
                          {.vibration_along_axis = true}});
  Study study = {"", {}, {VibrationTable()}, {}};
  for (const auto& [name, options] : disturbances) {
    const Recording recording = [options = options](std::uint64_t seed) {
      return SimulateVibrationAttitude(options, seed);
    };
    study.jobs.push_back(
        JobOf({{{name}, [recording] { return recording; }, VibrationTrial()}}));
  }
  return study;
}

/// With the field throughout, and with one that is of no use in motion.
Study FreeRotationStudy() {
  constexpr double kDisturbance = 60.0;  // [uT]
  Study study = {
      "", {}, {FreeRotationTable(kFreeRotationBegin, kFreeRotationEnd)}, {}};
  for (const bool disturbed : {false, true}) {
    const Recording recording = [disturbed](std::uint64_t seed) {
      FreeRotationOptions options = DrawFreeRotation(seed);
      if (disturbed) options.motion_disturbance = kDisturbance;
      return SimulateFreeRotation(options, seed);
    };
    study.jobs.push_back(JobOf({{{disturbed ? "at rest alone" : "throughout"},
                                 [recording] { return recording; },
                                 FreeRotationTrial()}}));
  }
  return study;
}

/// That knows when the scenario's sensors are silent.
Trial ScenarioTrial(const std::vector<std::string>& methods,
                    const Scenario& scenario) {
  NavigationTrial trial = {.methods = methods, .judged_every = 1.0};
  for (const AidingModel& model : scenario.aiding) {
    for (const TimeSpan& outage : model.outages) {
      trial.silent_spans.push_back(
          {model.sensor.name, outage.begin, outage.end});
    }
  }
  return NavigationTrialOf(trial);
}

}  // namespace

Study ScenarioStudy(const std::vector<std::string>& names_or_paths) {
  const std::vector<std::string> methods = ReadTrajectoryMethods(FLAGS_methods);
  const CaseList list = MakeCases({});
  std::vector<std::string> columns = {"scenario"};
  columns.insert(columns.end(), list.columns.begin(), list.columns.end());
  Study study = {"", list.settings, NavigationTables(columns, {}), {}};
  std::vector<std::string> names;
  for (const std::string& file : names_or_paths) {
    const std::string name = FindScenario(file, list.cases[0].changes).name;
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      throw UsageError("two scenarios of the name '" + name + "'");
    }
    names.push_back(name);
    study.name += (study.name.empty() ? "" : ",") + name;
    std::vector<Case> cases = CasesOf(file, list, {});
    for (std::size_t i = 0; i < cases.size(); ++i) {
      cases[i].labels.insert(cases[i].labels.begin(), name);
      cases[i].trial =
          ScenarioTrial(methods, FindScenario(file, list.cases[i].changes));
    }
    AddJobEach(cases, &study);
  }
  return study;
}

const std::vector<NamedStudy>& NamedStudies() {
  static const std::vector<NamedStudy> studies = {
      {"tunnel_survey",
       "an odometer survey of 8 km, by three axes and by the\n"
       "forward speed alone",
       TunnelStudy,
       {"set", "sweep"}},
      {"tunnel_sweep",
       "the same against the distance of the reference points,\n"
       "0.25 to 8 km, and the odometer noise, 5 to 100 mm/s",
       TunnelSweepStudy,
       {"set", "sweep"}},
      {"calibration",
       "ten minutes on which lever arms, time offsets, scale\n"
       "factors and the mounting are all unknown and estimated,\n"
       "each judged by its errors over its sigmas",
       [] { return ConstantsStudy("calibration"); },
       {"set", "sweep"}},
      {"in_flight_alignment",
       "forward observers from bad initial attitudes, Riccati\n"
       "rule x definition of the error x start: shares that\n"
       "diverge or escape, time to settle, final errors, Lyapunov\n"
       "figures",
       InFlightStudy,
       {"set", "sweep", "rules", "error", "gamma", "alpha", "alpha_blocks",
        "delta", "bounded", "back_off"},
       300},
      {"velocity_alignment",
       "aligns the same flight from no start value, the IMU\n"
       "mounted at any attitude, and then solves it as a batch",
       VelocityAlignmentStudy,
       {"set", "sweep"}},
      {"gps_jumps",
       "filters and batches under errors of the positions",
       GpsJumpsStudy,
       {"set", "sweep"}},
      {kVibrationAttitudeName,
       "the accelerometer rules of attitude-only estimation under\n"
       "acceleration and vibration, along north, one and all body\n"
       "axes, and up: attitude by axis and interval, gyro bias,\n"
       "shares inside 3 sigma",
       VibrationAttitudeStudy},
      {kFreeRotationName,
       "attitude alone over 20 net turns with scale factors of\n"
       "0.4 %, by a field that is seen throughout or at rest alone",
       FreeRotationStudy},
      {"grades",
       "four vehicles, healthy and with faults of every kind in\n"
       "three sizes (data/faults/grades.yaml): whether what is wrong is\n"
       "graded so",
       GradesStudy,
       {"faults", "methods"},
       2},
      {"uuv_survey",
       "a dive with INS, DVL and depth: lawn-mower, straight leg\n"
       "and lawn-mower that ends near its start, each without\n"
       "and with a final fix and with a gap of the DVL",
       UuvSurveyStudy,
       {"set", "sweep"}},
      {"uuv_calibration",
       "figures of eight at the surface with GNSS: scale,\n"
       "boresight and lever arm of the DVL, judged as above",
       [] { return ConstantsStudy("uuv_calibration"); },
       {"set", "sweep"}},
      {"uuv_search",
       "the fusions of Lee and Yoon (2011) as printed, 16\n"
       "readings: 2-D and 3-D distance error with histograms",
       UuvSearchStudy,
       {"reading"}}};
  return studies;
}

}  // namespace hindsight
