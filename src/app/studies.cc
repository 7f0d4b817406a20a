#include "app/studies.h"

#include <algorithm>

#include "app/study_cases.h"
#include "evaluation/statistics.h"
#include "problems/navigation_trial.h"
#include "simulation/free_rotation.h"
#include "simulation/vibration_attitude.h"

namespace hindsight {
namespace {

/// Both forms of the odometer; of the forward speed alone the methods that
/// differ.
Study TunnelStudy() {
  const std::vector<double> leg_ends = {502.5, 1002.5, 1502.5, 2005.0};
  const auto trial_of = [&](const Scenario&, const ScenarioChanges& changes) {
    std::vector<std::string> methods = {"ekf", "two_filter", "iterated",
                                        "batch"};
    if (std::ranges::count(changes, "aiding.odometer.form=three_axis") > 0) {
      methods.insert(methods.begin() + 2,
                     {"two_filter_conventional", "two_filter_euler", "rts"});
    }
    return NavigationTrialOf({.methods = methods, .leg_ends = leg_ends});
  };
  return StudyOf({"tunnel_survey",
                  {{"path", "winding"},
                   {"noise", "sample"},
                   {"aiding.odometer.form", "three_axis|forward"}},
                  trial_of,
                  NavigationTables(leg_ends)});
}

/// Judged away from the ends, at times that have truth whatever the clocks.
Study ConstantsStudy(const std::string& scenario) {
  return StudyOf(
      {scenario,
       {},
       OnAll(NavigationTrialOf({.methods = {"ekf", "rts", "iterated", "batch"},
                                .judged_every = 10.0,
                                .judged_to = 599.0})),
       NavigationTables()});
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

Study UuvSurveyStudy() {
  std::vector<StudyTable> tables = NavigationTables();
  tables[kCells].Add({{"end_drift", kPlain, OfRuns(Rms)}});
  const auto trial_of = [](const Scenario& scenario, const ScenarioChanges&) {
    return NavigationTrialOf({.methods = {"ekf", "two_filter", "rts", "batch"},
                              .length = LengthOf(scenario)});
  };
  return StudyOf({"uuv_survey",
                  {{"path", "lawnmower|straight|returning"},
                   {"aids", "no fix|final fix|final fix, 120 s without DVL"}},
                  trial_of,
                  tables});
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
      {kVibrationAttitudeName,
       "the accelerometer rules of attitude-only estimation under\n"
       "acceleration and vibration, along north, one and all body\n"
       "axes, and up: attitude by interval, gyro bias, shares\n"
       "inside 3 sigma",
       VibrationAttitudeStudy,
       {}},
      {kFreeRotationName,
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
