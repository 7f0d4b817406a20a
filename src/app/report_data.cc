#include "app/report_data.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/report_html.h"
#include "io/write/html.h"
#include "io/write/packed_series.h"

namespace hindsight {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// Spans of the extremes that are drawn at first, with two points each: about
/// the width of a chart in pixels.
constexpr std::size_t kSpans = 300;
/// Stamps are written to the microsecond.
constexpr double kTimeQuantum = 1e-6;

bool IsBinned(const ReportSeries& table) { return table.t.size() > 2 * kSpans; }

/// As many rows as two an extreme.
std::vector<double> EverySoMany(const std::vector<double>& values) {
  std::vector<double> some;
  for (std::size_t k = 0; k < 2 * kSpans; ++k) {
    some.push_back(values[k * values.size() / (2 * kSpans)]);
  }
  return some;
}

double ColumnQuantum(const std::string& name,
                     const std::vector<double>& values) {
  constexpr double kMillimetre = 1e-3;
  const bool place = name == "north" || name == "east" || name == "height";
  return place ? kMillimetre : QuantumOf(values);
}

/// What a line holds over the whole time.
struct LineFigures {
  std::size_t count = 0;
  double least = 0.0;
  double most = 0.0;
  double middle = 0.0;
  double t_most = 0.0;  ///< of the largest magnitude [s]
  double first = 0.0;
  double last = 0.0;
};

std::optional<LineFigures> FiguresOf(const ReportSeries& table,
                                     const ChartLine& line) {
  const std::vector<double>& values = table.columns.at(line.column);
  LineFigures f;
  double magnitude = -1.0;
  std::vector<double> sample;
  const std::size_t stride = std::max<std::size_t>(1, values.size() / 5000);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double v = line.factor * values[k];
    if (!std::isfinite(v)) continue;
    if (f.count++ == 0) f.least = f.most = f.first = v;
    f.last = v;
    f.least = std::min(f.least, v);
    f.most = std::max(f.most, v);
    if (std::abs(v) > magnitude) {
      magnitude = std::abs(v);
      f.t_most = table.t[k];
    }
    if (k % stride == 0) sample.push_back(v);
  }
  if (f.count == 0) return std::nullopt;
  if (sample.empty()) sample.push_back(f.first);
  const auto middle =
      sample.begin() + static_cast<std::ptrdiff_t>(sample.size() / 2);
  std::nth_element(sample.begin(), middle, sample.end());
  f.middle = *middle;
  return f;
}

std::string FigureText(const LineFigures& f, const std::string& label,
                       const std::string& unit) {
  return fmt::format("{}: from {:.4g} to {:.4g} {}, median {:.4g}", label,
                     f.least, f.most, unit == "1" ? "" : unit, f.middle);
}

}  // namespace

int ReportData::Add(ReportSeries table) {
  std::erase_if(table.columns, [](const auto& column) {
    return std::none_of(column.second.begin(), column.second.end(),
                        [](double v) { return std::isfinite(v); });
  });
  tables_.push_back(std::move(table));
  return static_cast<int>(tables_.size()) - 1;
}

bool ReportData::Has(int table, const std::string& column) const {
  return table >= 0 &&
         tables_[static_cast<std::size_t>(table)].columns.contains(column);
}

std::string ReportData::Figure(Chart chart) {
  std::erase_if(chart.lines, [this](const ChartLine& line) {
    return !Has(line.table, line.column);
  });
  if (chart.lines.empty()) return "";
  HtmlTable figures({"", "first", "median", "lowest", "highest",
                     "largest magnitude at [s]", "last"});
  std::string summary;
  for (const ChartLine& line : chart.lines) {
    const auto f = FiguresOf(table(line.table), line);
    if (!f || line.style == "dash") continue;
    if (summary.empty()) summary = FigureText(*f, line.label, chart.unit);
    figures.AddRow(
        {line.label, fmt::format("{:.5g}", f->first),
         fmt::format("{:.5g}", f->middle), fmt::format("{:.5g}", f->least),
         fmt::format("{:.5g}", f->most), fmt::format("{:.2f}", f->t_most),
         fmt::format("{:.5g}", f->last)});
  }
  const std::string unit = chart.unit == "1" ? "" : " [" + chart.unit + "]";
  std::string html =
      fmt::format("<figure class=\"chart\" data-chart=\"{}\">", charts_.size());
  html +=
      "<figcaption><b>" + EscapeHtml(chart.title) + "</b>" + EscapeHtml(unit);
  if (!chart.note.empty()) {
    html += "<span class=\"note\">" + EscapeHtml(chart.note) + "</span>";
  }
  html += "</figcaption><div class=\"legend\"></div>";
  html += "<div class=\"plot\" role=\"img\" tabindex=\"0\" aria-label=\"" +
          EscapeHtml(chart.title + unit + ". " + summary) + "\"></div>";
  html += "<details><summary>Figures</summary>";
  if (chart.difference) html += "<p>Of the solutions themselves.</p>";
  html += figures.Render() + "</details></figure>\n";
  charts_.push_back(std::move(chart));
  return html;
}

OrderedJson ReportData::Json() const {
  OrderedJson json;
  json["tables"] = OrderedJson::array();
  for (const ReportSeries& table : tables_) {
    const std::size_t n = table.t.size();
    const bool binned = IsBinned(table);
    const bool some = table.detail == ReportDetail::kSome;
    const auto drawn = [&](const std::vector<double>& values) {
      return !binned ? values
             : some  ? EverySoMany(values)
                     : Extremes(values, kSpans);
    };
    OrderedJson entry = {
        {"rows", n},
        {"shown", binned ? 2 * kSpans : n},
        {"full", binned && table.detail != ReportDetail::kExtremes},
        {"columns", OrderedJson::object()}};
    entry["t"] = Base64(PackSeries(
        binned && !some ? ExtremeTimes(table.t, kSpans) : drawn(table.t),
        kTimeQuantum));
    for (const auto& [name, values] : table.columns) {
      const double quantum = ColumnQuantum(name, values);
      entry["columns"][name] = {
          {"quantum", quantum},
          {"shown", Base64(PackSeries(drawn(values), quantum))}};
    }
    json["tables"].push_back(std::move(entry));
  }
  json["charts"] = OrderedJson::array();
  for (const Chart& chart : charts_) {
    OrderedJson entry = {
        {"title", chart.title},     {"unit", chart.unit},
        {"log", chart.logarithmic}, {"difference", chart.difference},
        {"levels", chart.levels},   {"lines", OrderedJson::array()}};
    for (const ChartLine& line : chart.lines) {
      entry["lines"].push_back({{"table", line.table},
                                {"column", line.column},
                                {"label", line.label},
                                {"group", line.group},
                                {"colour", line.colour},
                                {"factor", line.factor},
                                {"centre", line.centre},
                                {"style", line.style},
                                {"spread", line.spread}});
    }
    json["charts"].push_back(std::move(entry));
  }
  return json;
}

std::string ReportData::Blobs() const {
  std::string html;
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    const ReportSeries& table = tables_[i];
    if (!IsBinned(table) || table.detail == ReportDetail::kExtremes) continue;
    std::string bytes = PackSeries(table.t, kTimeQuantum);
    for (const auto& [name, values] : table.columns) {
      bytes += PackSeries(values, ColumnQuantum(name, values));
    }
    html += fmt::format("<script type=\"text/plain\" id=\"rows-{}\">", i) +
            Base64(Deflate(bytes)) + "</script>\n";
  }
  return html;
}

}  // namespace hindsight
