#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "app/report_html.h"
#include "app/report_lines.h"
#include "base/units.h"
#include "earth/wgs84.h"

namespace hindsight {
namespace {

double LongestStep(const std::vector<double>& t) {
  double longest = 0.0;
  for (std::size_t k = 1; k < t.size(); ++k) {
    longest = std::max(longest, t[k] - t[k - 1]);
  }
  return longest;
}

double MedianStep(const std::vector<double>& t) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < t.size(); ++k) steps.push_back(t[k] - t[k - 1]);
  if (steps.empty()) return 0.0;
  const auto middle =
      steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

void AddSpan(const char* kind, const std::string& label, double from, double to,
             nlohmann::ordered_json* spans) {
  spans->push_back(
      {{"kind", kind}, {"label", label}, {"from", from}, {"to", to}});
}

/// Spans of the time line: withheld, unobserved, at rest, gaps.
nlohmann::ordered_json Spans(const ReportContext& context) {
  nlohmann::ordered_json spans = nlohmann::ordered_json::array();
  const auto& best = context.BestSummary();
  if (best.contains("withheld")) {
    for (const auto& outage : best["withheld"]["outages"]) {
      AddSpan("withheld", outage.value("sensor", ""),
              outage.value("t_begin_s", 0.0), outage.value("t_end_s", 0.0),
              &spans);
    }
  }
  if (best.contains("unobserved")) {
    for (const auto& span : best["unobserved"]) {
      AddSpan("unobserved", span.value("component", ""),
              span.value("t_begin_s", 0.0), span.value("t_end_s", 0.0), &spans);
    }
  }
  const auto& summary = context.reference().summary;
  for (const char* kind : {"rests", "gaps"}) {
    if (!summary.contains(kind)) continue;
    for (const auto& span : summary[kind]) {
      AddSpan(kind, span.value("stream", ""), span.value("t_begin_s", 0.0),
              span.value("t_end_s", 0.0), &spans);
    }
  }
  return spans;
}

/// What the evidence lowers the grade of, and when: the worst holds.
nlohmann::ordered_json GradeSpans(const ReportContext& context) {
  nlohmann::ordered_json spans = nlohmann::ordered_json::array();
  const std::vector<double>& t = context.best().t();
  const auto evidence =
      context.BestSummary().value("evidence", nlohmann::ordered_json::array());
  for (const auto& e : evidence) {
    const std::string grade = e.value("grade", "");
    const int rank = grade == "doubtful" ? 1 : grade == "not usable" ? 2 : 0;
    if (rank == 0) continue;
    double from = t.front();
    double to = t.back();
    if (e.contains("span_s")) {
      from = e["span_s"][0].get<double>();
      to = e["span_s"][1].get<double>();
    }
    spans.push_back({{"from", from}, {"to", to}, {"grade", rank}});
  }
  return spans;
}

}  // namespace

std::string TimeLinePanel(ReportContext* context) {
  HtmlTable table({"stream", "measurements", "rate [Hz]", "longest step [s]",
                   "used", "rejected", "withheld", "down-weighted"});
  nlohmann::ordered_json lanes = nlohmann::ordered_json::array();
  for (const ResidualSeries& r : context->residuals) {
    if (r.component != 0) continue;
    const auto count = [&](char status) {
      return std::count(r.status.begin(), r.status.end(), status);
    };
    long weak = 0;
    for (std::size_t k = 0; k < r.t.size(); ++k) {
      if (r.status[k] == 'u' && r.weight[k] < 0.5) ++weak;
    }
    const double step = MedianStep(r.t);
    table.AddRow({r.sensor, std::to_string(r.t.size()),
                  step > 0.0 ? fmt::format("{:.3g}", 1.0 / step) : "",
                  fmt::format("{:.3g}", LongestStep(r.t)),
                  std::to_string(count('u')), std::to_string(count('r')),
                  std::to_string(count('w')), std::to_string(weak)});
    const int number = context->data.Add(ResidualTable(r));
    lanes.push_back({{"label", r.sensor}, {"table", number}});
  }
  context->time_line["lanes"] = lanes;
  context->time_line["spans"] = Spans(*context);
  if (lanes.empty()) {
    return Absent(
        "There is no residuals.csv of this run: attitude alone has none, an "
        "interrupted run has not written it.");
  }
  return "<figure class=\"chart wide\"><figcaption><b>What was measured when, "
         "and what became of it</b></figcaption><div class=\"legend\" "
         "id=\"lane-legend\"></div><div id=\"lanes\" class=\"plot lanes\" "
         "role=\"img\" tabindex=\"0\" aria-label=\"Time line of the "
         "streams; the table below holds its figures\"></div></figure>\n" +
         table.Render();
}

