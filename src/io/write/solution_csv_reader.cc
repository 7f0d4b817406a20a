#include <Eigen/LU>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>

#include "base/error.h"
#include "base/units.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "io/read/npz.h"
#include "io/read/solution_columns.h"
#include "io/read/text_lines.h"
#include "io/read/units.h"
#include "io/write/number_format.h"
#include "io/write/solution_csv.h"
#include "state/euler_error.h"

namespace hindsight {
namespace {

/// A column of the file that is read.
struct Field {
  std::size_t index = 0;
  double si = 1.0;  ///< the file's unit in SI
};

struct Header {
  std::size_t width = 0;
  Field time;
  /// The groups present, their fields in the order of Columns().
  std::map<ColumnGroup, std::vector<Field>> groups;
};

/// A line or row of the file being read, for messages.
struct Place {
  const std::string& path;
  long line;
  std::string row = {};  ///< "row 3: " where there are no lines

  [[noreturn]] void Fail(const std::string& message) const {
    throw InputError(path, line, row + message);
  }
};

void SplitFields(std::string_view line, std::vector<std::string_view>* fields) {
  fields->clear();
  while (true) {
    const std::size_t comma = line.find(',');
    fields->push_back(Trim(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

/// The column `column.name` with any unit that can be converted, or nothing.
/// Throws for a unit that cannot, and for a column that is there twice.
std::optional<Field> FindColumn(const std::vector<std::string_view>& cells,
                                const SolutionColumn& column,
                                const Place& place) {
  const std::string start = column.name + "[";
  std::optional<Field> found;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string_view cell = cells[i];
    if (!cell.starts_with(start) || !cell.ends_with(']')) continue;
    if (found) place.Fail("column " + std::string(cell) + " appears twice");
    const std::string_view unit =
        cell.substr(start.size(), cell.size() - start.size() - 1);
    std::optional<double> si;
    if (unit == column.unit) {
      si = column.si;
    } else if (column.quantity) {
      si = UnitFactor(unit, *column.quantity);
    }
    if (!si) {
      place.Fail("column " + std::string(cell) + ": expected the unit [" +
                 column.unit + "]");
    }
    found = Field{i, *si};
  }
  return found;
}

Header ParseHeader(const std::vector<std::string_view>& cells,
                   const Place& place) {
  Header header;
  header.width = cells.size();
  const std::optional<Field> time = FindColumn(cells, TimeColumn(), place);
  if (!time) {
    place.Fail(
        "no column t[s]; expected a header line such as "
        "t[s],lat[deg],lon[deg],h[m],...");
  }
  header.time = *time;
  for (int i = 0; i < kColumnGroups; ++i) {
    const auto group = static_cast<ColumnGroup>(i);
    std::vector<Field> fields;
    std::string missing;
    for (const SolutionColumn& column : Columns(group)) {
      if (const auto field = FindColumn(cells, column, place)) {
        fields.push_back(*field);
      } else {
        missing = column.Heading();
      }
    }
    if (fields.empty()) continue;
    if (!missing.empty()) {
      place.Fail("column " + missing + " is missing beside " +
                 std::string(cells[fields.front().index]));
    }
    header.groups.emplace(group, fields);
  }
  return header;
}

double ParseField(std::string_view text, const Place& place) {
  const std::optional<double> value = ParseNumber(text);
  if (!value) {
    place.Fail("'" + std::string(text) + "' is not a finite number");
  }
  return *value;
}

using EpochRow = std::map<ColumnGroup, GroupValues>;

const GroupValues* Find(const EpochRow& row, ColumnGroup group) {
  const auto found = row.find(group);
  return found == row.end() ? nullptr : &found->second;
}

/// From standard deviations and, if they are there, cross terms.
void AppendCovariance(const EpochRow& row, ColumnGroup sd, ColumnGroup cross,
                      std::vector<Eigen::Matrix3d>* out) {
  const GroupValues* sigma = Find(row, sd);
  if (sigma == nullptr) return;
  Eigen::Matrix3d P = sigma->head<3>().cwiseAbs2().asDiagonal();
  if (const GroupValues* c = Find(row, cross)) {
    P(0, 1) = P(1, 0) = (*c)(0);
    P(0, 2) = P(2, 0) = (*c)(1);
    P(1, 2) = P(2, 1) = (*c)(2);
  }
  out->push_back(P);
}

void AppendAttitudeCovariance(const EpochRow& row, SolutionTable* table) {
  const GroupValues* sigma = Find(row, ColumnGroup::kSdAttitude);
  if (sigma != nullptr) table->sigma_euler.emplace_back(sigma->head<3>());
  if (const GroupValues* c = Find(row, ColumnGroup::kCovAttitude)) {
    Eigen::Matrix3d P;
    P << (*c)(0), (*c)(1), (*c)(2),  //
        (*c)(1), (*c)(3), (*c)(4),   //
        (*c)(2), (*c)(4), (*c)(5);
    table->P_attitude.push_back(P);
    return;
  }
  const GroupValues* euler = Find(row, ColumnGroup::kAttitude);
  if (sigma == nullptr || euler == nullptr) return;
  const Eigen::Matrix3d J = EulerErrorJacobian(euler->head<3>()).inverse();
  table->P_attitude.emplace_back(J * sigma->head<3>().cwiseAbs2().asDiagonal() *
                                 J.transpose());
}

void AppendRow(double t, const EpochRow& row, SolutionTable* table) {
  table->t.push_back(t);
  if (const GroupValues* g = Find(row, ColumnGroup::kPosition)) {
    table->p_e.push_back(EcefFromGeodetic({(*g)(0), (*g)(1), (*g)(2)}));
  }
  const Eigen::Matrix3d C_en = table->C_en(table->size() - 1);
  if (const GroupValues* v = Find(row, ColumnGroup::kVelocity)) {
    table->v_e.emplace_back(C_en * v->head<3>());
  }
  if (const GroupValues* e = Find(row, ColumnGroup::kAttitude)) {
    table->q_eb.push_back((Eigen::Quaterniond(C_en) *
                           QuaternionFromEuler((*e)(0), (*e)(1), (*e)(2)))
                              .normalized());
  }
  const auto append = [&row](ColumnGroup group,
                             std::vector<Eigen::Vector3d>* out) {
    if (const GroupValues* v = Find(row, group)) out->push_back(v->head<3>());
  };
  append(ColumnGroup::kGyroBias, &table->b_g);
  append(ColumnGroup::kAccelBias, &table->b_a);
  append(ColumnGroup::kSdGyroBias, &table->sigma_b_g);
  append(ColumnGroup::kSdAccelBias, &table->sigma_b_a);
  AppendCovariance(row, ColumnGroup::kSdPosition, ColumnGroup::kCovPosition,
                   &table->P_position);
  AppendCovariance(row, ColumnGroup::kSdVelocity, ColumnGroup::kCovVelocity,
                   &table->P_velocity);
  AppendAttitudeCovariance(row, table);
}

/// One row; `text` and `number` give those of its field `index`.
template <typename Text, typename Number>
void ParseRow(const Header& header, const Place& place, const Text& text,
              const Number& number, SolutionTable* table) {
  const double t = number(header.time.index) * header.time.si;
  if (!table->t.empty() && t <= table->t.back()) {
    place.Fail("time " + text(header.time.index) +
               " is not after the one before");
  }
  EpochRow row;
  for (const auto& [group, fields] : header.groups) {
    GroupValues values = GroupValues::Zero();
    Eigen::Index i = 0;
    for (const Field& field : fields) {
      values(i++) = number(field.index) * field.si;
    }
    if (group == ColumnGroup::kPosition) {
      const auto why = WhyNotNearEarth({values(0), values(1), values(2)});
      if (why) place.Fail(*why);
    }
    row.emplace(group, values);
  }
  AppendRow(t, row, table);
}

void ParseLine(const Header& header, const std::vector<std::string_view>& cells,
               const Place& place, SolutionTable* table) {
  if (cells.size() != header.width) {
    place.Fail(std::to_string(cells.size()) + " fields, expected " +
               std::to_string(header.width) + " as in the header");
  }
  ParseRow(
      header, place, [&](std::size_t i) { return std::string(cells[i]); },
      [&](std::size_t i) { return ParseField(cells[i], place); }, table);
}

SolutionTable ReadText(const std::string& path) {
  constexpr std::string_view kMethod = "# method: ";
  TextLines lines(path);
  SolutionTable table;
  Header header;
  std::vector<std::string_view> cells;
  for (std::string_view line; lines.Next(&line);) {
    const Place place{path, lines.number()};
    if (line.starts_with(kMethod)) table.method = line.substr(kMethod.size());
    if (Trim(line).empty() || line.starts_with('#')) continue;
    if (!lines.terminated()) {
      place.Fail("the last line has no line end: the file is cut off");
    }
    SplitFields(line, &cells);
    if (header.width == 0) {
      header = ParseHeader(cells, place);
    } else {
      ParseLine(header, cells, place, &table);
    }
  }
  if (table.t.empty()) {
    throw InputError(path, lines.number(),
                     "no epoch in the file; expected a header line such as "
                     "t[s],lat[deg],lon[deg],h[m],... and one line an epoch");
  }
  return table;
}

/// Its rows count from 1.
SolutionTable ReadArrays(const std::string& path) {
  const NamedColumns named = ReadNpz(path);
  std::vector<std::string> titles;
  std::vector<const std::vector<double>*> columns;
  for (const auto& [name, values] : named) {
    titles.push_back(HeadingOf(name));
    columns.push_back(&values);
  }
  const Header header =
      ParseHeader({titles.begin(), titles.end()}, Place{path, 0});
  SolutionTable table;
  table.method = std::filesystem::path(path).stem().string();
  for (std::size_t k = 0; k < columns.front()->size(); ++k) {
    const auto text = [&](std::size_t i) {
      return FormatGeneral((*columns[i])[k], 17);
    };
    const Place place{path, 0, "row " + std::to_string(k + 1) + ": "};
    const auto number = [&](std::size_t i) {
      const double value = (*columns[i])[k];
      if (!std::isfinite(value)) {
        place.Fail(titles[i] + " is not a finite number");
      }
      return value;
    };
    ParseRow(header, place, text, number, &table);
  }
  if (table.t.empty()) throw InputError(path, 0, "no epoch in the arrays");
  return table;
}

}  // namespace

SolutionTable ReadSolutionTable(const std::string& path) {
  return IsNpz(path) ? ReadArrays(path) : ReadText(path);
}

}  // namespace hindsight
