#include "io/write/nav.h"

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "io/read/time_scale.h"
#include "io/write/atomic_file.h"
#include "io/write/number_format.h"

namespace hindsight {
namespace {

/// t = 0 is the beginning of week 0 if the clock has no date.
GpsWeekTime TimeAt(double t, std::optional<std::int64_t> epoch_gps_ns) {
  constexpr auto kWeek = static_cast<double>(kWeekSeconds);
  if (!epoch_gps_ns) return {0, t};
  GpsWeekTime time = GpsWeekOf(*epoch_gps_ns);
  time.seconds += t;
  const double weeks = std::floor(time.seconds / kWeek);
  time.week += static_cast<std::int64_t>(weeks);
  time.seconds -= weeks * kWeek;
  return time;
}

}  // namespace

void WriteNav(const std::string& path, const SolutionTable& table,
              std::optional<std::int64_t> epoch_gps_ns) {
  if (table.p_e.empty() || table.v_e.empty() || table.q_eb.empty()) {
    throw EstimationError(path +
                          ": a .nav file needs position, velocity and "
                          "attitude, which the solution lacks");
  }
  AtomicFile file(path);
  std::string line;
  for (std::size_t k = 0; k < table.size(); ++k) {
    const GpsWeekTime time = TimeAt(table.t[k], epoch_gps_ns);
    const Geodetic g = GeodeticFromEcef(table.p_e[k]);
    const Eigen::Vector3d v_n = table.C_en(k).transpose() * table.v_e[k];
    const Eigen::Vector3d euler = EulerFromQuaternion(table.q_nb(k));
    const double heading_deg = euler.z() / kDegree;
    // Written with 8 decimals, a heading just west of north would be 360.
    const double yaw_deg = heading_deg < -5e-9 ? heading_deg + 360.0
                           : heading_deg < 0.0 ? 0.0
                                               : heading_deg;
    line = std::to_string(time.week);
    const auto append = [&line](double value, int decimals) {
      line += ' ';
      AppendFixed(value, decimals, &line);
    };
    append(time.seconds, 9);
    append(g.latitude / kDegree, 12);
    append(g.longitude / kDegree, 12);
    append(g.height, 6);
    for (const double v : v_n) append(v, 6);
    append(euler.x() / kDegree, 8);
    append(euler.y() / kDegree, 8);
    append(yaw_deg, 8);
    line += '\n';
    file.Write(line);
  }
  file.Commit();
}

}  // namespace hindsight
