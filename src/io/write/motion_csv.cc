#include "io/write/motion_csv.h"

#include "base/units.h"
#include "io/read/time_scale.h"
#include "io/write/atomic_file.h"
#include "io/write/number_format.h"

namespace hindsight {

void WriteMotionCsv(const std::string& path, const std::vector<double>& t,
                    const std::vector<Kinematics>& motion,
                    const std::string& program,
                    std::optional<std::int64_t> epoch_gps_ns) {
  constexpr int kRateDecimals = 6;
  constexpr int kForceDecimals = 6;
  AtomicFile file(path);
  file.Write("# program: " + program + "\n" + EpochComment(epoch_gps_ns) +
             "# w: body rate against inertial space, f: specific force, body "
             "axes forward-right-down, biases and scale factors removed; means "
             "from half way to the row before to half way to the next\n"
             "t[s],w_x[deg/s],w_y[deg/s],w_z[deg/s],f_x[m/s^2],f_y[m/s^2],"
             "f_z[m/s^2]\n");
  std::string line;
  for (std::size_t k = 0; k < t.size(); ++k) {
    line.clear();
    AppendShortest(t[k], &line);
    for (const double rate : motion[k].w_ib_b) {
      line += ',';
      AppendFixed(rate / kDegree, kRateDecimals, &line);
    }
    for (const double force : motion[k].f_b) {
      line += ',';
      AppendFixed(force, kForceDecimals, &line);
    }
    line += '\n';
    file.Write(line);
  }
  file.Commit();
}

}  // namespace hindsight
