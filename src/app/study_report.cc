#include "app/study_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/flags.h"
#include "app/report_page.h"
#include "io/write/csv_line.h"
#include "io/write/number_format.h"

namespace hindsight {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kDigits = 9;

/// "_mps" of "m/s", "" of "1".
std::string Suffix(const Unit& unit) {
  std::string suffix = std::string("_") + unit.name;
  std::replace(suffix.begin(), suffix.end(), '/', 'p');
  return suffix == "_1" ? "" : suffix;
}

using Fields = std::vector<std::string>;

std::string NumberField(double value) {
  std::string text;
  if (std::isfinite(value)) AppendGeneral(value, kDigits, &text);
  return text;
}

template <typename Of>
std::string ColumnOf(const Of& of) {
  return of.name + "[" + of.unit.name + "]";
}

std::string FigureCsv(const StudyTable& table,
                      const std::vector<FigureRow>& rows) {
  Fields header = table.labels;
  header.emplace_back("runs");
  for (const Figure& figure : table.figures) {
    if (figure.is_repeatable) header.push_back(ColumnOf(figure));
  }
  std::string text = CsvLine(header);
  for (const FigureRow& row : rows) {
    Fields fields = row.labels;
    fields.push_back(std::to_string(row.runs));
    for (std::size_t f = 0; f < table.figures.size(); ++f) {
      const Figure& figure = table.figures[f];
      if (!figure.is_repeatable) continue;
      fields.push_back(NumberField(row.values[f] / figure.unit.scale));
    }
    text += CsvLine(fields);
  }
  return text;
}

std::string CurveCsv(const StudyTable& table,
                     const std::vector<FigureRow>& rows) {
  Fields header = table.labels;
  header.emplace_back("t[s]");
  for (const FigureCurve& curve : table.curves) {
    header.push_back(ColumnOf(curve));
  }
  std::string text = CsvLine(header);
  for (const FigureRow& row : rows) {
    for (std::size_t k = 0; k < row.t.size(); ++k) {
      Fields fields = row.labels;
      AppendShortest(row.t[k], &fields.emplace_back());
      for (std::size_t c = 0; c < table.curves.size(); ++c) {
        const std::vector<double>& curve = row.curves[c];
        fields.push_back(
            k < curve.size()
                ? NumberField(curve[k] / table.curves[c].unit.scale)
                : "");
      }
      text += CsvLine(fields);
    }
  }
  return text;
}

/// The rows of the first table; constants and the like have their own figures.
std::string RunsCsv(const StudyTable& table,
                    const std::vector<RunRecord>& records) {
  Fields names;
  for (const RunRecord& record : records) {
    if (record.table != 0) continue;
    for (const auto& [name, value] : record.values) {
      const bool known = std::ranges::find(names, name) != names.end();
      if (name != kSeconds && !known) names.push_back(name);
    }
  }
  Fields header = table.labels;
  header.insert(header.end(), {"seed", "grade", "failed"});
  header.insert(header.end(), names.begin(), names.end());
  std::string text = CsvLine(header);
  for (const RunRecord& record : records) {
    if (record.table != 0) continue;
    Fields fields = record.labels;
    fields.insert(fields.end(), {std::to_string(record.seed),
                                 record.grade ? GradeName(*record.grade) : "",
                                 record.failed ? "1" : "0"});
    for (const std::string& name : names) {
      const auto value = record.Find(name);
      fields.push_back(value ? NumberField(*value) : "");
    }
    text += CsvLine(fields);
  }
  return text;
}

Json RowJson(const StudyTable& table, const FigureRow& row) {
  Json json;
  for (std::size_t i = 0; i < table.labels.size(); ++i) {
    json[table.labels[i]] = row.labels[i];
  }
  json["runs"] = row.runs;
  for (std::size_t f = 0; f < table.figures.size(); ++f) {
    const Figure& figure = table.figures[f];
    const double value = row.values[f] / figure.unit.scale;
    if (!std::isfinite(value)) continue;
    Json& to = json[figure.name + Suffix(figure.unit)];
    if (value == std::round(value) && std::abs(value) < 1e9) {
      to = static_cast<std::int64_t>(value);
    } else {
      to = value;
    }
  }
  return json;
}

std::string JsonText(const Study& study, const StudyResult& result,
                     const MonteCarloOptions& options) {
  Json json;
  json["scenario"] = study.name;
  for (const auto& [key, value] : study.settings) json[key] = value;
  json["complete"] = result.complete;
  json["runs"] = result.runs;
  json["runs_asked"] = options.runs;
  json["first_seed"] = options.first_seed;
  if (!result.refusals.empty()) json["refused"] = result.refusals;
  for (std::size_t i = 0; i < result.tables.size(); ++i) {
    Json& rows = json[result.tables[i].name] = Json::array();
    for (const FigureRow& row : result.rows[i]) {
      rows.push_back(RowJson(result.tables[i], row));
    }
  }
  return json.dump(2) + "\n";
}

}  // namespace

std::vector<OutputFile> StudyFiles(const Study& study,
                                   const StudyResult& result,
                                   const MonteCarloOptions& options) {
  std::vector<OutputFile> files = {
      {kMonteCarloJson, JsonText(study, result, options)}};
  for (std::size_t i = 0; i < result.tables.size(); ++i) {
    if (result.rows[i].empty()) continue;
    files.push_back({result.tables[i].name + ".csv",
                     FigureCsv(result.tables[i], result.rows[i])});
  }
  files.push_back({"runs.csv", RunsCsv(result.tables[0], result.records)});
  if (!result.tables[0].curves.empty()) {
    files.push_back({"curves.csv", CurveCsv(result.tables[0], result.rows[0])});
  }
  return files;
}

std::string StudyHeading(const Study& study, const MonteCarloOptions& options) {
  const std::uint64_t last =
      options.first_seed + static_cast<std::uint64_t>(options.runs - 1);
  std::string text = fmt::format("{} runs, seeds {} to {}, of {}", options.runs,
                                 options.first_seed, last, study.name);
  for (const auto& [key, value] : study.settings) {
    text += ", " + key + " " + value;
  }
  return text;
}

void ReportStudy(const Study& study, const StudyResult& result,
                 const MonteCarloOptions& options, ResultFolder* folder) {
  std::cout << StudyHeading(study, options) << "\n" << StudyText(result);
  for (const OutputFile& file : StudyFiles(study, result, options)) {
    folder->Write(file);
  }
  if (FLAGS_report) {
    folder->Write({kReportName, StudyPage(study, result, options)});
  }
  folder->Commit();
}

}  // namespace hindsight
