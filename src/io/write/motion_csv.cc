#include "io/write/motion_csv.h"

#include "io/read/time_scale.h"

namespace hindsight {

std::vector<SolutionColumn> MotionFileColumns() {
  std::vector<SolutionColumn> columns = {TimeColumn()};
  columns.insert(columns.end(), MotionColumns().begin(), MotionColumns().end());
  return columns;
}

Eigen::MatrixXd MotionRows(std::span<const double> t,
                           std::span<const Kinematics> motion) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(t.size()), 7);
  for (std::size_t k = 0; k < t.size(); ++k) {
    rows.row(static_cast<Eigen::Index>(k)) << t[k],
        motion[k].w_ib_b.transpose(), motion[k].f_b.transpose();
  }
  Eigen::Index i = 1;
  for (const SolutionColumn& column : MotionColumns()) {
    rows.col(i++) /= column.si;
  }
  return rows;
}

std::string MotionComments(const std::string& program,
                           std::optional<std::int64_t> epoch_gps_ns) {
  return "# program: " + program + "\n" + EpochComment(epoch_gps_ns) +
         "# w: body rate against inertial space, f: specific force, body "
         "axes forward-right-down, biases and scale factors removed; means "
         "from half way to the row before to half way to the next\n";
}

}  // namespace hindsight
