#include <utility>

#include "app/report_html.h"
#include "app/report_panels.h"
#include "base/units.h"
#include "io/write/html.h"

namespace hindsight {
namespace {

using Json = nlohmann::ordered_json;

std::string InputTable(const Json& summary) {
  HtmlTable table({"input", "bytes", "files", "SHA-256"});
  for (const Json& input : summary.value("inputs", Json::array())) {
    table.AddRow({TextOf(input, "path"), NumberOf(input, "bytes", "{:.0f}"),
                  NumberOf(input, "files", "{:.0f}"), TextOf(input, "sha256")});
  }
  return table.Render();
}

}  // namespace

std::string ModePanel(ReportContext* context) {
  std::string html;
  for (const ReportSolution& solution : context->solutions) {
    if (solution.source != 0) continue;
    const auto path =
        context->reference().FileOf(solution.method + ".modes.csv");
    if (!path) continue;
    NumberColumns modes = ReadNumberColumns(path->string());
    ReportSeries series;
    series.t = std::move(modes["t[s]"]);
    modes.erase("t[s]");
    series.columns = std::move(modes);
    std::vector<ChartLine> lines;
    std::vector<std::string> names;
    for (const auto& [name, values] : series.columns) names.push_back(name);
    const int table = context->data.Add(std::move(series));
    for (const std::string& name : names) {
      lines.push_back({.table = table,
                       .column = name,
                       .label = name,
                       .colour = static_cast<int>(lines.size())});
    }
    html += context->data.Figure({.title = solution.method + ": modes",
                                  .unit = "1",
                                  .note = "Probability of each mode.",
                                  .lines = std::move(lines)});
  }
  std::string found;
  for (const std::string& name : context->reference().Methods()) {
    const Json& method = context->reference().Method(name);
    for (const Json& words : method.value("found", Json::array())) {
      found += "<li>" +
               EscapeHtml(name + " found " + words.get<std::string>()) +
               "</li>";
    }
  }
  if (html.empty() && found.empty()) {
    return Absent(
        "No method with modes ran (imm, imm_smoother, robust_batch).");
  }
  if (!found.empty()) found = "<ul>" + found + "</ul>\n";
  return found + "<div class=\"grid\">" + html + "</div>\n";
}

std::string ConstantPanel(ReportContext* context) {
  HtmlTable table({"constant", "value", "sigma", "unit", "prior sigma",
                   "verdict", "what would help"});
  const Json constants =
      context->BestSummary().value("constants", Json::object());
  for (const auto& item : constants.items()) {
    const Json& c = item.value();
    const std::string unit = TextOf(c, "unit");
    const bool angle = unit.starts_with("rad");
    const double one = angle ? kDegree : 1.0;
    const auto figure = [&](const char* key, const char* format) {
      if (!c.contains(key)) return std::string();
      const Json value = {{"x", c[key].get<double>() / one}};
      return NumberOf(value, "x", format);
    };
    table.AddRow(
        {item.key(), figure("value", "{:.5g}"), figure("sigma", "{:.3g}"),
         angle ? "deg" + unit.substr(3) : unit, figure("prior_sigma", "{:.3g}"),
         TextOf(c, "verdict"), TextOf(c, "advice")});
  }
  if (table.empty()) return Absent("No constant was estimated.");
  return Element("p", "Of " + context->best().label + ".") + table.Render();
}

std::string ConfigPanel(ReportContext* context) {
  std::string html;
  for (const ReportSource& source : context->sources) {
    const std::string datum = TextOf(source.summary, "datum");
    html += Element("p", TextOf(source.summary, "program") + ", results in " +
                             source.shown.string() +
                             (datum.empty() ? "" : "; datum: " + datum));
    html += InputTable(source.summary);
    if (source.config.empty()) {
      html += Absent("There is no config.resolved.yaml of this run.");
      continue;
    }
    html += "<details" +
            std::string(context->sources.size() == 1 ? " open" : "") +
            "><summary>Configuration as used, in SI units</summary><pre>" +
            EscapeHtml(source.config) + "</pre></details>\n";
  }
  return html;
}

}  // namespace hindsight
