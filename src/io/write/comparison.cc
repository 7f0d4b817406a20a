#include "io/write/comparison.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/units.h"
#include "io/write/number_format.h"
#include "io/write/table.h"

namespace hindsight {
namespace {

/// Decimals that show at least three significant digits of a figure, up to
/// four.
std::string Cell(std::optional<double> value) {
  if (!value || !std::isfinite(*value)) return "";
  const double size = std::abs(*value);
  return FormatFixed(*value, size >= 100.0  ? 1
                             : size >= 10.0 ? 2
                             : size >= 1.0  ? 3
                                            : 4);
}

/// Sensors that any method has residuals of, in order of appearance.
std::vector<std::string> Sensors(const RunSummary& summary) {
  std::vector<std::string> names;
  for (const MethodSummary& m : summary.methods) {
    for (const ResidualStatistics& s : m.residuals) {
      if (std::find(names.begin(), names.end(), s.sensor) == names.end()) {
        names.push_back(s.sensor);
      }
    }
  }
  return names;
}

/// Of one sensor; null if the method has none.
const ResidualStatistics* ResidualsOf(const MethodSummary& m,
                                      const std::string& sensor) {
  for (const ResidualStatistics& s : m.residuals) {
    if (s.sensor == sensor) return &s;
  }
  return nullptr;
}

void AppendOutageCells(const MethodSummary& m, std::vector<std::string>* row) {
  const auto e = PoolOutageErrors(m.outages, PositionKind());
  row->push_back(e ? Cell(e->horizontal_rms) : "");
  row->push_back(e ? Cell(e->horizontal_max) : "");
}

void AppendErrorCells(const MethodSummary& m, std::vector<std::string>* row) {
  const TrajectoryStatistics s = m.error.value_or(TrajectoryStatistics());
  row->push_back(s.position ? Cell(s.position->horizontal.rms) : "");
  row->push_back(s.position ? Cell(s.position->horizontal.max) : "");
  row->push_back(s.position ? Cell(s.position->axis[2].rms) : "");
  row->push_back(Cell(s.final_horizontal));
  row->push_back(s.velocity ? Cell(s.velocity->total.rms) : "");
  for (std::size_t i = 0; i < 3; ++i) {
    row->push_back(s.attitude ? Cell(s.attitude->axis[i].rms / kDegree) : "");
  }
  row->push_back(Cell(s.position_nees));
  row->push_back(Cell(s.velocity_nees));
  row->push_back(Cell(s.attitude_nees));
}

/// Of attitude alone.
void AppendAttitudeCells(const MethodSummary& m,
                         std::vector<std::string>* row) {
  const BroadError e = m.broad.value_or(BroadMetric()).rms;
  for (const double angle : {e.total, e.heading, e.inclination}) {
    row->push_back(m.broad ? FormatFixed(angle / kDegree, 3) : "");
  }
  row->push_back(m.field_disturbed ? FormatFixed(100.0 * *m.field_disturbed, 1)
                                   : "");
}

void AddStatisticsRow(const std::string& name, const ErrorStatistics& s,
                      double unit, ReportTable* table) {
  table->AddRow({name, Cell(s.rms / unit), Cell(s.std / unit),
                 Cell(s.mean / unit), Cell(s.p50 / unit), Cell(s.p68 / unit),
                 Cell(s.p95 / unit), Cell(s.p99 / unit), Cell(s.max / unit)});
}

void AddVectorRows(const VectorErrorStatistics& s, const std::string& name,
                   const std::string& unit, ReportTable* table) {
  const char* axes[] = {"north", "east", "down"};
  for (std::size_t i = 0; i < 3; ++i) {
    AddStatisticsRow(name + " " + axes[i] + " [" + unit + "]", s.axis[i], 1.0,
                     table);
  }
  AddStatisticsRow(name + " horizontal [" + unit + "]", s.horizontal, 1.0,
                   table);
  AddStatisticsRow(name + " 3-D [" + unit + "]", s.total, 1.0, table);
}

}  // namespace

std::string ComparisonTable(const RunSummary& summary,
                            const TableStyle& style) {
  std::vector<std::string> heading = {"method",
                                      "outage\nhoriz.\nrms [m]",
                                      "outage\nhoriz.\nmax [m]",
                                      "truth\nhoriz.\nrms [m]",
                                      "truth\nhoriz.\nmax [m]",
                                      "truth\ndown\nrms [m]",
                                      "truth\nend\nhor. [m]",
                                      "velocity\nrms\n[m/s]",
                                      "roll\nrms\n[deg]",
                                      "pitch\nrms\n[deg]",
                                      "heading\nrms\n[deg]",
                                      "NEES\npos.\n(3)",
                                      "NEES\nvel.\n(3)",
                                      "NEES\natt.\n(3)",
                                      "total\nRMSE\n[deg]",
                                      "heading\nRMSE\n[deg]",
                                      "inclin.\nRMSE\n[deg]",
                                      "field\ndist.\n[%]"};
  heading.insert(heading.end(), {"iter.", "time\n[s]", "peak\n[MB]", "grade"});
  ReportTable table(heading);
  for (const MethodSummary& m : summary.methods) {
    std::vector<std::string> row = {m.method};
    AppendOutageCells(m, &row);
    AppendErrorCells(m, &row);
    AppendAttitudeCells(m, &row);
    row.push_back(m.iterations > 0 ? std::to_string(m.iterations) : "");
    row.push_back(FormatFixed(m.seconds, 3));
    row.push_back(m.peak_rss_mb ? FormatFixed(*m.peak_rss_mb, 0) : "");
    row.emplace_back(GradeName(m.grade));
    table.AddRow(row);
  }
  return table.Render(style);
}

std::string ResidualOverview(const RunSummary& summary,
                             const TableStyle& style) {
  std::vector<std::string> heading = {"residuals\nover sigma, rms", "measured",
                                      "rejected"};
  for (const MethodSummary& m : summary.methods) heading.push_back(m.method);
  ReportTable table(heading);
  for (const std::string& sensor : Sensors(summary)) {
    std::vector<std::string> row = {sensor, "", ""};
    for (const MethodSummary& m : summary.methods) {
      const ResidualStatistics* s = ResidualsOf(m, sensor);
      row.push_back(s == nullptr ? "" : Cell(s->normalized_rms));
      if (s == nullptr || (m.method != summary.best && !row[1].empty())) {
        continue;
      }
      row[1] = std::to_string(s->count);
      row[2] = std::to_string(s->rejected);
    }
    table.AddRow(row);
  }
  const std::string text = table.Render(style);
  return Sensors(summary).empty() ? "" : text;
}

std::string ErrorTable(const TrajectoryStatistics& s, const TableStyle& style) {
  ReportTable table({"error (truth - solution)", "RMS", "std", "mean", "50 %",
                     "68 %", "95 %", "99 %", "max"});
  if (s.position) AddVectorRows(*s.position, "position", "m", &table);
  if (s.velocity) AddVectorRows(*s.velocity, "velocity", "m/s", &table);
  if (s.attitude) {
    const char* angles[] = {"roll", "pitch", "heading"};
    for (std::size_t i = 0; i < 3; ++i) {
      AddStatisticsRow(std::string(angles[i]) + " [deg]", s.attitude->axis[i],
                       kDegree, &table);
    }
    AddStatisticsRow("tilt [deg]", s.attitude->tilt, kDegree, &table);
    AddStatisticsRow("rotation angle [deg]", s.attitude->total, kDegree,
                     &table);
  }
  std::string text = table.Render(style);
  text += "matched: " + std::to_string(s.matched_count) + " of " +
          std::to_string(s.truth_count) +
          (s.at_solution_rows
               ? " rows of the solution, to which the denser truth is "
                 "interpolated ("
               : " truth points (") +
          FormatFixed(s.matched_percent(), 2) + " %)\n";
  if (s.final_horizontal && s.distance && *s.distance > 0.0) {
    text += "horizontal error at the end " + Cell(s.final_horizontal) + " m, " +
            Cell(100.0 * *s.final_horizontal / *s.distance) + " % of " +
            FormatFixed(*s.distance, 0) + " m\n";
  }
  const auto add_nees = [&text](const char* name, std::optional<double> nees) {
    if (!nees) return;
    text += std::string("mean NEES ") + name +
            " (3 if consistent): " + FormatFixed(*nees, 3) + "\n";
  };
  add_nees("position", s.position_nees);
  add_nees("velocity", s.velocity_nees);
  add_nees("attitude", s.attitude_nees);
  return text;
}

}  // namespace hindsight
