#include "io/read/solution_columns.h"

#include <map>

#include "base/units.h"

namespace hindsight {
namespace {

constexpr double kDegreePerHour = kDegree / kHour;

using Columns13 = std::array<std::vector<SolutionColumn>, kColumnGroups>;

Columns13 AllColumns() {
  return {{
      // 1e-13 deg is 1e-8 m on the ground.
      {{"lat", "deg", kDegree, 13, Quantity::kAngle},
       {"lon", "deg", kDegree, 13, Quantity::kAngle},
       {"h", "m", 1.0, 7, Quantity::kLength}},
      {{"v_n", "m/s", 1.0, 8, Quantity::kSpeed},  //
       {"v_e", "m/s", 1.0, 8, Quantity::kSpeed},
       {"v_d", "m/s", 1.0, 8, Quantity::kSpeed}},
      {{"roll", "deg", kDegree, 10, Quantity::kAngle},
       {"pitch", "deg", kDegree, 10, Quantity::kAngle},
       {"heading", "deg", kDegree, 10, Quantity::kAngle}},
      {{"sd_n", "m", 1.0, -12, Quantity::kLength},
       {"sd_e", "m", 1.0, -12, Quantity::kLength},
       {"sd_d", "m", 1.0, -12, Quantity::kLength}},
      {{"sd_v_n", "m/s", 1.0, -12, Quantity::kSpeed},
       {"sd_v_e", "m/s", 1.0, -12, Quantity::kSpeed},
       {"sd_v_d", "m/s", 1.0, -12, Quantity::kSpeed}},
      {{"sd_roll", "deg", kDegree, -12, Quantity::kAngle},
       {"sd_pitch", "deg", kDegree, -12, Quantity::kAngle},
       {"sd_heading", "deg", kDegree, -12, Quantity::kAngle}},
      {{"bg_x", "deg/h", kDegreePerHour, -12, Quantity::kAngularRate},
       {"bg_y", "deg/h", kDegreePerHour, -12, Quantity::kAngularRate},
       {"bg_z", "deg/h", kDegreePerHour, -12, Quantity::kAngularRate}},
      {{"ba_x", "m/s^2", 1.0, -12, Quantity::kAcceleration},
       {"ba_y", "m/s^2", 1.0, -12, Quantity::kAcceleration},
       {"ba_z", "m/s^2", 1.0, -12, Quantity::kAcceleration}},
      {{"sd_bg_x", "deg/h", kDegreePerHour, -12, Quantity::kAngularRate},
       {"sd_bg_y", "deg/h", kDegreePerHour, -12, Quantity::kAngularRate},
       {"sd_bg_z", "deg/h", kDegreePerHour, -12, Quantity::kAngularRate}},
      {{"sd_ba_x", "m/s^2", 1.0, -12, Quantity::kAcceleration},
       {"sd_ba_y", "m/s^2", 1.0, -12, Quantity::kAcceleration},
       {"sd_ba_z", "m/s^2", 1.0, -12, Quantity::kAcceleration}},
      {{"cov_p_ne", "m^2", 1.0, -12, {}},
       {"cov_p_nd", "m^2", 1.0, -12, {}},
       {"cov_p_ed", "m^2", 1.0, -12, {}}},
      {{"cov_v_ne", "m^2/s^2", 1.0, -12, {}},
       {"cov_v_nd", "m^2/s^2", 1.0, -12, {}},
       {"cov_v_ed", "m^2/s^2", 1.0, -12, {}}},
      {{"cov_psi_nn", "rad^2", 1.0, -12, {}},
       {"cov_psi_ne", "rad^2", 1.0, -12, {}},
       {"cov_psi_nd", "rad^2", 1.0, -12, {}},
       {"cov_psi_ee", "rad^2", 1.0, -12, {}},
       {"cov_psi_ed", "rad^2", 1.0, -12, {}},
       {"cov_psi_dd", "rad^2", 1.0, -12, {}}},
  }};
}

}  // namespace

const std::vector<SolutionColumn>& Columns(ColumnGroup group) {
  static const Columns13 all = AllColumns();
  return all[static_cast<std::size_t>(group)];
}

const SolutionColumn& TimeColumn() {
  static const SolutionColumn kColumn = {"t", "s", 1.0, 0, Quantity::kTime};
  return kColumn;
}

const SolutionColumn& SeparationColumn() {
  static const SolutionColumn kColumn = {"separation", "1", 1.0, -6, {}};
  return kColumn;
}

const std::vector<SolutionColumn>& SeparationColumns() {
  static const std::vector<SolutionColumn> kColumns = [] {
    std::vector<SolutionColumn> columns;
    for (const char* prefix : {"", "sd_"}) {
      const std::string stem = std::string(prefix) + "separation_";
      for (const char* axis : {"n", "e", "d"}) {
        columns.push_back({stem + axis, "m", 1.0, -9, {}});
      }
      for (const char* axis : {"n", "e", "d"}) {
        columns.push_back({stem + "v_" + axis, "m/s", 1.0, -9, {}});
      }
      for (const char* angle : {"roll", "pitch", "heading"}) {
        columns.push_back({stem + angle, "deg", kDegree, -9, {}});
      }
    }
    return columns;
  }();
  return kColumns;
}

const std::vector<SolutionColumn>& QuaternionColumns() {
  static const std::vector<SolutionColumn> kColumns = {
      {"q_w", "1", 1.0, 12, {}},
      {"q_x", "1", 1.0, 12, {}},
      {"q_y", "1", 1.0, 12, {}},
      {"q_z", "1", 1.0, 12, {}}};
  return kColumns;
}

const SolutionColumn& AccelSigmaColumn() {
  static const SolutionColumn kColumn = {"accel_sigma", "m/s^2", 1.0, -6, {}};
  return kColumn;
}

const SolutionColumn& MagneticColumn() {
  static const SolutionColumn kColumn = {"magnetic", "1", 1.0, 0, {}};
  return kColumn;
}

const std::vector<SolutionColumn>& MotionColumns() {
  static const std::vector<SolutionColumn> kColumns = {
      {"w_x", "deg/s", kDegree, 6, {}}, {"w_y", "deg/s", kDegree, 6, {}},
      {"w_z", "deg/s", kDegree, 6, {}}, {"f_x", "m/s^2", 1.0, 6, {}},
      {"f_y", "m/s^2", 1.0, 6, {}},     {"f_z", "m/s^2", 1.0, 6, {}}};
  return kColumns;
}

std::string HeadingOf(const std::string& name) {
  static const std::map<std::string, std::string> kHeadings = [] {
    std::map<std::string, std::string> headings;
    const auto add = [&headings](const std::vector<SolutionColumn>& columns) {
      for (const SolutionColumn& column : columns) {
        headings[column.name] = column.Heading();
      }
    };
    for (int i = 0; i < kColumnGroups; ++i) {
      add(Columns(static_cast<ColumnGroup>(i)));
    }
    add({TimeColumn(), SeparationColumn(), AccelSigmaColumn(),
         MagneticColumn()});
    add(SeparationColumns());
    add(QuaternionColumns());
    add(MotionColumns());
    return headings;
  }();
  const auto found = kHeadings.find(name);
  return found == kHeadings.end() ? name : found->second;
}

}  // namespace hindsight
