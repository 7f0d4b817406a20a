#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string_view>

#include "base/error.h"
#include "base/units.h"
#include "earth/wgs84.h"
#include "evaluation/euler_error.h"
#include "geometry/so3.h"
#include "io/solution_columns.h"
#include "io/solution_csv.h"

namespace hindsight {
namespace {

/// Where the columns of the file go.
struct Header {
  std::size_t width = 0;
  std::size_t time = 0;
  /// Column numbers of each group present, in the order of Columns().
  std::map<ColumnGroup, std::vector<std::size_t>> groups;
};

std::string ReadWholeFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw InputError(path, 0,
                     std::string("cannot be read: ") + std::strerror(errno));
  }
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

std::string_view Trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) {
    text.remove_prefix(1);
  }
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) {
    text.remove_suffix(1);
  }
  return text;
}

void SplitFields(std::string_view line, std::vector<std::string_view>* fields) {
  fields->clear();
  while (true) {
    const std::size_t comma = line.find(',');
    fields->push_back(Trim(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

/// Column number of `heading` in `names`, or width if it is not there. Throws
/// for a known name with another unit.
std::size_t FindColumn(const std::map<std::string, std::size_t>& names,
                       const std::string& name, const std::string& unit,
                       std::size_t width, const std::string& path, long line) {
  const auto exact = names.find(name + "[" + unit + "]");
  if (exact != names.end()) return exact->second;
  const auto other = names.lower_bound(name + "[");
  if (other != names.end() && other->first.starts_with(name + "[")) {
    throw InputError(path, line,
                     "column " + other->first +
                         " has another unit than the expected [" + unit + "]");
  }
  return width;
}

Header ParseHeader(const std::vector<std::string_view>& fields,
                   const std::string& path, long line) {
  Header header;
  header.width = fields.size();
  std::map<std::string, std::size_t> names;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (!names.emplace(fields[i], i).second) {
      throw InputError(path, line,
                       "column " + std::string(fields[i]) + " appears twice");
    }
  }
  header.time = FindColumn(names, "t", "s", header.width, path, line);
  if (header.time == header.width) {
    throw InputError(path, line,
                     "no column t[s]; expected a header line such as "
                     "t[s],lat[deg],lon[deg],h[m],...");
  }
  for (int i = 0; i < kColumnGroups; ++i) {
    const auto group = static_cast<ColumnGroup>(i);
    std::vector<std::size_t> columns;
    std::string missing;
    for (const SolutionColumn& column : Columns(group)) {
      columns.push_back(FindColumn(names, column.name, column.unit,
                                   header.width, path, line));
      if (columns.back() < header.width) continue;
      columns.pop_back();
      missing = column.Heading();
    }
    if (columns.empty()) continue;
    if (!missing.empty()) {
      throw InputError(path, line,
                       "column " + missing + " is missing beside " +
                           std::string(fields[columns.front()]));
    }
    header.groups.emplace(group, columns);
  }
  return header;
}

double ParseField(std::string_view field, const std::string& path, long line) {
  double value = 0.0;
  const auto [rest, error] =
      std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || rest != field.data() + field.size() ||
      !std::isfinite(value)) {
    throw InputError(path, line,
                     "'" + std::string(field) + "' is not a finite number");
  }
  return value;
}

using Row = std::map<ColumnGroup, GroupValues>;

const GroupValues* Find(const Row& row, ColumnGroup group) {
  const auto found = row.find(group);
  return found == row.end() ? nullptr : &found->second;
}

/// From standard deviations and, if they are there, cross terms.
void AppendCovariance(const Row& row, ColumnGroup sd, ColumnGroup cross,
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

void AppendAttitudeCovariance(const Row& row, SolutionTable* table) {
  if (const GroupValues* c = Find(row, ColumnGroup::kCovAttitude)) {
    Eigen::Matrix3d P;
    P << (*c)(0), (*c)(1), (*c)(2),  //
        (*c)(1), (*c)(3), (*c)(4),   //
        (*c)(2), (*c)(4), (*c)(5);
    table->P_attitude.push_back(P);
    return;
  }
  const GroupValues* sigma = Find(row, ColumnGroup::kSdAttitude);
  const GroupValues* euler = Find(row, ColumnGroup::kAttitude);
  if (sigma == nullptr || euler == nullptr) return;
  const Eigen::Matrix3d J = EulerErrorJacobian(euler->head<3>()).inverse();
  table->P_attitude.push_back(J * sigma->head<3>().cwiseAbs2().asDiagonal() *
                              J.transpose());
}

void AppendRow(double t, const Row& row, SolutionTable* table) {
  table->t.push_back(t);
  if (const GroupValues* g = Find(row, ColumnGroup::kPosition)) {
    table->p_e.push_back(EcefFromGeodetic({(*g)(0), (*g)(1), (*g)(2)}));
  }
  const Eigen::Matrix3d C_en = table->C_en(table->size() - 1);
  if (const GroupValues* v = Find(row, ColumnGroup::kVelocity)) {
    table->v_e.push_back(C_en * v->head<3>());
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

void ParseRow(const Header& header, const std::vector<std::string_view>& fields,
              const std::string& path, long line, SolutionTable* table) {
  if (fields.size() != header.width) {
    throw InputError(path, line,
                     std::to_string(fields.size()) + " fields, expected " +
                         std::to_string(header.width) + " as in the header");
  }
  const double t = ParseField(fields[header.time], path, line);
  if (!table->t.empty() && t <= table->t.back()) {
    throw InputError(path, line,
                     "time " + std::string(fields[header.time]) +
                         " s is not after that of the line before");
  }
  Row row;
  for (const auto& [group, columns] : header.groups) {
    GroupValues values = GroupValues::Zero();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      values(static_cast<Eigen::Index>(i)) =
          ParseField(fields[columns[i]], path, line) * Columns(group)[i].si;
    }
    if (group == ColumnGroup::kPosition && std::abs(values(0)) > 0.5 * kPi) {
      throw InputError(path, line,
                       "latitude " + std::string(fields[columns[0]]) +
                           " deg is beyond 90 deg");
    }
    row.emplace(group, values);
  }
  AppendRow(t, row, table);
}

}  // namespace

SolutionTable ReadSolutionCsv(const std::string& path) {
  const std::string text = ReadWholeFile(path);
  constexpr std::string_view kMethod = "# method: ";
  SolutionTable table;
  Header header;
  std::vector<std::string_view> fields;
  std::string_view rest = text;
  for (long number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.starts_with(kMethod)) table.method = line.substr(kMethod.size());
    if (Trim(line).empty() || line.starts_with('#')) continue;
    SplitFields(line, &fields);
    if (header.width == 0) {
      header = ParseHeader(fields, path, number);
    } else {
      ParseRow(header, fields, path, number, &table);
    }
  }
  if (table.t.empty()) {
    throw InputError(path, 0,
                     "holds no epoch; expected a header line such as "
                     "t[s],lat[deg],lon[deg],h[m],... and one line an epoch");
  }
  return table;
}

}  // namespace hindsight
