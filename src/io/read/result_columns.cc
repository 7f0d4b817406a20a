#include "io/read/result_columns.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "io/read/npz.h"
#include "io/read/solution_columns.h"
#include "io/read/text_lines.h"

namespace hindsight {
namespace {

/// The field that `*rest` begins with, which is then what follows its comma;
/// nothing at the end of the line.
std::optional<std::string_view> TakeField(
    std::optional<std::string_view>* rest) {
  if (!*rest) return std::nullopt;
  const std::string_view line = **rest;
  const std::size_t comma = line.find(',');
  if (comma == line.npos) {
    rest->reset();
    return line;
  }
  *rest = line.substr(comma + 1);
  return line.substr(0, comma);
}

double FieldValue(std::string_view text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  fast_float::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// Lines of a result file behind its titles.
class ResultRows {
 public:
  explicit ResultRows(const std::string& path) : lines_(path) {
    std::string_view line;
    while (lines_.Next(&line)) {
      if (line.starts_with('#') || line.empty()) continue;
      titles_ = Titles(line);
      return;
    }
    throw InputError(path, 0, "no line of titles");
  }

  const std::vector<std::string_view>& Fields(std::string_view line,
                                              std::size_t expected) {
    fields_.clear();
    std::optional<std::string_view> rest = line;
    while (const auto field = TakeField(&rest)) fields_.push_back(*field);
    if (fields_.size() < expected) {
      throw InputError(lines_.path(), lines_.number(),
                       "too few fields for the titles above");
    }
    return fields_;
  }

  bool Next(std::string_view* line) { return lines_.Next(line); }
  const std::vector<std::string>& titles() const { return titles_; }

  void Require(const std::string& titles) const {
    if (Titles(titles) == titles_) return;
    throw InputError(lines_.path(), 0, "expected the titles " + titles);
  }

 private:
  static std::vector<std::string> Titles(std::string_view line) {
    std::vector<std::string> fields;
    std::optional<std::string_view> rest = line;
    while (const auto field = TakeField(&rest)) fields.emplace_back(*field);
    return fields;
  }

  TextLines lines_;
  std::vector<std::string> titles_;
  std::vector<std::string_view> fields_;
};

bool StartsWithAny(const std::string& title,
                   const std::vector<std::string>& starts) {
  return std::any_of(
      starts.begin(), starts.end(),
      [&](const std::string& start) { return title.starts_with(start); });
}

ResidualSeries* SeriesOf(std::string_view sensor, int component,
                         std::vector<ResidualSeries>* all) {
  for (ResidualSeries& series : *all) {
    if (series.component == component && series.sensor == sensor) {
      return &series;
    }
  }
  ResidualSeries& series = all->emplace_back();
  series.sensor = sensor;
  series.component = component;
  return &series;
}

}  // namespace

NumberColumns ReadNumberColumns(const std::string& path,
                                const std::vector<std::string>& without) {
  NumberColumns columns;
  if (IsNpz(path)) {
    for (auto& [name, values] : ReadNpz(path)) {
      if (StartsWithAny(name, without)) continue;
      columns[HeadingOf(name)] = std::move(values);
    }
    return columns;
  }
  ResultRows rows(path);
  std::vector<std::vector<double>*> wanted;
  for (const std::string& title : rows.titles()) {
    wanted.push_back(StartsWithAny(title, without) ? nullptr : &columns[title]);
  }
  std::string_view line;
  while (rows.Next(&line)) {
    const auto& fields = rows.Fields(line, wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (wanted[i] != nullptr) wanted[i]->push_back(FieldValue(fields[i]));
    }
  }
  return columns;
}

std::vector<ResidualSeries> ReadResiduals(const std::string& path,
                                          const std::string& method) {
  ResultRows rows(path);
  rows.Require("method,t[s],sensor,component,residual,sigma,nis,weight,status");
  std::vector<ResidualSeries> all;
  const std::string start = method + ",";
  std::string_view line;
  while (rows.Next(&line)) {
    if (!line.starts_with(start)) continue;
    const auto& fields = rows.Fields(line, 9);
    ResidualSeries* series =
        SeriesOf(fields[2], static_cast<int>(FieldValue(fields[3])), &all);
    series->t.push_back(FieldValue(fields[1]));
    series->residual.push_back(FieldValue(fields[4]));
    series->sigma.push_back(FieldValue(fields[5]));
    series->weight.push_back(FieldValue(fields[7]));
    series->status.push_back(fields[8].empty() ? 'u' : fields[8][0]);
  }
  return all;
}

std::vector<FixRow> ReadFixes(const std::string& path) {
  ResultRows rows(path);
  rows.Require(
      "t[s],sensor,lat[deg],lon[deg],h[m],sd_n[m],sd_e[m],sd_d[m],"
      "quality,satellites,status,weight");
  std::vector<FixRow> fixes;
  std::string_view line;
  while (rows.Next(&line)) {
    const auto& f = rows.Fields(line, 12);
    fixes.push_back({FieldValue(f[0]), std::string(f[1]), FieldValue(f[2]),
                     FieldValue(f[3]), FieldValue(f[4]), FieldValue(f[5]),
                     FieldValue(f[6]), FieldValue(f[7]), FieldValue(f[8]),
                     FieldValue(f[9]), std::string(f[10]), FieldValue(f[11])});
  }
  return fixes;
}

}  // namespace hindsight
