#include "app/montecarlo_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/text.h"
#include "base/units.h"
#include "io/number_format.h"
#include "io/table.h"

namespace hindsight {
namespace {

using Json = nlohmann::ordered_json;

Json Vector(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::string Metres(const Eigen::Vector3d& v) {
  return Format("%.3f %.3f %.3f", v.x(), v.y(), v.z());
}

/// The comparisons that say something about the methods, in reading order.
std::vector<std::pair<std::string, const Agreement*>> Comparisons(
    const MonteCarloResult& result) {
  const std::pair<const char*, const char*> wanted[] = {
      {"two_filter", "rts"},
      {"two_filter_conventional", "two_filter"},
      {"two_filter_euler", "two_filter"},
      {"iterated", "two_filter"},
      {"batch", "iterated"}};
  std::vector<std::pair<std::string, const Agreement*>> found;
  for (const auto& [a, b] : wanted) {
    for (const Agreement& agreement : result.agreements) {
      const bool same = agreement.first == a && agreement.second == b;
      const bool swapped = agreement.first == b && agreement.second == a;
      if (same || swapped) {
        found.emplace_back(std::string(a) + "_vs_" + b, &agreement);
      }
    }
  }
  return found;
}

}  // namespace

std::string GradesCell(const MethodStatistics& method) {
  return Format("%d, %d, %d", method.grades[0], method.grades[1],
                method.grades[2]);
}

std::string MonteCarloTable(const MonteCarloResult& result) {
  std::vector<std::string> heading = {"method", "max std [m]\nN E D"};
  std::size_t legs = 0;
  for (const MethodStatistics& m : result.methods) {
    legs = std::max(legs, m.legs.size());
  }
  for (std::size_t i = 1; i <= legs; ++i) {
    heading.push_back("leg " + std::to_string(i) + " [m]\nN E D");
  }
  for (const char* title :
       {"end [m]\nN E D", "yaw\n[deg]", "ANEES\nall", "ANEES\nleg 1",
        "outside\n[%]", "NIS\nper row", "failed", kGradesTitle, "s/run"}) {
    heading.emplace_back(title);
  }
  ReportTable table(heading);
  for (const MethodStatistics& m : result.methods) {
    if (m.t.empty()) continue;
    std::vector<std::string> row = {m.name, Metres(m.max_std)};
    for (const MethodStatistics::Leg& leg : m.legs) {
      row.push_back(Metres(leg.max_std));
    }
    for (const std::string& cell :
         {Metres(m.final_std), Format("%.4f", m.yaw_std / kDegree),
          Format("%.1f", m.anees), Format("%.1f", m.legs.front().anees),
          Format("%.1f", 100.0 * m.anees_outside), Format("%.3f", m.nis),
          m.failed > 0 ? std::to_string(m.failed) : std::string(),
          GradesCell(m), Format("%.3f", m.seconds)}) {
      row.push_back(cell);
    }
    table.AddRow(row);
  }
  return table.Render();
}

std::string AgreementText(const MonteCarloResult& result) {
  std::string text;
  for (const auto& [name, a] : Comparisons(result)) {
    text += Format("%-38s %.3g m, %.3g rad; after the first leg %.3g m\n",
                   name.c_str(), a->position, a->attitude,
                   a->position_after_first_leg);
  }
  return text;
}

std::string MonteCarloJson(const MonteCarloTitle& title,
                           const MonteCarloResult& result) {
  Json json;
  json["scenario"] = title.scenario;
  json["path"] = title.path;
  json["noise"] = title.noise;
  json["complete"] = title.complete;
  json["runs"] = result.runs;
  json["runs_asked"] = title.runs_asked;
  json["first_seed"] = title.first_seed;
  json["states"] = result.dim;
  json["methods"] = Json::object();
  for (const MethodStatistics& m : result.methods) {
    Json& method = json["methods"][m.name];
    method["failed"] = m.failed;
    for (std::size_t i = 0; i < m.grades.size(); ++i) {
      method["grades"][GradeName(static_cast<Grade>(i))] = m.grades[i];
    }
    if (m.t.empty()) continue;
    method["max_std_m"] = Vector(m.max_std);
    for (const MethodStatistics::Leg& leg : m.legs) {
      method["legs"].push_back(
          {{"max_std_m", Vector(leg.max_std)}, {"anees", leg.anees}});
    }
    method["final_std_m"] = Vector(m.final_std);
    method["yaw_std_deg"] = m.yaw_std / kDegree;
    method["anees"] = m.anees;
    method["anees_outside"] = m.anees_outside;
    method["nis"] = m.nis;
    method["seconds_per_run"] = m.seconds;
    for (const ConstantStatistics& c : m.constants) {
      method["constants"][c.name] = {
          {"unit", c.unit},         {"prior_sigma", c.prior_sigma},
          {"sigma", c.sigma},       {"rms", c.rms},
          {"anees", c.anees},       {"runs", c.runs},
          {"observed", c.observed}, {"unobserved", c.unobserved}};
    }
  }
  Json& agreement = json["agreement"] = Json::object();
  for (const auto& [name, a] : Comparisons(result)) {
    agreement[name + "_m"] = a->position;
    agreement[name + "_rad"] = a->attitude;
    agreement[name + "_after_first_leg_m"] = a->position_after_first_leg;
  }
  return json.dump(2) + "\n";
}

std::string MonteCarloCsv(const MethodStatistics& method) {
  constexpr int kDigits = 9;
  std::string text = "t[s],std_n[m],std_e[m],std_d[m],std_yaw[deg],anees[1]\n";
  for (std::size_t k = 0; k < method.t.size(); ++k) {
    AppendShortest(method.t[k], &text);
    for (const double value :
         {method.std_series[k].x(), method.std_series[k].y(),
          method.std_series[k].z(), method.yaw_series[k] / kDegree,
          method.anees_series[k]}) {
      text += ',';
      AppendGeneral(value, kDigits, &text);
    }
    text += '\n';
  }
  return text;
}

std::vector<OutputFile> MonteCarloFiles(const MonteCarloTitle& title,
                                        const MonteCarloResult& result) {
  std::vector<OutputFile> files = {
      {kMonteCarloJson, MonteCarloJson(title, result)}};
  for (const MethodStatistics& method : result.methods) {
    files.push_back({method.name + ".csv", MonteCarloCsv(method)});
  }
  return files;
}

}  // namespace hindsight
