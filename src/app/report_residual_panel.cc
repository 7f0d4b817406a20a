#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/report_html.h"
#include "app/report_lines.h"

namespace hindsight {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Residuals over sigma of what was used.
std::vector<double> NormalizedUsed(const ResidualSeries& series) {
  std::vector<double> values;
  for (std::size_t k = 0; k < series.t.size(); ++k) {
    const double r = series.residual[k] / series.sigma[k];
    if (series.status[k] == 'u' && std::isfinite(r)) values.push_back(r);
  }
  return values;
}

BarPicture HistogramPicture(const std::vector<double>& values) {
  constexpr int kBins = 32;
  constexpr double kEnd = 4.0;
  BarPicture picture;
  picture.title = "Histogram against N(0, 1)";
  picture.bars.assign(kBins, 0.0);
  std::size_t beyond = 0;
  double sum = 0.0;
  double square = 0.0;
  for (const double v : values) {
    sum += v;
    square += v * v;
    if (std::abs(v) > 3.0) ++beyond;
    const int bin = static_cast<int>(
        std::floor((std::clamp(v, -kEnd, kEnd) + kEnd) / (2.0 * kEnd) * kBins));
    picture.bars[static_cast<std::size_t>(std::min(bin, kBins - 1))] += 1.0;
  }
  const double n = static_cast<double>(values.size());
  constexpr double kWidth = 2.0 * kEnd / kBins;
  double most = 0.45;
  for (double& bar : picture.bars) {
    bar /= n * kWidth;
    most = std::max(most, bar);
  }
  for (int i = 0; i <= 80; ++i) {
    const double x = -kEnd + 0.1 * i;
    picture.curve.push_back(std::exp(-0.5 * x * x) /
                            std::sqrt(2.0 * std::numbers::pi));
  }
  picture.high = most;
  picture.left = "-4 sigma";
  picture.right = "4 sigma";
  picture.summary = fmt::format(
      "{} used: mean {:.2f}, rms {:.2f}, {:.2f} % beyond 3 sigma (0.27 % "
      "expected).",
      values.size(), sum / n, std::sqrt(square / n),
      100.0 * static_cast<double>(beyond) / n);
  return picture;
}

BarPicture Autocorrelation(const std::vector<double>& values) {
  constexpr std::size_t kLags = 30;
  const std::size_t lags = std::min(kLags, values.size() / 2);
  const double n = static_cast<double>(values.size());
  double mean = 0.0;
  for (const double v : values) mean += v / n;
  double power = 0.0;
  for (const double v : values) power += (v - mean) * (v - mean);
  BarPicture picture;
  picture.title = "Autocorrelation";
  for (std::size_t lag = 1; lag <= lags; ++lag) {
    double sum = 0.0;
    for (std::size_t k = lag; k < values.size(); ++k) {
      sum += (values[k] - mean) * (values[k - lag] - mean);
    }
    picture.bars.push_back(power > 0.0 ? sum / power : 0.0);
  }
  const double bound = 1.96 / std::sqrt(n);
  picture.levels = {bound, -bound};
  picture.low = std::min(
      -0.3, *std::min_element(picture.bars.begin(), picture.bars.end()));
  picture.high = std::max(
      0.5, *std::max_element(picture.bars.begin(), picture.bars.end()));
  picture.left = "lag 1";
  picture.right = fmt::format("lag {}", lags);
  picture.summary = fmt::format(
      "At lag 1: {:.2f}; white noise stays within {:.2f} (dashed) in 95 % of "
      "the "
      "lags.",
      picture.bars.front(), bound);
  return picture;
}

std::vector<ChartLine> FateLines(int table, const std::string& suffix) {
  std::vector<ChartLine> lines;
  int colour = 0;
  for (const char* fate : {"used", "withheld", "rejected"}) {
    lines.push_back({.table = table,
                     .column = fate + suffix,
                     .label = fate,
                     .colour = colour++,
                     .style = "points"});
  }
  return lines;
}

/// What the summary says of a sensor's residuals.
nlohmann::ordered_json FactsOf(const ReportContext& context,
                               const std::string& sensor) {
  const auto all = context.BestSummary().value(
      "residuals", nlohmann::ordered_json::object());
  return all.contains(sensor) ? all[sensor] : nlohmann::ordered_json::object();
}

std::string TitleOf(const ReportContext& context,
                    const ResidualSeries& series) {
  const auto names = FactsOf(context, series.sensor)
                         .value("components", nlohmann::ordered_json::array());
  const auto component = static_cast<std::size_t>(series.component);
  if (component < names.size()) {
    return series.sensor + ", " + names[component].get<std::string>();
  }
  const bool alone =
      std::count_if(context.residuals.begin(), context.residuals.end(),
                    [&](const ResidualSeries& other) {
                      return other.sensor == series.sensor;
                    }) == 1;
  return alone ? series.sensor
               : fmt::format("{}, component {}", series.sensor,
                             series.component + 1);
}

std::string LargestTable(const ReportContext& context) {
  struct Entry {
    double size;
    const ResidualSeries* series;
    std::size_t row;
  };
  std::vector<Entry> entries;
  for (const ResidualSeries& series : context.residuals) {
    for (std::size_t k = 0; k < series.t.size(); ++k) {
      const double r = std::abs(series.residual[k] / series.sigma[k]);
      if (std::isfinite(r)) entries.push_back({r, &series, k});
    }
  }
  const std::size_t count = std::min<std::size_t>(15, entries.size());
  std::partial_sort(
      entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(count),
      entries.end(),
      [](const Entry& a, const Entry& b) { return a.size > b.size; });
  HtmlTable table(
      {"t [s]", "sensor", "residual", "sigma", "over sigma", "weight", "fate"});
  for (std::size_t i = 0; i < count; ++i) {
    const ResidualSeries& s = *entries[i].series;
    const std::size_t k = entries[i].row;
    const char* fate = s.status[k] == 'u'   ? "used"
                       : s.status[k] == 'r' ? "rejected"
                                            : "withheld";
    constexpr double kAround = 15.0;
    table.AddRow({fmt::format("{:.3f}", s.t[k]), TitleOf(context, s),
                  fmt::format("{:.4g}", s.residual[k]),
                  fmt::format("{:.4g}", s.sigma[k]),
                  fmt::format("{:.2f}", entries[i].size),
                  fmt::format("{:.3g}", s.weight[k]), fate},
                 s.t[k] - kAround, s.t[k] + kAround);
  }
  return "<h3>The largest</h3>\n" + table.Render();
}

}  // namespace

