#ifndef HINDSIGHT_APP_RUN_REQUEST_H_
#define HINDSIGHT_APP_RUN_REQUEST_H_

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/progress.h"
#include "dataset/dataset.h"
#include "io/config/config.h"
#include "problems/reconstruction.h"

namespace hindsight {

/// What the flags of `hindsight run` ask for, checked and in SI units.
struct RunRequest {
  std::string config;
  std::string data_root;
  std::vector<std::string> without;  ///< aiding streams that are left out
  std::string constants;       ///< result whose constants are used, "" for none
  std::vector<Omission> omit;  ///< spans that are left out
  bool confirmed = false;  ///< what the configuration takes for granted is so
  std::string out;
  bool force = false;
  bool clean = false;                ///< remove what killed runs left
  std::string at_file;               ///< that `at` comes from, "" for none
  std::vector<std::string> methods;  ///< in the order given, each once
  bool attitude_alone = false;       ///< all of `methods` estimate no more
  std::string ahrs_rule;  ///< in place of the configuration's if not empty
  double from = 0.0;      ///< [s]
  double to = 0.0;        ///< [s]
  /// Of the search for errors of sensors [s].
  double max_time = std::numeric_limits<double>::infinity();
  std::optional<double> rate;  ///< of the output [Hz]; absent: at the nodes
  std::vector<double> at;      ///< times of poses asked for, in order [s]
  Eigen::Vector3d point_b = Eigen::Vector3d::Zero();  ///< from the IMU [m]
  /// In place of the configuration's if not empty.
  std::vector<Withholding> withholdings;
  ErrorDefinition error = ErrorDefinition::kNavigation;
  CovarianceOptions h_infinity;
  CovarianceOptions modified_h_infinity;
  std::vector<Injection> injections;  ///< errors to add on purpose
  std::uint64_t seed = 1;             ///< of the injections
  /// Of "csv", "npz", "tum", "kml", "nav"; one of the first two is there.
  std::set<std::string> exports;
  bool report = false;  ///< make the page report.html as well
  int threads = 1;      ///< that work at once
  Progress::Mode progress = Progress::Mode::kNone;
};

/// Reads the flags. Throws UsageError naming the flag, and InputError for a
/// bad file of --at.
RunRequest ReadRunRequest(const std::string& config);

/// "SENSOR:every=120s,length=30s[,from=90s]"; several separated by ";".
/// Throws UsageError.
std::vector<Withholding> ParseWithholdings(const std::string& text);

/// "SENSOR:T1..T2"; several separated by ";". Throws UsageError.
std::vector<Omission> ParseOmissions(const std::string& text);

/// "SENSOR:step=12m,from=140s,to=150s"; step, pulse (which needs to), ramp
/// (which needs both), spikes (with share=10%) or multipath (with tau=20s); all
/// with axes=ned; several separated by ";". The size is a length or a speed.
/// Throws UsageError.
std::vector<Injection> ParseInjections(const std::string& text);

/// What --progress asks for, and --quiet where it is not given. Throws UsageError.
Progress::Mode AskedProgress();

/// "x,y,z" [m], with or without the unit. Throws UsageError.
Eigen::Vector3d ParsePoint(const std::string& text);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_RUN_REQUEST_H_
