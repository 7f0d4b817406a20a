#include "app/in_flight_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/finished_runs.h"
#include "base/text.h"
#include "base/units.h"
#include "io/table.h"
#include "simulation/in_flight_alignment.h"

namespace hindsight {
namespace {

using Json = nlohmann::ordered_json;

struct Figure {
  const char* key;    ///< in JSON
  const char* title;  ///< in CSV
  double (*get)(const ObserverCell& cell);
};

double Share(int count, const ObserverCell& cell) {
  return static_cast<double>(count) / cell.runs;
}

double OrNan(const ObserverCell& c, double value) {
  return c.escaped == c.runs ? std::nan("") : value;
}

bool HasEscapes(const ObserverCell& cell) { return cell.escaped > 0; }

constexpr Figure kFigures[] = {
    {"diverged", "diverged[1]",
     [](const ObserverCell& c) { return Share(c.diverged, c); }},
    {"escaped", "escaped[1]",
     [](const ObserverCell& c) { return Share(c.escaped, c); }},
    {"t_escape_s", "t_escape[s]",
     [](const ObserverCell& c) {
       return HasEscapes(c) ? c.t_escape : std::nan("");
     }},
    {"converged", "converged[1]",
     [](const ObserverCell& c) { return Share(c.converged, c); }},
    {"t_settled_50_s", "t_settled_50[s]",
     [](const ObserverCell& c) { return c.t_settled_50; }},
    {"t_settled_95_s", "t_settled_95[s]",
     [](const ObserverCell& c) { return c.t_settled_95; }},
    {"tilt_50_deg", "tilt_50[deg]",
     [](const ObserverCell& c) { return c.tilt_50 / kDegree; }},
    {"tilt_95_deg", "tilt_95[deg]",
     [](const ObserverCell& c) { return c.tilt_95 / kDegree; }},
    {"heading_50_deg", "heading_50[deg]",
     [](const ObserverCell& c) { return c.heading_50 / kDegree; }},
    {"heading_95_deg", "heading_95[deg]",
     [](const ObserverCell& c) { return c.heading_95 / kDegree; }},
    {"backed_off", "backed_off[1]",
     [](const ObserverCell& c) { return OrNan(c, c.backed_off); }},
    {"least_information", "least_information[1]",
     [](const ObserverCell& c) { return OrNan(c, c.least_information); }}};

constexpr Figure kLyapunov[] = {
    {"v_first", "v_first[1]",
     [](const ObserverCell& c) { return OrNan(c, c.lyapunov.v_first); }},
    {"v_last", "v_last[1]",
     [](const ObserverCell& c) { return OrNan(c, c.lyapunov.v_last); }},
    {"v_largest", "v_largest[1]",
     [](const ObserverCell& c) { return OrNan(c, c.lyapunov.v_largest); }},
    {"share_falling", "share_falling[1]",
     [](const ObserverCell& c) { return OrNan(c, c.lyapunov.share_falling); }},
    {"share_falling_early", "share_falling_early[1]",
     [](const ObserverCell& c) {
       return OrNan(c, c.lyapunov.share_falling_early);
     }},
    {"p_least", "p_least[1]",
     [](const ObserverCell& c) { return OrNan(c, c.lyapunov.p_least); }},
    {"p_largest", "p_largest[1]",
     [](const ObserverCell& c) { return OrNan(c, c.lyapunov.p_largest); }},
    {"radius_first_deg", "radius_first[deg]",
     [](const ObserverCell& c) {
       return OrNan(c, c.lyapunov.radius_first / kDegree);
     }},
    {"radius_largest_deg", "radius_largest[deg]", [](const ObserverCell& c) {
       return OrNan(c, c.lyapunov.radius_largest / kDegree);
     }}};

std::string Cell(const char* format, double value) {
  if (std::isnan(value)) return "";
  if (std::isinf(value)) return "never";
  std::string text(32, '\0');
  const int length = std::snprintf(text.data(), text.size(), format, value);
  text.resize(static_cast<std::size_t>(std::max(length, 0)));
  return text;
}

/// 12 and 95 % of something, "0.012  0.034".
std::string Pair(const char* format, double a, double b) {
  return Cell(format, a) + "  " + Cell(format, b);
}

std::vector<std::string> NameCells(const ObserverCell& cell) {
  return {cell.recording + ", " + cell.start + ", " + cell.rule,
          ErrorName(cell.error)};
}

std::string OutcomeTable(const std::vector<ObserverCell>& cells) {
  ReportTable table(
      {"velocity, start, rule", "error", "diverged\n[%]", "escaped\n[%]",
       "escape\nat [s]", "converged\n[%]", "settled after [s]\n50 %  95 %",
       "final tilt [deg]\n50 %  95 %", "final heading [deg]\n50 %  95 %",
       "backed\noff [%]", "least\ninform."});
  for (const ObserverCell& c : cells) {
    std::vector<std::string> row = NameCells(c);
    row.push_back(Cell("%.1f", 100.0 * Share(c.diverged, c)));
    row.push_back(HasEscapes(c) ? Cell("%.1f", 100.0 * Share(c.escaped, c))
                                : "");
    row.push_back(HasEscapes(c) ? Cell("%.2f", c.t_escape) : "");
    row.push_back(Cell("%.1f", 100.0 * Share(c.converged, c)));
    row.push_back(Pair("%.1f", c.t_settled_50, c.t_settled_95));
    row.push_back(Pair("%.3f", c.tilt_50 / kDegree, c.tilt_95 / kDegree));
    row.push_back(Pair("%.3f", c.heading_50 / kDegree, c.heading_95 / kDegree));
    const bool weighs = c.least_information < 1.0 || c.backed_off > 0.0;
    row.push_back(weighs ? Cell("%.1f", 100.0 * OrNan(c, c.backed_off)) : "");
    row.push_back(weighs ? Cell("%.2g", OrNan(c, c.least_information)) : "");
    table.AddRow(std::move(row));
  }
  return table.Render();
}

std::string LyapunovTable(const std::vector<ObserverCell>& cells) {
  ReportTable table({"velocity, start, rule", "error",
                     "V\nfirst  largest  last", "V fell [%]\nfirst 30 s  all",
                     "eigenvalues of P\nleast  largest",
                     "radius [deg]\nfirst  largest"});
  for (const ObserverCell& c : cells) {
    if (c.escaped == c.runs) continue;
    const LyapunovFigures& figures = c.lyapunov;
    std::vector<std::string> row = NameCells(c);
    row.push_back(Cell("%.3g", figures.v_first) + "  " +
                  Pair("%.3g", figures.v_largest, figures.v_last));
    row.push_back(Pair("%.0f", 100.0 * figures.share_falling_early,
                       100.0 * figures.share_falling));
    row.push_back(Pair("%.1e", figures.p_least, figures.p_largest));
    row.push_back(Pair("%.1e", figures.radius_first / kDegree,
                       figures.radius_largest / kDegree));
    table.AddRow(std::move(row));
  }
  return table.Render();
}

}  // namespace

std::string ObserverTable(const std::vector<ObserverCell>& cells) {
  const bool any_ends =
      std::any_of(cells.begin(), cells.end(),
                  [](const ObserverCell& c) { return c.escaped < c.runs; });
  if (!any_ends) return OutcomeTable(cells);
  return OutcomeTable(cells) +
         "\nV = e' P^-1 e, P in a priori standard deviations, radius of "
         "guaranteed decay:\n\n" +
         LyapunovTable(cells);
}

std::string ObserverJson(const std::vector<ObserverCell>& cells,
                         const MonteCarloOptions& options, bool complete) {
  Json json;
  json["scenario"] = kInFlightAlignmentName;
  json["complete"] = complete;
  json["runs"] = RunsOf(cells);
  json["runs_asked"] = options.runs;
  json["first_seed"] = options.first_seed;
  for (const ObserverCell& c : cells) {
    Json cell;
    cell["velocity"] = c.recording;
    cell["start"] = c.start;
    cell["rule"] = c.rule;
    cell["error"] = ErrorName(c.error);
    const auto add = [&c](const Figure& figure, Json* to) {
      const double value = figure.get(c);
      if (std::isfinite(value)) (*to)[figure.key] = value;
    };
    for (const Figure& figure : kFigures) add(figure, &cell);
    Json lyapunov = Json::object();
    for (const Figure& figure : kLyapunov) add(figure, &lyapunov);
    cell["lyapunov"] = std::move(lyapunov);
    json["cells"].push_back(std::move(cell));
  }
  return json.dump(2) + "\n";
}

std::string ObserverCsv(const std::vector<ObserverCell>& cells) {
  std::string text = "velocity,start,rule,error";
  for (const Figure& figure : kFigures) text += std::string(",") + figure.title;
  for (const Figure& figure : kLyapunov) {
    text += std::string(",") + figure.title;
  }
  text += '\n';
  for (const ObserverCell& c : cells) {
    text +=
        c.recording + "," + c.start + "," + c.rule + "," + ErrorName(c.error);
    const auto add = [&](const Figure& figure) {
      const double value = figure.get(c);
      text += std::isfinite(value) ? Format(",%.6g", value) : ",";
    };
    for (const Figure& figure : kFigures) add(figure);
    for (const Figure& figure : kLyapunov) add(figure);
    text += '\n';
  }
  return text;
}

}  // namespace hindsight
