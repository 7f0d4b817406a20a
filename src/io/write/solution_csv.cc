#include "io/write/solution_csv.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "io/read/time_scale.h"
#include "io/write/column_csv.h"

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

void Put(const Eigen::Vector3d& v, GroupValues* to) { to->head<3>() = v; }

void PutSigmas(const Eigen::Matrix3d& P, GroupValues* to) {
  Put(P.diagonal().cwiseMax(0.0).cwiseSqrt(), to);
}

void PutCrossTerms(const Eigen::Matrix3d& P, GroupValues* to) {
  Put({P(0, 1), P(0, 2), P(1, 2)}, to);
}

/// The values of a group at row k, SI. C_en is that of the row.
GroupValues RowValues(const SolutionTable& table, std::size_t k,
                      const Eigen::Matrix3d& C_en, ColumnGroup group) {
  GroupValues values;
  GroupValues* to = &values;
  switch (group) {
    case ColumnGroup::kPosition: {
      const Geodetic g = GeodeticFromEcef(table.p_e[k]);
      Put({g.latitude, g.longitude, g.height}, to);
      break;
    }
    case ColumnGroup::kVelocity:
      Put(C_en.transpose() * table.v_e[k], to);
      break;
    case ColumnGroup::kAttitude:
      Put(EulerFromQuaternion(Eigen::Quaterniond(C_en).conjugate() *
                              table.q_eb[k]),
          to);
      break;
    case ColumnGroup::kSdPosition:
      PutSigmas(table.P_position[k], to);
      break;
    case ColumnGroup::kSdVelocity:
      PutSigmas(table.P_velocity[k], to);
      break;
    case ColumnGroup::kSdAttitude:
      Put(table.sigma_euler[k], to);
      break;
    case ColumnGroup::kGyroBias:
      Put(table.b_g[k], to);
      break;
    case ColumnGroup::kAccelBias:
      Put(table.b_a[k], to);
      break;
    case ColumnGroup::kSdGyroBias:
      Put(table.sigma_b_g[k], to);
      break;
    case ColumnGroup::kSdAccelBias:
      Put(table.sigma_b_a[k], to);
      break;
    case ColumnGroup::kCovPosition:
      PutCrossTerms(table.P_position[k], to);
      break;
    case ColumnGroup::kCovVelocity:
      PutCrossTerms(table.P_velocity[k], to);
      break;
    case ColumnGroup::kCovAttitude: {
      const Eigen::Matrix3d& P = table.P_attitude[k];
      values << P(0, 0), P(0, 1), P(0, 2), P(1, 1), P(1, 2), P(2, 2);
      break;
    }
  }
  return values;
}

/// Of attitude alone, whose axes are no more than Euler angles tell.
bool HasQuaternion(const SolutionTable& table) {
  return table.p_e.empty() && !table.q_eb.empty();
}

/// A quantity that may not exist at a row.
double FiniteOrNan(double value) {
  return std::isfinite(value) ? value
                              : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::string SolutionComments(const SolutionTable& table,
                             const std::string& program,
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

std::vector<SolutionColumn> ColumnsOf(const SolutionTable& table) {
  std::vector<SolutionColumn> columns = {TimeColumn()};
  const auto add = [&columns](const std::vector<SolutionColumn>& more) {
    columns.insert(columns.end(), more.begin(), more.end());
  };
  for (int i = 0; i < kColumnGroups; ++i) {
    const auto group = static_cast<ColumnGroup>(i);
    if (HasGroup(table, group)) add(Columns(group));
  }
  if (!table.separation.empty()) columns.push_back(SeparationColumn());
  if (!table.separations.empty()) add(SeparationColumns());
  if (HasQuaternion(table)) add(QuaternionColumns());
  if (!table.accel_sigma.empty()) columns.push_back(AccelSigmaColumn());
  if (!table.magnetic.empty()) columns.push_back(MagneticColumn());
  return columns;
}

Eigen::MatrixXd RowsOf(const SolutionTable& table,
                       const std::vector<SolutionColumn>& columns,
                       std::size_t begin, std::size_t end) {
  constexpr std::size_t kRowsOfThread = 256;
  std::vector<std::pair<ColumnGroup, Eigen::Index>> groups;
  for (int i = 0; i < kColumnGroups; ++i) {
    const auto group = static_cast<ColumnGroup>(i);
    if (!HasGroup(table, group)) continue;
    groups.emplace_back(group,
                        static_cast<Eigen::Index>(Columns(group).size()));
  }
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(end - begin),
                       static_cast<Eigen::Index>(columns.size()));
  const auto fill = [&](std::size_t k) {
    auto row = rows.row(static_cast<Eigen::Index>(k - begin));
    const Eigen::Matrix3d C_en = table.C_en(k);
    Eigen::Index at = 0;
    row(at++) = table.t[k];
    for (const auto& [group, size] : groups) {
      const GroupValues values = RowValues(table, k, C_en, group);
      row.segment(at, size) = values.head(size).transpose();
      at += size;
    }
    if (!table.separation.empty()) {
      row(at++) = FiniteOrNan(table.separation[k]);
    }
    if (!table.separations.empty()) {
      const FilterSeparation& both = table.separations[k];
      for (const auto* values : {&both.difference, &both.sigma}) {
        for (const double value : *values) row(at++) = FiniteOrNan(value);
      }
    }
    if (HasQuaternion(table)) {
      const Eigen::Quaterniond q_nb = table.q_nb(k);
      row.segment<4>(at) << q_nb.w(), q_nb.x(), q_nb.y(), q_nb.z();
      at += 4;
    }
    if (!table.accel_sigma.empty()) {
      row(at++) = FiniteOrNan(table.accel_sigma[k]);
    }
    if (!table.magnetic.empty()) row(at++) = table.magnetic[k];
  };
  ForRanges(end - begin, kRowsOfThread, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = begin + from; k < begin + to; ++k) fill(k);
  });
  Eigen::Index i = 0;
  for (const SolutionColumn& column : columns) rows.col(i++) /= column.si;
  return rows;
}

void WriteSolutionCsv(const std::string& path, const SolutionTable& table,
                      const std::string& program,
                      std::optional<std::int64_t> epoch_gps_ns) {
  const std::vector<SolutionColumn> columns = ColumnsOf(table);
  ColumnCsv file(path, SolutionComments(table, program, epoch_gps_ns), columns);
  for (std::size_t k = 0; k < table.size(); k += kRowsOfPiece) {
    file.Append(
        RowsOf(table, columns, k, std::min(k + kRowsOfPiece, table.size())));
  }
  file.Commit();
}

}  // namespace hindsight
