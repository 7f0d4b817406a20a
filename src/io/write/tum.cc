#include "io/write/tum.h"

#include "base/error.h"
#include "io/write/atomic_file.h"
#include "io/write/number_format.h"

namespace hindsight {
namespace {

constexpr int kTimeDecimals = 9;
constexpr int kPositionDecimals = 6;
constexpr int kQuaternionDecimals = 12;

}  // namespace

void WriteTum(const std::string& path, const SolutionTable& table,
              const std::string& remark) {
  if (table.p_e.empty() || table.q_eb.empty()) {
    throw EstimationError(path +
                          ": a TUM trajectory needs position and "
                          "attitude, which the solution lacks");
  }
  Eigen::Matrix3d C_enu_ned;
  C_enu_ned << 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0;
  const Eigen::Matrix3d C_ue = C_enu_ned * table.C_en(0).transpose();
  const Eigen::Quaterniond q_ue(C_ue);
  // Forward-left-up and forward-right-down differ by half a turn about x.
  const Eigen::Quaterniond q_frd_flu(0.0, 1.0, 0.0, 0.0);
  AtomicFile file(path);
  if (!remark.empty()) file.Write("# " + remark + "\n");
  std::string line;
  for (std::size_t k = 0; k < table.size(); ++k) {
    const Eigen::Vector3d p = C_ue * (table.p_e[k] - table.p_e[0]);
    Eigen::Quaterniond q = (q_ue * table.q_eb[k] * q_frd_flu).normalized();
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    line.clear();
    AppendFixed(table.t[k], kTimeDecimals, &line);
    for (const double x : p) {
      line += ' ';
      AppendFixed(x, kPositionDecimals, &line);
    }
    for (const double c : q.coeffs()) {
      line += ' ';
      AppendFixed(c, kQuaternionDecimals, &line);
    }
    line += '\n';
    file.Write(line);
  }
  file.Commit();
}

}  // namespace hindsight