std::string MapPanel(ReportContext* context) {
  if (!context->data.Has(context->best().table, "north")) {
    return Absent("There are no positions: attitude alone was estimated.");
  }
  const auto& origin = context->map["origin"];
  const Geodetic place = {origin[0].get<double>() * kDegree,
                          origin[1].get<double>() * kDegree,
                          origin[2].get<double>()};
  const Eigen::Vector3d p0 = EcefFromGeodetic(place);
  const Eigen::Matrix3d C_ne =
      NedAxes(place.latitude, place.longitude).transpose();
  ReportSeries fixes;
  for (const FixRow& fix : context->fixes) {
    const Eigen::Vector3d d =
        C_ne * (EcefFromGeodetic({fix.latitude_deg * kDegree,
                                  fix.longitude_deg * kDegree, fix.height}) -
                p0);
    fixes.t.push_back(fix.t);
    fixes.columns["north"].push_back(d.x());
    fixes.columns["east"].push_back(d.y());
    fixes.columns["fate"].push_back(fix.status == "used"       ? 1.0
                                    : fix.status == "rejected" ? 2.0
                                    : fix.status == "withheld" ? 3.0
                                                               : 4.0);
  }
  if (!fixes.t.empty()) {
    fixes.detail = ReportDetail::kSome;
    context->map["fixes"] = context->data.Add(std::move(fixes));
  }
  context->map["grades"] = GradeSpans(*context);
  std::string html =
      "<figure class=\"map\"><figcaption><b>Track and fixes</b> [m], north up"
      "<span class=\"note\">Drag to move, wheel or two fingers to zoom, click "
      "to place the cursor, double click to see all.</span></figcaption>"
      "<div class=\"tools\" id=\"map-tools\"></div>"
      "<div id=\"map-view\" role=\"img\" tabindex=\"0\" aria-label=\"Map of "
      "the track in metres\"></div></figure>\n";
  if (context->fixes.empty()) {
    html += Absent(
        "Without fixes: none was measured, or this run wrote no fixes.csv.");
  }
  return html;
}

std::string OutagePanel(ReportContext* context) {
  const auto& best = context->BestSummary();
  if (!best.contains("withheld")) {
    return Absent(
        "No measurement was withheld (--withhold, or `withhold` in "
        "the configuration).");
  }
  HtmlTable table({"sensor", "from [s]", "to [s]", "length [s]", "distance [m]",
                   "horizontal rms", "horizontal max", "total max", "unit",
                   "drift [%]"});
  for (const auto& outage : best["withheld"]["outages"]) {
    const double from = outage.value("t_begin_s", 0.0);
    const double to = outage.value("t_end_s", 0.0);
    const bool speed = outage.contains("horizontal_rms_mps");
    const std::string unit = speed ? "mps" : "m";
    const auto figure = [&](const std::string& key, int decimals) {
      return outage.contains(key)
                 ? fmt::format("{:.{}f}", outage[key].get<double>(), decimals)
                 : std::string();
    };
    constexpr double kAround = 5.0;
    table.AddRow(
        {outage.value("sensor", ""), fmt::format("{:.1f}", from),
         fmt::format("{:.1f}", to), fmt::format("{:.1f}", to - from),
         figure("distance_m", 1), figure("horizontal_rms_" + unit, 3),
         figure("horizontal_max_" + unit, 3), figure("total_max_" + unit, 3),
         speed ? "m/s" : "m", figure("drift_percent", 2)},
        from - kAround, to + kAround);
  }
  return Element("p", "Of " + context->best().label +
                          ", against the measurements that were kept back. A "
                          "row zooms everything to its outage.") +
         table.Render();
}

namespace {

/// Shares of the fixes by what the receivers said of them.
std::string QualityTable(const ReportContext& context) {
  HtmlTable table({"stream", "quality", "share of the fixes [%]", "fixes",
                   "satellites, mean"});
  bool any = false;
  const auto streams = context.reference().summary.value(
      "fixes", nlohmann::ordered_json::object());
  for (const auto& [stream, fixes] : streams.items()) {
    const std::string count = std::to_string(fixes.value("count", 0L));
    const std::string satellites =
        fixes.contains("satellites_mean")
            ? fmt::format("{:.1f}", fixes["satellites_mean"].get<double>())
            : "";
    const auto shares =
        fixes.value("quality_percent", nlohmann::ordered_json::object());
    for (const auto& [quality, share] : shares.items()) {
      table.AddRow({stream, quality, fmt::format("{:.1f}", share.get<double>()),
                    count, satellites});
      any = true;
    }
    if (shares.empty()) table.AddRow({stream, "", "", count, satellites});
  }
  if (any) return table.Render();
  return Element("p",
                 "The files of the fixes say nothing of the receiver's "
                 "quality.") +
         table.Render();
}

}  // namespace

std::string ReceiverPanel(ReportContext* context) {
  if (context->fixes.empty()) {
    return Absent("There are no fixes, or this run wrote no fixes.csv.");
  }
  std::map<std::string, ReportSeries> sensors;
  for (const FixRow& fix : context->fixes) {
    ReportSeries& series = sensors[fix.sensor];
    series.t.push_back(fix.t);
    series.columns["sd_n"].push_back(fix.sd_n);
    series.columns["sd_e"].push_back(fix.sd_e);
    series.columns["sd_d"].push_back(fix.sd_d);
    series.columns["quality"].push_back(fix.quality);
    series.columns["satellites"].push_back(fix.satellites);
  }
  std::string figures;
  for (auto& [sensor, series] : sensors) {
    const int table = context->data.Add(std::move(series));
    Chart chart = {.title = sensor + ": stated sigma", .unit = "m"};
    int colour = 0;
    for (const char* axis : {"n", "e", "d"}) {
      chart.lines.push_back({.table = table,
                             .column = std::string("sd_") + axis,
                             .label = axis[0] == 'n'   ? "north"
                                      : axis[0] == 'e' ? "east"
                                                       : "down",
                             .colour = colour++});
    }
    chart.logarithmic = true;
    figures += context->data.Figure({.title = sensor + ": quality",
                                     .unit = "1",
                                     .note = "In the receiver's own numbers.",
                                     .lines = {{.table = table,
                                                .column = "quality",
                                                .label = "quality",
                                                .style = "points"}}});
    figures += context->data.Figure(
        {.title = sensor + ": satellites",
         .unit = "1",
         .lines = {
             {.table = table, .column = "satellites", .label = "satellites"}}});
    figures += context->data.Figure(std::move(chart));
  }
  return QualityTable(*context) + "<div class=\"grid\">" + figures + "</div>\n";
}

}  // namespace hindsight
