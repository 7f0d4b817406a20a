#ifndef HINDSIGHT_APP_REPORT_SOURCE_H_
#define HINDSIGHT_APP_REPORT_SOURCE_H_

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/read/result_columns.h"

namespace hindsight {

/// Where results are.
struct ReportPlace {
  std::filesystem::path folder;
  /// What the page calls the folder; empty: its own name.
  std::filesystem::path shown = {};
  /// In place of summary.json, which is written last.
  std::optional<nlohmann::ordered_json> summary = std::nullopt;
};

/// A solution file compared with a truth, in place of what its folder says.
// Moving a JSON value asserts what holds, so that it seems to throw.
// NOLINTNEXTLINE(bugprone-exception-escape)
struct EvaluatedSolution {
  std::filesystem::path file;      ///< METHOD.csv or METHOD.npz
  NumberColumns errors;            ///< as METHOD.errors.csv
  nlohmann::ordered_json figures;  ///< of the method, PutTruthFigures
};

/// A folder of results that `hindsight run` wrote.
// Moving a JSON value asserts what holds, so that it seems to throw.
// NOLINTNEXTLINE(bugprone-exception-escape)
struct ReportSource {
  std::filesystem::path folder;
  std::filesystem::path shown;     ///< its name on the page
  nlohmann::ordered_json summary;  ///< summary.json
  std::string config;              ///< config.resolved.yaml, "" if missing
  /// The one solution that is shown; of a file that is no result of `run` the
  /// folder is empty.
  std::optional<EvaluatedSolution> evaluated = std::nullopt;

  /// Where the folder's file is; nothing without folder or file.
  std::optional<std::filesystem::path> FileOf(const std::string& name) const;
  /// The same of columns of numbers: `stem`.csv, or else `stem`.npz.
  std::optional<std::filesystem::path> ColumnsOf(const std::string& stem) const;
  std::string Name() const;  ///< of the data set
  std::string Best() const;  ///< method, "" if none
  std::vector<std::string> Methods() const;
  const nlohmann::ordered_json& Method(const std::string& name) const;
};

/// Reads the folder's words. Throws InputError if it holds no results.
ReportSource ReadReportSource(const ReportPlace& place);

/// The same for one solution that a truth is known of; a file that is no result
/// of `run` stands alone.
ReportSource SourceOf(EvaluatedSolution evaluated);

/// One solution on the page: a method of a run.
struct ReportSolution {
  std::size_t source = 0;
  std::string method;
  std::string label;      ///< the method; of further folders "FOLDER: method"
  bool forward = false;   ///< knows at each time nothing later
  NumberColumns columns;  ///< METHOD.csv or METHOD.npz
  NumberColumns errors;   ///< METHOD.errors.csv, empty without
  int table = -1;         ///< its series on the page
  int samples = -1;       ///< the same at a few rows, exact

  const std::vector<double>& t() const { return columns.at("t[s]"); }
  bool Has(const std::string& title) const { return columns.contains(title); }
};

/// Reads what the methods' files hold, the best first. Of further sources than
/// the first their best alone.
std::vector<ReportSolution> ReadReportSolutions(
    const std::vector<ReportSource>& sources);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_REPORT_SOURCE_H_
