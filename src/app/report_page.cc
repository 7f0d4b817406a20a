#include "app/report_page.h"

#include <string_view>

#include "app/report_assets.h"
#include "app/report_panels.h"
#include "app/run_output.h"
#include "base/error.h"
#include "base/text.h"
#include "io/html.h"
#include "io/paths.h"

namespace hindsight {
namespace fs = std::filesystem;
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
    {"motion", "Motion", MotionPanel},
    {"differences", "Method against method", DifferencePanel},
    {"truth", "Error against truth", TruthPanel},
    {"modes", "Modes and receiver errors", ModePanel},
    {"constants", "Constants", ConstantPanel},
    {"config", "Configuration and inputs", ConfigPanel},
};

ReportContext ReadContext(const std::vector<ReportPlace>& places) {
  ReportContext context;
  for (const ReportPlace& place : places) {
    context.sources.push_back(ReadReportSource(place));
  }
  context.solutions = ReadReportSolutions(context.sources);
  if (context.solutions.empty() || context.solutions.front().source != 0) {
    throw InputError(context.reference().shown.string() +
                     ": no method has a solution");
  }
  const fs::path& folder = context.reference().folder;
  if (PathExists(folder / "residuals.csv")) {
    context.residuals = ReadResiduals((folder / "residuals.csv").string(),
                                      context.best().method);
  }
  if (PathExists(folder / "fixes.csv")) {
    context.fixes = ReadFixes((folder / "fixes.csv").string());
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

/// The page around its panels.
std::string Frame(const ReportContext& context, const std::string& contents,
                  const std::string& panels) {
  const std::string title = EscapeHtml(context.reference().Name());
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light "
      "dark\">\n<link rel=\"icon\" href=\"data:,\">\n<title>" +
      title + " \xE2\x80\x93 Hindsight</title>\n<style>" +
      Asset("dygraph.min.css") + Asset("style.css") +
      "</style>\n</head>\n<body>\n<header><p "
      "class=\"brand\">Hindsight</p><h1>" +
      title + "</h1><nav aria-label=\"Panels\">" + contents +
      "</nav></header>\n<div id=\"bar\" hidden></div>\n<main>\n" +
      "<noscript><p class=\"absent\">The charts need JavaScript; the tables "
      "stand without it.</p></noscript>\n" +
      panels + "</main>\n<footer>" + EscapeHtml(kProgram) + "</footer>\n";
  html += "<script type=\"application/json\" id=\"data\">" +
          ScriptJson(PageJson(context)) + "</script>\n" + context.data.Blobs();
  for (const char* script :
       {"dygraph.min.js", "series.js", "view.js", "lines.js", "charts.js",
        "map.js", "timeline.js", "page.js"}) {
    html += "<script>" + Asset(script) + "</script>\n";
  }
  return html + "</body>\n</html>\n";
}

}  // namespace

std::string ReportPage(const std::vector<ReportPlace>& places) {
  ReportContext context = ReadContext(places);
  try {
    AddSolutionSeries(&context);
    std::string contents;
    std::string panels;
    int number = 0;
    for (const Panel& panel : kPanels) {
      ++number;
      contents += Format("<a href=\"#%s\">%s</a> ", panel.id, panel.title);
      panels += Format("<section id=\"%s\"><h2><span>%d</span> %s</h2>\n",
                       panel.id, number, panel.title) +
                panel.body(&context) + "</section>\n";
    }
    return Frame(context, contents, panels);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(context.reference().shown.string() + "/" + kSummaryName, 0,
                     error.what());
  }
}

}  // namespace hindsight
