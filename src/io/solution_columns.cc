#include "io/solution_columns.h"

#include "base/units.h"

namespace hindsight {
namespace {

constexpr double kDegreePerHour = kDegree / kHour;

using Columns13 = std::array<std::vector<SolutionColumn>, kColumnGroups>;

Columns13 AllColumns() {
  return {{
      // 1e-13 deg is 1e-8 m on the ground.
      {{"lat", "deg", kDegree, 13},
       {"lon", "deg", kDegree, 13},
       {"h", "m", 1.0, 7}},
      {{"v_n", "m/s", 1.0, 8},  //
       {"v_e", "m/s", 1.0, 8},
       {"v_d", "m/s", 1.0, 8}},
      {{"roll", "deg", kDegree, 10},
       {"pitch", "deg", kDegree, 10},
       {"heading", "deg", kDegree, 10}},
      {{"sd_n", "m", 1.0, -12},
       {"sd_e", "m", 1.0, -12},
       {"sd_d", "m", 1.0, -12}},
      {{"sd_v_n", "m/s", 1.0, -12},
       {"sd_v_e", "m/s", 1.0, -12},
       {"sd_v_d", "m/s", 1.0, -12}},
      {{"sd_roll", "deg", kDegree, -12},
       {"sd_pitch", "deg", kDegree, -12},
       {"sd_heading", "deg", kDegree, -12}},
      {{"bg_x", "deg/h", kDegreePerHour, -12},
       {"bg_y", "deg/h", kDegreePerHour, -12},
       {"bg_z", "deg/h", kDegreePerHour, -12}},
      {{"ba_x", "m/s^2", 1.0, -12},
       {"ba_y", "m/s^2", 1.0, -12},
       {"ba_z", "m/s^2", 1.0, -12}},
      {{"sd_bg_x", "deg/h", kDegreePerHour, -12},
       {"sd_bg_y", "deg/h", kDegreePerHour, -12},
       {"sd_bg_z", "deg/h", kDegreePerHour, -12}},
      {{"sd_ba_x", "m/s^2", 1.0, -12},
       {"sd_ba_y", "m/s^2", 1.0, -12},
       {"sd_ba_z", "m/s^2", 1.0, -12}},
      {{"cov_p_ne", "m^2", 1.0, -12},
       {"cov_p_nd", "m^2", 1.0, -12},
       {"cov_p_ed", "m^2", 1.0, -12}},
      {{"cov_v_ne", "m^2/s^2", 1.0, -12},
       {"cov_v_nd", "m^2/s^2", 1.0, -12},
       {"cov_v_ed", "m^2/s^2", 1.0, -12}},
      {{"cov_psi_nn", "rad^2", 1.0, -12},
       {"cov_psi_ne", "rad^2", 1.0, -12},
       {"cov_psi_nd", "rad^2", 1.0, -12},
       {"cov_psi_ee", "rad^2", 1.0, -12},
       {"cov_psi_ed", "rad^2", 1.0, -12},
       {"cov_psi_dd", "rad^2", 1.0, -12}},
  }};
}

}  // namespace

const std::vector<SolutionColumn>& Columns(ColumnGroup group) {
  static const Columns13 all = AllColumns();
  return all[static_cast<std::size_t>(group)];
}

}  // namespace hindsight
