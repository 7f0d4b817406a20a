#include "app/run_request.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "app/asked_methods.h"
#include "app/flags.h"
#include "app/list_flags.h"
#include "app/observer_flags.h"
#include "attitude/accelerometer_rule.h"
#include "base/error.h"
#include "io/config/injection_text.h"
#include "io/read/time_list.h"
#include "io/read/units.h"
#include "problems/method.h"

namespace hindsight {
namespace {

Withholding ParseWithholding(const std::string& text) {
  const auto fail = [&](const std::string& what) {
    return UsageError("--withhold=" + text + ": " + what +
                      "; expected SENSOR:every=120s,length=30s[,from=90s]");
  };
  const std::size_t colon = text.find(':');
  if (colon == 0 || colon == std::string::npos) throw fail("no sensor");
  Withholding withholding;
  withholding.sensor = text.substr(0, colon);
  for (const std::string& part : Split(text.substr(colon + 1), ',')) {
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string key = part.substr(0, equals);
    if (key != "every" && key != "length" && key != "from") {
      throw fail("unknown key '" + key + "'");
    }
    double value = 0.0;
    try {
      value = ParseQuantity(part.substr(std::min(equals + 1, part.size())),
                            Quantity::kTime);
    } catch (const std::invalid_argument& error) {
      throw fail("'" + part + "': " + error.what());
    }
    if (key == "every") withholding.every = value;
    if (key == "length") withholding.length = value;
    if (key == "from") withholding.from = value;
  }
  if (withholding.every <= 0.0) throw fail("every must be positive");
  if (withholding.length <= 0.0) throw fail("length must be positive");
  if (withholding.length > withholding.every) {
    throw fail("length is greater than every");
  }
  return withholding;
}

/// The rules of a flag that takes several.
std::vector<std::string> SplitRules(const std::string& flag,
                                    const std::string& text) {
  const std::vector<std::string> rules = Split(text, ';');
  for (const std::string& rule : rules) {
    if (!rule.empty()) continue;
    throw UsageError("--" + flag + "=" + text + ": nothing beside a semicolon");
  }
  return rules;
}

std::string ReadRule(const RunRequest& request) {
  if (FLAGS_ahrs_rule.empty()) return "";
  if (!request.attitude_alone) {
    throw UsageError("--ahrs-rule goes with the methods " + MethodNames(true));
  }
  AccelerometerRuleOptions options;
  options.name = FLAGS_ahrs_rule;
  try {
    MakeAccelerometerRule(options);
  } catch (const InputError& error) {
    throw UsageError("--ahrs-rule: " + std::string(error.what()));
  }
  return FLAGS_ahrs_rule;
}

std::set<std::string> ParseExports(const std::string& text) {
  const std::vector<std::string> known = {"csv", "npz", "tum", "kml", "nav"};
  std::set<std::string> exports;
  for (const std::string& name : ReadWords("export", text)) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw UsageError("--export=" + text + ": unknown format '" + name +
                       "', expected some of csv,npz,tum,kml,nav");
    }
    exports.insert(name);
  }
  if (!exports.contains("npz")) exports.insert("csv");
  return exports;
}

bool Runs(const RunRequest& request, MethodTrait trait) {
  return std::any_of(
      request.methods.begin(), request.methods.end(),
      [&](const std::string& name) { return MethodOf(name).Has(trait); });
}

/// Throws UsageError for a flag that none of the methods asked for heeds.
void CheckFlagsAreHeeded(const RunRequest& request) {
  CheckObserverFlags(Runs(request, MethodTrait::kHInfinity),
                     Runs(request, MethodTrait::kModifiedHInfinity));
  if (IsGiven("error") && !Runs(request, MethodTrait::kDependsOnError)) {
    throw UsageError("--error changes nothing in " + FLAGS_methods);
  }
  if (IsGiven("max_time") && !Runs(request, MethodTrait::kSearches)) {
    throw UsageError("--max-time changes nothing in " + FLAGS_methods);
  }
  if (!request.attitude_alone) {
    if (IsGiven("seed") && request.injections.empty()) {
      throw UsageError("--seed goes with --inject");
    }
    return;
  }
  for (const char* flag : {"constants", "without", "omit", "withhold", "inject",
                           "seed", "point", "export"}) {
    if (!IsGiven(flag)) continue;
    throw UsageError("--" + Dashed(flag) + " means nothing to " +
                     FLAGS_methods + ", which estimate attitude alone");
  }
}

}  // namespace

