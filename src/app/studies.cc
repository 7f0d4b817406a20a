#include "app/studies.h"

#include "app/observer_flags.h"
#include "app/study_cases.h"
#include "evaluation/statistics.h"
#include "problems/attitude_trial.h"
#include "problems/navigation_trial.h"
#include "problems/papers/alignment_trial.h"
#include "problems/papers/jump_comparison.h"
#include "problems/papers/observer_comparison.h"
#include "problems/papers/uuv_fusion.h"
#include "simulation/free_rotation.h"
#include "simulation/vibration_attitude.h"

namespace hindsight {
namespace {

const Axis kVelocityRates = {"aiding.velocity.rate", "10 Hz|1 Hz"};

Study TunnelStudy() {
  const std::vector<double> leg_ends = {502.5, 1002.5, 1502.5, 2005.0};
  return StudyOf(
      {{"tunnel_survey"},
       {{"path", "winding"},
        {"noise", "sample"},
        {"aiding.odometer.form", "three_axis|forward"}},
       NavigationTrialOf(
           {.methods = {"ekf", "two_filter", "two_filter_conventional",
                        "two_filter_euler", "rts", "iterated", "batch"},
            .leg_ends = leg_ends}),
       NavigationTables(leg_ends)});
}

/// Judged away from the ends, at times that have truth whatever the clocks.
Study ConstantsStudy(const std::string& scenario) {
  return StudyOf(
      {{scenario},
       {},
       NavigationTrialOf({.methods = {"ekf", "rts", "iterated", "batch"},
                          .judged_every = 10.0,
                          .judged_to = 599.0}),
       NavigationTables()});
}

Study UuvSurveyStudy() {
  std::vector<StudyTable> tables = NavigationTables();
  tables[kCells].Add({{"end_drift", kPlain, OfRuns(Rms)}});
  return StudyOf(
      {{"uuv_survey"},
       {{"path", "lawnmower|straight|returning"},
        {"aids", "no fix|final fix|final fix, 120 s without DVL"}},
       NavigationTrialOf({.methods = {"ekf", "two_filter", "rts", "batch"}}),
       tables});
}

/// From bad attitudes.
Study InFlightStudy() {
  return StudyOf({{"in_flight_alignment"},
                  {kVelocityRates,
                   {"start_errors.tilt", "10 deg|30 deg"},
                   {"start_errors.heading", "30 deg|60 deg|120 deg|175 deg"}},
                  ObserverTrial(ReadObserverModels()),
                  {ObserverTable()}});
}

/// The same flight, the IMU mounted at any attitude.
Study VelocityAlignmentStudy() {
  const Trial align = AlignmentTrial(20.0);
  const Trial trial = {align.methods, [align](Dataset flight, CaseRun* run) {
                         MountAnywhere(run->seed, &flight);
                         align.run(flight, run);
                       }};
  return StudyOf(
      {{"in_flight_alignment"}, {kVelocityRates}, trial, {AlignmentTable()}});
}

Study GpsJumpsStudy() {
  return StudyOf({{"gps_jumps"},
                  {{"errors", "pulses|spikes|steps|ramp|multipath|none"},
                   {"aiding.gnss.sigma", "1 m"},
                   {"aiding.*.rate", "1 Hz"}},
                  JumpTrial(),
                  {JumpTable()}});
}

/// The fusions of Lee and Yoon (2011) on that path.
Study UuvSearchStudy() {
  const WayPointPath path(FindScenario("uuv_survey").way_points);
  UuvTruth truth;
  for (double t = 0.0; t <= path.duration(); t += 1.0) {
    const PathPoint at = path.At(t);
    ErrorVector x(6);
    x << at.p_n.x(), at.v_n.x(), at.p_n.y(), at.v_n.y(), at.p_n.z(), at.v_n.z();
    truth.push_back(x);
  }
  Study study = {.tables = {FusionTable()}};
  for (const UuvReading& reading : UuvReadings()) {
    study.cases.push_back(UuvSearch(reading, truth));
  }
  study.cases.push_back(
      MatchedSearch("matched: sensors of 9.8 m and 0.02 m", {9.8, 0.02}));
  study.cases.push_back(
      MatchedSearch("matched: two sensors of 9.8 m", {9.8, 9.8}));
  return study;
}

Study VibrationAttitudeStudy() {
  Study study = {.tables = {Under({"disturbance", "rule"}, VibrationTable())}};
  const auto add = [&](const std::string& name,
                       const VibrationAttitudeOptions& options) {
    const Recording recording = [options](std::uint64_t seed) {
      return SimulateVibrationAttitude(options, seed);
    };
    for (const TriedRule& rule : TriedRules()) {
      study.cases.push_back(VibrationCase({name}, recording, rule));
    }
  };
  for (const std::string& axis : VibrationAxes()) {
    add("acceleration along " + axis, {.axis = axis});
  }
  add("acceleration and vibration along north", {.vibration_along_axis = true});
  return study;
}

/// With the field throughout, and with one that is of no use in motion.
Study FreeRotationStudy() {
  const StudyTable table = RotationTable(kFreeRotationBegin, kFreeRotationEnd);
  Study study = {.tables = {Under({"field"}, table)}};
  for (const auto& [name, disturbance] :
       {std::pair("throughout", 0.0), {"at rest alone", 60.0}}) {
    const Recording recording = [disturbance =
                                     disturbance](std::uint64_t seed) {
      FreeRotationOptions options = DrawFreeRotation(seed);
      options.motion_disturbance = disturbance;
      return SimulateFreeRotation(options, seed);
    };
    study.cases.push_back(
        {{name},
         [recording] { return recording; },
         NavigationTrialOf({.methods = {"ahrs", "ahrs_smoother"},
                            .cells = table,
                            .judged_every = 0.1})});
  }
  return study;
}

}  // namespace

const std::vector<NamedStudy>& NamedStudies() {
  static const std::vector<NamedStudy> studies = {
      {"tunnel_survey",
       "an odometer survey of 8 km, by three axes and by the\n"
       "forward speed alone",
       TunnelStudy},
      {"calibration",
       "ten minutes on which lever arms, time offsets, scale\n"
       "factors and the mounting are all unknown and estimated,\n"
       "each judged by its errors over its sigmas",
       [] { return ConstantsStudy("calibration"); }},
      {"in_flight_alignment",
       "forward observers from bad initial attitudes, Riccati\n"
       "rule x definition of the error x start: shares that\n"
       "diverge or escape, time to settle, final errors, Lyapunov\n"
       "figures",
       InFlightStudy,
       {"set", "sweep", "methods", "error", "gamma", "alpha", "alpha_blocks",
        "delta", "bounded", "back_off"},
       300},
      {"velocity_alignment",
       "aligns the same flight from no start value, the IMU\n"
       "mounted at any attitude, and then solves it as a batch",
       VelocityAlignmentStudy},
      {"gps_jumps", "filters and batches under errors of the positions",
       GpsJumpsStudy},
      {"vibration_attitude",
       "the accelerometer rules of attitude-only estimation under\n"
       "acceleration and vibration, along north, one and all body\n"
       "axes, and up: attitude by interval, gyro bias, shares\n"
       "inside 3 sigma",
       VibrationAttitudeStudy,
       {}},
      {"free_rotation",
       "attitude alone over 20 net turns with scale factors of\n"
       "0.4 %, by a field that is seen throughout or at rest alone",
       FreeRotationStudy,
       {}},
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
       UuvSurveyStudy},
      {"uuv_calibration",
       "figures of eight at the surface with GNSS: scale,\n"
       "boresight and lever arm of the DVL, judged as above",
       [] { return ConstantsStudy("uuv_calibration"); }},
      {"uuv_search",
       "the fusions of Lee and Yoon (2011) as printed, 16\n"
       "readings: 2-D and 3-D distance error",
       UuvSearchStudy,
       {}}};
  return studies;
}

}  // namespace hindsight
