#include "app/run_request.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "app/flags.h"
#include "app/observer_flags.h"
#include "io/time_list.h"
#include "io/units.h"

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

std::vector<Method> ParseMethods(const std::string& text) {
  std::vector<Method> methods;
  for (const std::string& name : Split(text, ',')) {
    Method method;
    try {
      method = MethodFromName(name);
    } catch (const std::exception& error) {
      throw UsageError("--methods=" + text + ": " + error.what());
    }
    if (std::find(methods.begin(), methods.end(), method) == methods.end()) {
      methods.push_back(method);
    }
  }
  if (methods.empty()) {
    throw UsageError("--methods: expected some of ekf,rts,iterated,batch");
  }
  return methods;
}

std::set<std::string> ParseExports(const std::string& text) {
  const std::vector<std::string> known = {"tum", "kml", "nav"};
  std::set<std::string> exports;
  for (const std::string& name : Split(text, ',')) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw UsageError("--export=" + text + ": unknown format '" + name +
                       "', expected some of tum,kml,nav");
    }
    exports.insert(name);
  }
  return exports;
}

}  // namespace

std::vector<Withholding> ParseWithholdings(const std::string& text) {
  std::vector<Withholding> withholdings;
  for (const std::string& part : Split(text, ';')) {
    withholdings.push_back(ParseWithholding(part));
  }
  return withholdings;
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

RunRequest ReadRunRequest(const std::string& config) {
  RunRequest request;
  request.config = config;
  request.data_root = FLAGS_data_root;
  request.without = Split(FLAGS_without, ',');
  request.out = FLAGS_out;
  request.force = FLAGS_force;
  request.methods = ParseMethods(FLAGS_methods);
  request.from = FLAGS_from;
  request.to = FLAGS_to;
  if (!(FLAGS_from < FLAGS_to)) {
    throw UsageError("--from must be before --to");
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
  request.exports = ParseExports(FLAGS_export);
  const std::vector<ErrorDefinition> errors = ReadErrors();
  if (errors.size() != 1 || ReadGammas().size() != 1) {
    throw UsageError("'run' takes one value of --error and of --gamma");
  }
  request.error = errors.front();
  request.h_infinity = ReadCovariance(RiccatiRule::kHInfinity);
  request.modified_h_infinity = ReadCovariance(RiccatiRule::kModifiedHInfinity);
  request.progress = Progress::ModeFromName(FLAGS_progress);
  if (IsGiven("at")) request.at = ReadTimeList(FLAGS_at);
  return request;
}

}  // namespace hindsight
