#include "io/write/error_csv.h"

#include <cmath>
#include <limits>

#include "base/units.h"
#include "io/read/time_scale.h"
#include "io/write/atomic_file.h"
#include "io/write/number_format.h"

namespace hindsight {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Appends one value to each of the columns from `*next` on.
void Append(const std::vector<double>& values, ErrorColumns* columns,
            std::size_t* next) {
  for (const double value : values) {
    (*columns)[(*next)++].values.push_back(value);
  }
}

std::vector<double> Three(const std::optional<Eigen::Vector3d>& v,
                          double unit) {
  if (!v) return {kNone, kNone, kNone};
  return {v->x() / unit, v->y() / unit, v->z() / unit};
}

std::optional<Eigen::Vector3d> Sigma(const std::vector<Eigen::Matrix3d>& P,
                                     std::size_t row) {
  if (row >= P.size()) return std::nullopt;
  return P[row].diagonal().cwiseSqrt();
}

}  // namespace

ErrorColumns ColumnsOf(const std::vector<TrajectoryError>& errors,
                       const SolutionTable& solution) {
  ErrorColumns columns;
  for (const char* title : {"t[s]",
                            "n[m]",
                            "e[m]",
                            "d[m]",
                            "v_n[m/s]",
                            "v_e[m/s]",
                            "v_d[m/s]",
                            "roll[deg]",
                            "pitch[deg]",
                            "heading[deg]",
                            "sd_n[m]",
                            "sd_e[m]",
                            "sd_d[m]",
                            "sd_v_n[m/s]",
                            "sd_v_e[m/s]",
                            "sd_v_d[m/s]",
                            "sd_roll[deg]",
                            "sd_pitch[deg]",
                            "sd_heading[deg]",
                            "nees_position[1]",
                            "nees_velocity[1]",
                            "nees_attitude[1]"}) {
    columns.push_back({title, {}});
  }
  std::size_t row = 0;
  for (const TrajectoryError& error : errors) {
    while (row + 1 < solution.t.size() && solution.t[row] < error.t) ++row;
    std::size_t next = 0;
    Append({error.t}, &columns, &next);
    Append(Three(error.position, 1.0), &columns, &next);
    Append(Three(error.velocity, 1.0), &columns, &next);
    Append(Three(error.euler, kDegree), &columns, &next);
    Append(Three(Sigma(solution.P_position, row), 1.0), &columns, &next);
    Append(Three(Sigma(solution.P_velocity, row), 1.0), &columns, &next);
    Append(Three(row < solution.sigma_euler.size()
                     ? std::optional(solution.sigma_euler[row])
                     : std::nullopt,
                 kDegree),
           &columns, &next);
    Append({error.position_nees.value_or(kNone),
            error.velocity_nees.value_or(kNone),
            error.attitude_nees.value_or(kNone)},
           &columns, &next);
  }
  return columns;
}

void WriteErrorCsv(const std::string& path, const ErrorColumns& columns,
                   const std::string& program,
                   std::optional<std::int64_t> epoch_gps_ns) {
  constexpr int kDigits = 8;
  AtomicFile file(path);
  file.Write("# program: " + program + "\n" + EpochComment(epoch_gps_ns));
  std::string line = "# truth minus solution, sd_: as the solution says\n";
  for (const ErrorColumn& column : columns) {
    line += column.title + (&column == &columns.back() ? "\n" : ",");
  }
  file.Write(line);
  file.WriteLines(columns.front().values.size(),
                  [&columns](std::size_t row, std::string* out) {
                    AppendFixed(columns.front().values[row], 6, out);
                    for (std::size_t i = 1; i < columns.size(); ++i) {
                      *out += ',';
                      const double value = columns[i].values[row];
                      if (std::isfinite(value))
                        AppendGeneral(value, kDigits, out);
                    }
                    *out += '\n';
                  });
  file.Commit();
}

}  // namespace hindsight
