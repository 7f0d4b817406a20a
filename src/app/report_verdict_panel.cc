#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "app/report_html.h"
#include "app/report_panels.h"
#include "base/units.h"
#include "io/write/html.h"

namespace hindsight {
namespace {

using Json = nlohmann::ordered_json;

/// "a; b" of an array of texts.
std::string JoinedTexts(const Json& json, const std::string& key) {
  std::string text;
  if (!json.contains(key)) return text;
  for (const Json& item : json[key]) {
    if (!item.is_string()) continue;
    text += (text.empty() ? "" : "; ") + item.get<std::string>();
  }
  return text;
}

std::string GradeMark(const std::string& grade) {
  std::string css = grade;
  std::replace(css.begin(), css.end(), ' ', '-');
  return "<span class=\"grade " + EscapeHtml(css) + "\">" + EscapeHtml(grade) +
         "</span>";
}

std::string Spread(const Json& json, const std::string& key) {
  std::string text;
  if (!json.contains(key)) return text;
  for (const Json& item : json[key]) {
    text +=
        fmt::format("{}{:.3g}", text.empty() ? "" : ", ", item.get<double>());
  }
  return text;
}

std::string StartTable(const Json& summary) {
  if (!summary.contains("start")) return "";
  const Json& start = summary["start"];
  HtmlTable table({"start", "how", "sigma"});
  table.AddRow({"time", NumberOf(start, "t_s", "{:.3f} s"), ""});
  table.AddRow({"position", TextOf(start, "position"),
                Spread(start, "position_sigma_m") + " m (N, E, D)"});
  table.AddRow(
      {"velocity", "", Spread(start, "velocity_sigma_mps") + " m/s (N, E, D)"});
  table.AddRow(
      {"attitude", TextOf(start, "attitude"),
       Spread(start, "attitude_sigma_deg") + " deg (roll, pitch, heading)"});
  table.AddRow({"heading", TextOf(start, "heading"), ""});
  table.AddRow({"alignment", TextOf(start, "alignment"), ""});
  table.AddRow({"why", TextOf(start, "why"), ""});
  return "<h3>Start</h3>\n" + table.Render();
}

std::string EvidenceTable(const ReportContext& context) {
  HtmlTable table({"grade", "what", "limit", "likely causes", "what to try"});
  for (const Json& e : context.BestSummary().value("evidence", Json::array())) {
    const std::vector<std::string> cells = {
        TextOf(e, "grade"), TextOf(e, "what"),
        NumberOf(e, "limit", "{:.4g}") + " " + TextOf(e, "unit"),
        JoinedTexts(e, "likely_causes"), JoinedTexts(e, "what_to_try")};
    if (e.contains("span_s")) {
      table.AddRow(cells, e["span_s"][0].get<double>() - 5.0,
                   e["span_s"][1].get<double>() + 5.0);
    } else {
      table.AddRow(cells);
    }
  }
  return "<h3>Evidence</h3>\n" + table.Render();
}

std::string MethodTable(const ReportContext& context) {
  HtmlTable table({"method", "grade", "verdict", "horizontal error rms [m]",
                   "horizontal error max [m]", "outages: horizontal rms [m]",
                   "outages: max [m]", "iterations", "time [s]"});
  for (std::size_t i = 0; i < context.sources.size(); ++i) {
    const ReportSource& source = context.sources[i];
    for (const std::string& name : source.Methods()) {
      const Json& m = source.Method(name);
      const Json error = m.value("error", Json::object());
      const Json withheld = m.value("withheld", Json::object());
      table.AddRow(
          {i == 0 ? name : source.shown.filename().string() + ": " + name,
           TextOf(m, "grade"), TextOf(m, "verdict"),
           NumberOf(error, "horizontal_rms_m", "{:.3f}"),
           NumberOf(error, "horizontal_max_m", "{:.3f}"),
           NumberOf(withheld, "horizontal_rms_m", "{:.3f}"),
           NumberOf(withheld, "horizontal_max_m", "{:.3f}"),
           NumberOf(m, "iterations", "{:.0f}"),
           NumberOf(m, "seconds", "{:.3f}")});
    }
  }
  return "<h3>Methods</h3>\n" + table.Render();
}

std::string Words(const Json& summary) {
  std::string items;
  for (const Json& span : summary.value("unobserved", Json::array())) {
    items += "<li class=\"warning\">" +
             EscapeHtml(TextOf(span, "component") + " is not observed from " +
                        NumberOf(span, "t_begin_s", "{:.1f}") + " s to " +
                        NumberOf(span, "t_end_s", "{:.1f}") + " s") +
             "</li>";
  }
  for (const Json& warning : summary.value("warnings", Json::array())) {
    items += "<li class=\"warning\">" + EscapeHtml(warning.get<std::string>()) +
             "</li>";
  }
  for (const Json& policy : summary.value("policies", Json::array())) {
    items +=
        "<li>" +
        EscapeHtml(TextOf(policy, "stream") + ": " + TextOf(policy, "action") +
                   ": " + NumberOf(policy, "count", "{:.0f}")) +
        "</li>";
  }
  for (const Json& note : summary.value("notes", Json::array())) {
    items += "<li>" + EscapeHtml(note.get<std::string>()) + "</li>";
  }
  for (const auto& [name, m] : summary["methods"].items()) {
    const std::string words = TextOf(m, "contradicts_truth");
    if (words.empty()) continue;
    items +=
        "<li class=\"warning\">" + EscapeHtml(name + ": " + words) + "</li>";
  }
  return items.empty() ? "" : "<h3>Notes</h3>\n<ul>" + items + "</ul>\n";
}

/// Figures at the top: what, and how much.
std::string Tiles(const ReportContext& context) {
  const Json& summary = context.reference().summary;
  const ReportSolution& best = context.best();
  std::string html;
  const auto tile = [&](const std::string& name, const std::string& value) {
    if (value.empty()) return;
    html += "<div><dt>" + EscapeHtml(name) + "</dt><dd>" + EscapeHtml(value) +
            "</dd></div>";
  };
  const double length = best.t().back() - best.t().front();
  tile("Duration",
       length < 7200.0
           ? fmt::format("{:.1f} s", length)
           : fmt::format("{} h {:02} min", static_cast<int>(length / 3600.0),
                         static_cast<int>(length / 60.0) % 60));
  if (context.BestSummary().contains("distance_m")) {
    const double way = context.BestSummary()["distance_m"].get<double>();
    tile("Distance", way < 10000.0 ? fmt::format("{:.0f} m", way)
                                   : fmt::format("{:.1f} km", way / 1e3));
  }
  tile("Solution", best.method);
  tile("Epochs", std::to_string(best.t().size()));
  if (summary.contains("epoch")) {
    tile("t = 0 (UTC)", TextOf(summary["epoch"], "utc"));
    tile("GPS week, second",
         NumberOf(summary["epoch"], "gps_week", "{:.0f}") + ", " +
             NumberOf(summary["epoch"], "gps_second", "{:.3f}"));
  }
  return "<dl class=\"tiles\">" + html + "</dl>\n";
}

/// What the recommended solution estimates, by its columns and constants.
std::string EstimatedText(const ReportContext& context) {
  constexpr std::pair<const char*, const char*> kStates[] = {
      {"h[m]", "position"},
      {"v_n[m/s]", "velocity"},
      {"roll[deg]", "attitude"},
      {"bg_x[deg/h]", "gyro biases"},
      {"ba_x[m/s^2]", "accelerometer biases"}};
  std::string text;
  const auto add = [&text](const std::string& name) {
    text += (text.empty() ? "" : ", ") + name;
  };
  for (const auto& [column, name] : kStates) {
    if (context.best().Has(column)) add(name);
  }
  const Json constants =
      context.BestSummary().value("constants", Json::object());
  for (const auto& item : constants.items()) add(item.key());
  return "<h3>Estimated</h3>\n" + Element("p", text + ".");
}

std::string Rivals(const Json& method) {
  HtmlTable table({"another explanation", "probability [%]"});
  for (const Json& rival : method.value("rivals", Json::array())) {
    table.AddRow(
        {TextOf(rival, "description"),
         fmt::format("{:.2g}", 100.0 * rival.value("probability", 0.0))});
  }
  return table.Render();
}

}  // namespace

std::string TextOf(const nlohmann::ordered_json& json, const std::string& key) {
  return json.contains(key) && json[key].is_string()
             ? json[key].get<std::string>()
             : std::string();
}

std::string NumberOf(const nlohmann::ordered_json& json, const std::string& key,
                     const char* format) {
  if (!json.contains(key) || !json[key].is_number()) return "";
  return fmt::format(fmt::runtime(format), json[key].get<double>());
}

std::string VerdictPanel(ReportContext* context) {
  const Json& summary = context->reference().summary;
  const Json& best = context->BestSummary();
  const std::string grade = TextOf(best, "grade");
  std::string html =
      "<div class=\"card\"><p class=\"verdict\">" +
      (grade.empty() ? "" : GradeMark(grade) + " ") + "<b>" +
      EscapeHtml(context->best().method) + "</b> " +
      EscapeHtml(grade.empty() ? "was compared with a truth; the file does not "
                                 "say how it was graded"
                               : "is " + TextOf(best, "verdict")) +
      "</p>";
  if (!summary.value("complete", true)) {
    html +=
        "<p class=\"warning\">The run was interrupted: these are the "
        "methods that were done.</p>";
  }
  html += Tiles(*context) + "</div>\n";
  if (context->sources.size() > 1) {
    HtmlTable runs({"folder", "data set", "best", "grade"});
    for (const ReportSource& source : context->sources) {
      runs.AddRow({source.shown.filename().string(), source.Name(),
                   source.Best(), TextOf(source.summary, "grade")});
    }
    html += "<h3>Side by side, the first as reference</h3>\n" + runs.Render();
  }
  return html + MethodTable(*context) + EvidenceTable(*context) + Rivals(best) +
         Words(summary) + StartTable(summary) + EstimatedText(*context);
}

}  // namespace hindsight
