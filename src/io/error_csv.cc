#include "io/error_csv.h"

#include <cmath>

#include "base/units.h"
#include "io/atomic_file.h"
#include "io/number_format.h"
#include "io/time_scale.h"

namespace hindsight {
namespace {

constexpr int kErrorDigits = 8;

void AppendThree(const std::optional<Eigen::Vector3d>& values, double unit,
                 std::string* out) {
  for (int axis = 0; axis < 3; ++axis) {
    *out += ',';
    if (!values || !std::isfinite((*values)(axis))) continue;
    AppendGeneral((*values)(axis) / unit, kErrorDigits, out);
  }
}

void AppendOne(const std::optional<double>& value, std::string* out) {
  *out += ',';
  if (value && std::isfinite(*value)) {
    AppendGeneral(*value, kErrorDigits, out);
  }
}

std::optional<Eigen::Vector3d> Sigma(const std::vector<Eigen::Matrix3d>& P,
                                     std::size_t row) {
  if (row >= P.size()) return std::nullopt;
  return P[row].diagonal().cwiseSqrt();
}

}  // namespace

void WriteErrorCsv(const std::string& path,
                   const std::vector<TrajectoryError>& errors,
                   const SolutionTable& solution, const std::string& program,
                   std::optional<std::int64_t> epoch_gps_ns) {
  AtomicFile file(path);
  file.Write("# program: " + program + "\n" + EpochComment(epoch_gps_ns));
  file.Write(
      "# truth minus solution, sd_: as the solution says\n"
      "t[s],n[m],e[m],d[m],v_n[m/s],v_e[m/s],v_d[m/s],roll[deg],pitch[deg],"
      "heading[deg],sd_n[m],sd_e[m],sd_d[m],sd_v_n[m/s],sd_v_e[m/s],"
      "sd_v_d[m/s],sd_roll[deg],sd_pitch[deg],sd_heading[deg],"
      "nees_position[1],nees_velocity[1],nees_attitude[1]\n");
  std::string line;
  std::size_t row = 0;
  for (const TrajectoryError& error : errors) {
    while (row + 1 < solution.t.size() && solution.t[row] < error.t) ++row;
    line.clear();
    AppendFixed(error.t, 6, &line);
    AppendThree(error.position, 1.0, &line);
    AppendThree(error.velocity, 1.0, &line);
    AppendThree(error.euler, kDegree, &line);
    AppendThree(Sigma(solution.P_position, row), 1.0, &line);
    AppendThree(Sigma(solution.P_velocity, row), 1.0, &line);
    AppendThree(row < solution.sigma_euler.size()
                    ? std::optional(solution.sigma_euler[row])
                    : std::nullopt,
                kDegree, &line);
    AppendOne(error.position_nees, &line);
    AppendOne(error.velocity_nees, &line);
    AppendOne(error.attitude_nees, &line);
    line += '\n';
    file.Write(line);
  }
  file.Commit();
}

}  // namespace hindsight