ReportSeries ResidualTable(const ResidualSeries& r) {
  ReportSeries series;
  series.t = r.t;
  const std::size_t n = r.t.size();
  std::vector<double> over(n, kNone);
  std::vector<double> used(n, kNone);
  std::vector<double> rejected(n, kNone);
  std::vector<double> withheld(n, kNone);
  std::vector<double> used_over(n, kNone);
  std::vector<double> rejected_over(n, kNone);
  std::vector<double> withheld_over(n, kNone);
  for (std::size_t k = 0; k < n; ++k) {
    over[k] = r.residual[k] / r.sigma[k];
    const bool is_used = r.status[k] == 'u';
    const bool is_rejected = r.status[k] == 'r';
    (is_used ? used : is_rejected ? rejected : withheld)[k] = r.residual[k];
    (is_used       ? used_over
     : is_rejected ? rejected_over
                   : withheld_over)[k] = over[k];
  }
  auto& columns = series.columns;
  columns["used"] = std::move(used);
  columns["rejected"] = std::move(rejected);
  columns["withheld"] = std::move(withheld);
  columns["used_over"] = std::move(used_over);
  columns["rejected_over"] = std::move(rejected_over);
  columns["withheld_over"] = std::move(withheld_over);
  columns["sigma"] = r.sigma;
  const bool weighted = std::any_of(r.weight.begin(), r.weight.end(),
                                    [](double w) { return w != 1.0; });
  if (weighted) columns["weight"] = r.weight;
  return series;
}

std::string ResidualPanel(ReportContext* context) {
  if (context->residuals.empty()) {
    return Absent(
        "There is no residuals.csv of this run: attitude alone has none, an "
        "interrupted run has not written it.");
  }
  std::string html = Element(
      "p", "Measured minus predicted, of " + context->best().label +
               ", in the sensor's unit (m, m/s, rad/s). Dashed: 2 and 3 sigma "
               "as predicted.");
  html += LargestTable(*context);
  std::size_t lane = 0;
  for (const ResidualSeries& r : context->residuals) {
    const int table =
        r.component == 0
            ? context->time_line["lanes"][lane++]["table"].get<int>()
            : context->data.Add(ResidualTable(r));
    const std::string title = TitleOf(*context, r);
    Chart raw = {.title = title + ": residual",
                 .unit = FactsOf(*context, r.sensor).value("unit", "SI"),
                 .lines = FateLines(table, "")};
    for (const double factor : {3.0, 2.0, -2.0, -3.0}) {
      raw.lines.push_back({.table = table,
                           .column = "sigma",
                           .label = fmt::format("{:g} sigma", factor),
                           .colour = -1,
                           .factor = factor,
                           .style = "dash"});
    }
    html += "<h3>" + Element("span", title) + "</h3><div class=\"grid\">" +
            context->data.Figure(std::move(raw)) +
            context->data.Figure({.title = title + ": over sigma",
                                  .unit = "sigma",
                                  .lines = FateLines(table, "_over"),
                                  .levels = {-3.0, -2.0, 2.0, 3.0}});
    html += context->data.Figure(
        {.title = title + ": weight",
         .unit = "1",
         .lines = {{.table = table, .column = "weight", .label = "weight"}}});
    const std::vector<double> values = NormalizedUsed(r);
    constexpr std::size_t kFewest = 10;
    if (values.size() >= kFewest) {
      html += "<div class=\"pair\">" + Render(HistogramPicture(values)) +
              Render(Autocorrelation(values)) + "</div>";
    }
    html += "</div>\n";
  }
  return html;
}

}  // namespace hindsight
