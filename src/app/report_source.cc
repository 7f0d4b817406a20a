#include "app/report_source.h"

#include <algorithm>
#include <future>

#include "app/run_output.h"
#include "base/error.h"
#include "io/read/paths.h"
#include "io/read/text_file.h"
#include "io/write/result_manifest.h"
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
  if (source.evaluated) {
    solution.columns = ReadShownColumns(source.evaluated->file);
    solution.errors = source.evaluated->errors;
    return solution;
  }
  solution.columns = ReadShownColumns(*source.ColumnsOf(method));
  if (const auto errors = source.FileOf(method + ".errors.csv")) {
    solution.errors = ReadNumberColumns(errors->string());
  }
  return solution;
}

/// The name under which `run` writes a file: of METHOD.csv, METHOD.
std::string MethodOfFile(const fs::path& file) { return file.stem().string(); }

}  // namespace

std::optional<fs::path> ReportSource::FileOf(const std::string& name) const {
  if (folder.empty() || !PathExists(folder / name)) return std::nullopt;
  return folder / name;
}

std::optional<fs::path> ReportSource::ColumnsOf(const std::string& stem) const {
  const auto text = FileOf(stem + ".csv");
  return text ? text : FileOf(stem + ".npz");
}

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
  if (const auto config = source.FileOf("config.resolved.yaml")) {
    source.config = ReadTextFile(config->string());
  }
  return source;
}

ReportSource SourceOf(EvaluatedSolution evaluated) {
  const std::string method = MethodOfFile(evaluated.file);
  const fs::path folder = fs::absolute(evaluated.file).parent_path();
  ReportSource source;
  source.shown = evaluated.file;
  if (ReadManifest(folder) && PathExists(folder / kSummaryName)) {
    ReportSource known = ReadReportSource({.folder = folder});
    if (known.summary["methods"].contains(method)) source = std::move(known);
  }
  nlohmann::ordered_json& summary = source.summary;
  if (source.folder.empty()) {
    summary = {{"program", kProgram}, {"dataset", method}};
  }
  nlohmann::ordered_json figures = nlohmann::ordered_json::object();
  if (summary.contains("methods")) figures = summary["methods"][method];
  for (const char* key : {"contradicts_truth", "error", "nees"}) {
    figures.erase(key);
  }
  figures.update(evaluated.figures);
  summary["best"] = method;
  summary["methods"] = {{method, figures}};
  source.evaluated = std::move(evaluated);
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
      if (!source.evaluated && !source.ColumnsOf(method)) continue;
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
