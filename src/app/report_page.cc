#include "app/report_page.h"

#include <fmt/core.h>

#include <string_view>
#include <utility>

#include "app/report_assets.h"
#include "app/report_panels.h"
#include "app/run_output.h"
#include "base/error.h"
#include "io/read/input_file.h"
#include "io/write/html.h"

namespace hindsight {
namespace {

struct Panel {
  const char* id;
  const char* title;
  std::string (*body)(ReportContext*);
};

constexpr Panel kPanels[] = {
    {"verdict", "Verdict", VerdictPanel},
    {"timeline", "Streams over time", TimeLinePanel},
    {"map", "Map", MapPanel},
    {"accuracy", "Estimated accuracy", AccuracyPanel},
    {"separation", "Forward against backward", SeparationPanel},
    {"residuals", "Residuals", ResidualPanel},
    {"outages", "Outages", OutagePanel},
    {"receiver", "Receiver", ReceiverPanel},
    {"biases", "Biases and constants over time", BiasPanel},
    {"allan", "Noise at rest", AllanPanel},
    {"motion", "Motion", MotionPanel},
    {"differences", "Method against method", DifferencePanel},
    {"truth", "Error against truth", TruthPanel},
    {"modes", "Modes and receiver errors", ModePanel},
    {"constants", "Constants", ConstantPanel},
    {"config", "Configuration and inputs", ConfigPanel},
};

ReportContext ReadContext(std::vector<ReportSource> sources) {
  ReportContext context;
  context.sources = std::move(sources);
  context.solutions = ReadReportSolutions(context.sources);
  if (context.solutions.empty() || context.solutions.front().source != 0) {
    throw InputError(context.reference().shown.string() +
                     ": no method has a trajectory; expected a result of "
                     "'run' in which one has");
  }
  const ReportSource& reference = context.reference();
  if (const auto path = reference.FileOf("residuals.csv")) {
    context.residuals = ReadResiduals(path->string(), context.best().method);
  }
  if (const auto path = reference.FileOf("fixes.csv")) {
    context.fixes = ReadFixes(path->string());
  }
  return context;
}

nlohmann::ordered_json PageJson(const ReportContext& context) {
  nlohmann::ordered_json json = context.data.Json();
  for (const ReportSolution& solution : context.solutions) {
    json["groups"].push_back({{"label", solution.label},
                              {"forward", solution.forward},
                              {"table", solution.table},
                              {"samples", solution.samples}});
  }
  const auto& summary = context.reference().summary;
  if (summary.contains("epoch"))
    json["utc"] = summary["epoch"].value("utc", "");
  json["map"] = context.map;
  json["time_line"] = context.time_line;
  return json;
}

/// The text of a script or style, without the reference to its sources.
std::string Asset(std::string_view name) {
  for (const ReportAsset& asset : ReportAssets()) {
    if (asset.name != name) continue;
    const std::size_t mark = asset.text.find("# sourceMappingURL");
    const bool marked = mark != asset.text.npos && mark >= 2;
    return std::string(asset.text.substr(0, marked ? mark - 2 : mark));
  }
  return "";
}

/// What every page begins with.
constexpr std::string_view kPageBegin =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<meta name=\"generator\" content=\"Hindsight\">\n";

/// All of a page before its own: head, title, what stands under it.
std::string PageTop(const std::string& title, const std::string& under) {
  const std::string shown = EscapeHtml(title);
  return std::string(kPageBegin) +
         "<meta name=\"viewport\" content=\"width=device-width, "
         "initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light "
         "dark\">\n<link rel=\"icon\" href=\"data:,\">\n<title>" +
         shown + " \xE2\x80\x93 Hindsight</title>\n<style>" +
         Asset("dygraph.min.css") + Asset("style.css") +
         "</style>\n</head>\n<body>\n<header><p "
         "class=\"brand\">Hindsight</p><h1>" +
         shown + "</h1>" + under + "</header>\n";
}

std::string PageFoot() {
  return "<footer>" + EscapeHtml(kProgram) + "</footer>\n";
}

/// The page around its panels.
std::string Frame(const ReportContext& context, const std::string& contents,
                  const std::string& panels) {
  std::string html =
      PageTop(context.reference().Name(),
              "<nav aria-label=\"Panels\">" + contents + "</nav>") +
      "<div id=\"bar\" hidden></div>\n<main>\n"
      "<noscript><p class=\"absent\">The charts need JavaScript; the tables "
      "stand without it.</p></noscript>\n" +
      panels + "</main>\n" + PageFoot();
  html += "<script type=\"application/json\" id=\"data\">" +
          ScriptJson(PageJson(context)) + "</script>\n" + context.data.Blobs();
  for (const char* script :
       {"dygraph.min.js", "series.js", "view.js", "lines.js", "charts.js",
        "map.js", "timeline.js", "page.js"}) {
    html += "<script>" + Asset(script) + "</script>\n";
  }
  return html + "</body>\n</html>\n";
}

std::string PageOf(std::vector<ReportSource> sources) {
  ReportContext context = ReadContext(std::move(sources));
  try {
    AddSolutionSeries(&context);
    std::string contents;
    std::string panels;
    int number = 0;
    for (const Panel& panel : kPanels) {
      ++number;
      contents += fmt::format("<a href=\"#{}\">{}</a> ", panel.id, panel.title);
      panels += fmt::format("<section id=\"{}\"><h2><span>{}</span> {}</h2>\n",
                            panel.id, number, panel.title) +
                panel.body(&context) + "</section>\n";
    }
    return Frame(context, contents, panels);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(context.reference().shown.string() + "/" + kSummaryName, 0,
                     error.what());
  }
}

}  // namespace

std::string StaticPage(const std::string& title, const std::string& body) {
  return PageTop(title, "") + "<main>\n" + body + "</main>\n" + PageFoot() +
         "</body>\n</html>\n";
}

std::string ReportPage(const std::vector<ReportPlace>& places) {
  std::vector<ReportSource> sources;
  for (const ReportPlace& place : places) {
    sources.push_back(ReadReportSource(place));
  }
  return PageOf(std::move(sources));
}

std::string ReportPage(EvaluatedSolution evaluated) {
  return PageOf({SourceOf(std::move(evaluated))});
}

bool IsReportPage(const std::string& path) {
  std::string begin(kPageBegin.size(), '\0');
  begin.resize(InputFile(path).ReadAt(0, begin.data(), begin.size()));
  return begin == kPageBegin;
}

}  // namespace hindsight
