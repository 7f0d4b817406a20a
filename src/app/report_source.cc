#include "app/report_source.h"

#include <algorithm>
#include <future>

#include "app/run_output.h"
#include "base/error.h"
#include "io/paths.h"
#include "io/result_manifest.h"
#include "io/text_file.h"
#include "problems/method.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

bool IsForwardMethod(const std::string& name) {
  const auto methods = Methods();
  return std::any_of(methods.begin(), methods.end(), [&](const Method* method) {
    return method->name == name && method->Has(MethodTrait::kForward);
  });
}

/// The columns that a page shows: the covariances' cross terms but one, and
/// the quaternion, say nothing to the eye.
NumberColumns ReadShownColumns(const fs::path& path) {
  return ReadNumberColumns(path.string(),
                           {"cov_psi", "cov_v", "cov_p_nd", "cov_p_ed", "q_"});
}

ReportSolution ReadSolution(const ReportSource& source, std::size_t number,
                            const std::string& method) {
  ReportSolution solution;
  solution.source = number;
  solution.method = method;
  solution.label =
      number == 0 ? method : source.shown.filename().string() + ": " + method;
  solution.forward = IsForwardMethod(method);
  solution.columns = ReadShownColumns(source.folder / (method + ".csv"));
  const fs::path errors = source.folder / (method + ".errors.csv");
  if (PathExists(errors)) {
    solution.errors = ReadNumberColumns(errors.string());
  }
  return solution;
}

}  // namespace

std::string ReportSource::Name() const {
  return summary.value("dataset", std::string());
}

std::string ReportSource::Best() const {
  return summary.value("best", std::string());
}

std::vector<std::string> ReportSource::Methods() const {
  std::vector<std::string> names;
  for (const auto& [name, figures] : summary.at("methods").items()) {
    names.push_back(name);
  }
  return names;
}

const nlohmann::ordered_json& ReportSource::Method(
    const std::string& name) const {
  return summary.at("methods").at(name);
}

ReportSource ReadReportSource(const ReportPlace& place) {
  const fs::path& folder = place.folder;
  const fs::path path = folder / kSummaryName;
  if (!IsFolder(folder)) {
    throw InputError(folder.string() + ": no such folder");
  }
  if (!ReadManifest(folder) || (!place.summary && !PathExists(path))) {
    throw InputError(folder.string() +
                     ": no results of 'hindsight run'; expected " +
                     kManifestName + " and " + kSummaryName + " in it");
  }
  ReportSource source;
  source.folder = folder;
  source.shown = fs::absolute(place.shown.empty() ? folder : place.shown)
                     .lexically_normal();
  if (!source.shown.has_filename()) source.shown = source.shown.parent_path();
  source.summary = place.summary
                       ? *place.summary
                       : nlohmann::ordered_json::parse(
                             ReadTextFile(path.string()), nullptr, false);
  if (!source.summary.is_object() || !source.summary.contains("methods") ||
      !source.summary["methods"].is_object()) {
    throw InputError(path.string(), 0, "no figures of a run");
  }
  const fs::path config = folder / "config.resolved.yaml";
  if (PathExists(config)) source.config = ReadTextFile(config.string());
  return source;
}

std::vector<ReportSolution> ReadReportSolutions(
    const std::vector<ReportSource>& sources) {
  std::vector<std::future<ReportSolution>> reading;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const ReportSource& source = sources[i];
    std::vector<std::string> methods = source.Methods();
    std::stable_partition(
        methods.begin(), methods.end(),
        [&](const std::string& method) { return method == source.Best(); });
    if (i > 0 && !methods.empty()) methods.resize(1);
    for (const std::string& method : methods) {
      if (!PathExists(source.folder / (method + ".csv"))) continue;
      reading.push_back(std::async(std::launch::async, ReadSolution,
                                   std::cref(source), i, method));
    }
  }
  std::vector<ReportSolution> solutions;
  for (auto& one : reading) solutions.push_back(one.get());
  std::erase_if(solutions, [](const ReportSolution& solution) {
    return !solution.Has("t[s]") || solution.t().empty();
  });
  return solutions;
}

}  // namespace hindsight
