#include "io/write/solution_csv.h"

#include <cmath>

#include "base/units.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "io/read/solution_columns.h"
#include "io/read/time_scale.h"
#include "io/write/atomic_file.h"
#include "io/write/number_format.h"

namespace hindsight {
namespace {

bool HasGroup(const SolutionTable& table, ColumnGroup group) {
  switch (group) {
    case ColumnGroup::kPosition:
      return !table.p_e.empty();
    case ColumnGroup::kVelocity:
      return !table.v_e.empty();
    case ColumnGroup::kAttitude:
      return !table.q_eb.empty();
    case ColumnGroup::kSdPosition:
    case ColumnGroup::kCovPosition:
      return !table.P_position.empty();
    case ColumnGroup::kSdVelocity:
    case ColumnGroup::kCovVelocity:
      return !table.P_velocity.empty();
    case ColumnGroup::kSdAttitude:
      return !table.sigma_euler.empty();
    case ColumnGroup::kCovAttitude:
      return !table.P_attitude.empty();
    case ColumnGroup::kGyroBias:
      return !table.b_g.empty();
    case ColumnGroup::kAccelBias:
      return !table.b_a.empty();
    case ColumnGroup::kSdGyroBias:
      return !table.sigma_b_g.empty();
    case ColumnGroup::kSdAccelBias:
      return !table.sigma_b_a.empty();
  }
  return false;
}

GroupValues Values(const Eigen::Vector3d& v) {
  GroupValues values = GroupValues::Zero();
  values.head<3>() = v;
  return values;
}

GroupValues Sigmas(const Eigen::Matrix3d& P) {
  return Values(P.diagonal().cwiseMax(0.0).cwiseSqrt());
}

GroupValues CrossTerms(const Eigen::Matrix3d& P) {
  return Values({P(0, 1), P(0, 2), P(1, 2)});
}

GroupValues RowValues(const SolutionTable& table, std::size_t k,
                      ColumnGroup group) {
  switch (group) {
    case ColumnGroup::kPosition: {
      const Geodetic g = GeodeticFromEcef(table.p_e[k]);
      return Values({g.latitude, g.longitude, g.height});
    }
    case ColumnGroup::kVelocity:
      return Values(table.C_en(k).transpose() * table.v_e[k]);
    case ColumnGroup::kAttitude:
      return Values(EulerFromQuaternion(table.q_nb(k)));
    case ColumnGroup::kSdPosition:
      return Sigmas(table.P_position[k]);
    case ColumnGroup::kSdVelocity:
      return Sigmas(table.P_velocity[k]);
    case ColumnGroup::kSdAttitude:
      return Values(table.sigma_euler[k]);
    case ColumnGroup::kGyroBias:
      return Values(table.b_g[k]);
    case ColumnGroup::kAccelBias:
      return Values(table.b_a[k]);
    case ColumnGroup::kSdGyroBias:
      return Values(table.sigma_b_g[k]);
    case ColumnGroup::kSdAccelBias:
      return Values(table.sigma_b_a[k]);
    case ColumnGroup::kCovPosition:
      return CrossTerms(table.P_position[k]);
    case ColumnGroup::kCovVelocity:
      return CrossTerms(table.P_velocity[k]);
    case ColumnGroup::kCovAttitude: {
      const Eigen::Matrix3d& P = table.P_attitude[k];
      GroupValues values;
      values << P(0, 0), P(0, 1), P(0, 2), P(1, 1), P(1, 2), P(2, 2);
      return values;
    }
  }
  return GroupValues::Zero();
}

/// The columns of FilterSeparation: differences, then standard deviations.
const std::vector<SolutionColumn>& SeparationColumns() {
  static const std::vector<SolutionColumn> kColumns = {
      {"separation_n", "m", 1.0, -9, {}},
      {"separation_e", "m", 1.0, -9, {}},
      {"separation_d", "m", 1.0, -9, {}},
      {"separation_v_n", "m/s", 1.0, -9, {}},
      {"separation_v_e", "m/s", 1.0, -9, {}},
      {"separation_v_d", "m/s", 1.0, -9, {}},
      {"separation_roll", "deg", kDegree, -9, {}},
      {"separation_pitch", "deg", kDegree, -9, {}},
      {"separation_heading", "deg", kDegree, -9, {}}};
  return kColumns;
}

std::string SeparationHeadings() {
  std::string text;
  for (const char* prefix : {"", "sd_"}) {
    for (const SolutionColumn& column : SeparationColumns()) {
      text += "," + (prefix + column.Heading());
    }
  }
  return text;
}

void AppendSeparation(const FilterSeparation& separation, std::string* line) {
  for (const auto* values : {&separation.difference, &separation.sigma}) {
    Eigen::Index i = 0;
    for (const SolutionColumn& column : SeparationColumns()) {
      *line += ',';
      const double value = (*values)(i++) / column.si;
      if (std::isfinite(value)) AppendGeneral(value, -column.digits, line);
    }
  }
}

std::string Comments(const SolutionTable& table, const std::string& program,
                     std::optional<std::int64_t> epoch_gps_ns) {
  return "# program: " + program + "\n# method: " + table.method + "\n" +
         EpochComment(epoch_gps_ns) +
         "# position: WGS-84, height above the ellipsoid; velocity over the "
         "Earth, north-east-down\n"
         "# attitude: body forward-right-down to north-east-down, "
         "Rz(heading) Ry(pitch) Rx(roll)\n"
         "# sd_: standard deviations; those of roll, pitch and heading are "
         "of these angles, at most 103.9 deg\n"
         "# bg, ba: gyro and accelerometer bias, measured minus true, body "
         "axes\n"
         "# cov_: covariances, north-east-down at the estimated position; psi "
         "is the rotation from the estimated to the true attitude in Earth "
         "axes\n" +
         (table.separations.empty()
              ? ""
              : "# separation_: forward filter with the epoch's measurements "
                "minus backward filter without, at the IMU; empty where the "
                "backward filter knows nothing\n") +
         (table.magnetic.empty()
              ? ""
              : "# q: body to north-east-down; accel_sigma: R in force as a "
                "standard deviation, empty where the accelerometer was not "
                "used; magnetic: 1 used, 0 no reading, -1 disturbed\n");
}

void AppendQuaternion(const Eigen::Quaterniond& q_nb, std::string* line) {
  constexpr int kDigits = 12;
  for (const double value : {q_nb.w(), q_nb.x(), q_nb.y(), q_nb.z()}) {
    *line += ',';
    AppendFixed(value, kDigits, line);
  }
}

/// An accelerometer that was not used has no R: its field stays empty.
void AppendAttitudeVerdicts(const SolutionTable& table, std::size_t k,
                            std::string* line) {
  constexpr int kDigits = 6;
  if (!table.accel_sigma.empty()) {
    *line += ',';
    if (std::isfinite(table.accel_sigma[k])) {
      AppendGeneral(table.accel_sigma[k], kDigits, line);
    }
  }
  if (!table.magnetic.empty()) {
    *line += ',' + std::to_string(table.magnetic[k]);
  }
}

}  // namespace

void WriteSolutionCsv(const std::string& path, const SolutionTable& table,
                      const std::string& program,
                      std::optional<std::int64_t> epoch_gps_ns) {
  AtomicFile file(path);
  std::vector<ColumnGroup> groups;
  std::string line = Comments(table, program, epoch_gps_ns) + "t[s]";
  for (int i = 0; i < kColumnGroups; ++i) {
    const auto group = static_cast<ColumnGroup>(i);
    if (!HasGroup(table, group)) continue;
    groups.push_back(group);
    for (const SolutionColumn& column : Columns(group)) {
      line += "," + column.Heading();
    }
  }
  if (!table.separation.empty()) line += ",separation[1]";
  if (!table.separations.empty()) line += SeparationHeadings();
  const bool quaternion = table.p_e.empty() && !table.q_eb.empty();
  if (quaternion) line += ",q_w[1],q_x[1],q_y[1],q_z[1]";
  if (!table.accel_sigma.empty()) line += ",accel_sigma[m/s^2]";
  if (!table.magnetic.empty()) line += ",magnetic[1]";
  file.Write(line + "\n");
  for (std::size_t k = 0; k < table.size(); ++k) {
    line.clear();
    AppendShortest(table.t[k], &line);
    for (const ColumnGroup group : groups) {
      const GroupValues values = RowValues(table, k, group);
      Eigen::Index i = 0;
      for (const SolutionColumn& column : Columns(group)) {
        line += ',';
        const double value = values(i++) / column.si;
        if (column.digits < 0) {
          AppendGeneral(value, -column.digits, &line);
        } else {
          AppendFixed(value, column.digits, &line);
        }
      }
    }
    if (!table.separation.empty()) {
      line += ',';
      constexpr int kSeparationDigits = 6;
      if (std::isfinite(table.separation[k])) {
        AppendGeneral(table.separation[k], kSeparationDigits, &line);
      }
    }
    if (!table.separations.empty()) {
      AppendSeparation(table.separations[k], &line);
    }
    if (quaternion) AppendQuaternion(table.q_nb(k), &line);
    AppendAttitudeVerdicts(table, k, &line);
    line += '\n';
    file.Write(line);
  }
  file.Commit();
}

}  // namespace hindsight