std::vector<Withholding> ParseWithholdings(const std::string& text) {
  std::vector<Withholding> withholdings;
  for (const std::string& part : SplitRules("withhold", text)) {
    withholdings.push_back(ParseWithholding(part));
  }
  return withholdings;
}

std::vector<Omission> ParseOmissions(const std::string& text) {
  std::vector<Omission> omissions;
  for (const std::string& part : SplitRules("omit", text)) {
    try {
      omissions.push_back(ParseOmission(part));
    } catch (const std::invalid_argument& error) {
      throw UsageError("--omit=" + part + ": " + error.what());
    }
  }
  return omissions;
}

std::vector<Injection> ParseInjections(const std::string& text) {
  std::vector<Injection> injections;
  for (const std::string& part : SplitRules("inject", text)) {
    try {
      injections.push_back(ParseInjection(part));
    } catch (const std::invalid_argument& error) {
      throw UsageError("--inject=" + part + ": " + error.what());
    }
  }
  return injections;
}

Eigen::Vector3d ParsePoint(const std::string& text) {
  std::vector<double> values;
  try {
    values = ParseQuantities(text.ends_with('m') ? text : text + " m",
                             Quantity::kLength);
  } catch (const std::invalid_argument& error) {
    throw UsageError("--point=" + text + ": " + error.what());
  }
  if (values.size() != 3) {
    throw UsageError("--point=" + text +
                     ": expected x,y,z in metres, for example 1.2,0,-0.5");
  }
  return Eigen::Vector3d(values[0], values[1], values[2]);
}

Progress::Mode AskedProgress() {
  return FLAGS_quiet && !IsGiven("progress")
             ? Progress::Mode::kNone
             : Progress::ModeFromName(FLAGS_progress);
}

RunRequest ReadRunRequest(const std::string& config) {
  RunRequest request;
  request.config = config;
  request.data_root = FLAGS_data_root;
  request.without = ReadWords("without", FLAGS_without);
  request.constants = FLAGS_constants;
  request.omit = ParseOmissions(FLAGS_omit);
  request.confirmed = FLAGS_yes;
  request.out = FLAGS_out;
  request.force = FLAGS_force;
  request.clean = FLAGS_clean;
  AskedMethods asked = ReadMethods(FLAGS_methods);
  request.methods = std::move(asked.names);
  request.attitude_alone = asked.attitude_alone;
  request.ahrs_rule = ReadRule(request);
  request.from = FLAGS_from;
  request.to = FLAGS_to;
  if (!(FLAGS_from < FLAGS_to)) {
    throw UsageError("--from must be before --to");
  }
  if (IsGiven("max_time")) {
    if (!(FLAGS_max_time >= 0.0)) {
      throw UsageError("--max-time must be a number of seconds, not negative");
    }
    request.max_time = FLAGS_max_time;
  }
  if (IsGiven("rate")) {
    if (!std::isfinite(FLAGS_rate) || FLAGS_rate <= 0.0) {
      throw UsageError("--rate must be a positive number of Hz");
    }
    request.rate = FLAGS_rate;
  }
  if (!FLAGS_point.empty()) request.point_b = ParsePoint(FLAGS_point);
  if (FLAGS_out.empty()) {
    throw UsageError("'run' needs --out=DIR, the folder for the results");
  }
  request.withholdings = ParseWithholdings(FLAGS_withhold);
  request.injections = ParseInjections(FLAGS_inject);
  request.seed = FLAGS_seed;
  request.exports = ParseExports(FLAGS_export);
  const std::vector<ErrorDefinition> errors = ReadErrors();
  if (errors.size() != 1 || ReadGammas().size() != 1) {
    throw UsageError("'run' takes one value of --error and of --gamma");
  }
  CheckFlagsAreHeeded(request);
  request.error = errors.front();
  request.h_infinity = ReadCovariance(RiccatiRule::kHInfinity);
  request.modified_h_infinity = ReadCovariance(RiccatiRule::kModifiedHInfinity);
  request.threads = ReadThreads();
  request.report = FLAGS_report;
  request.progress = AskedProgress();
  if (IsGiven("at")) {
    request.at_file = FLAGS_at;
    request.at = ReadTimeList(FLAGS_at);
  }
  return request;
}

}  // namespace hindsight
