#include "io/nav.h"

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "io/atomic_file.h"
#include "io/number_format.h"

namespace hindsight {
namespace {

constexpr std::int64_t kWeekNs = 604'800'000'000'000;
constexpr double kWeek = 604800.0;

struct GpsTime {
  std::int64_t week = 0;
  double seconds = 0.0;
};

GpsTime GpsTimeOf(double t, std::optional<std::int64_t> epoch_gps_ns) {
  if (!epoch_gps_ns) return {0, t};
  GpsTime time{*epoch_gps_ns / kWeekNs,
               1e-9 * static_cast<double>(*epoch_gps_ns % kWeekNs) + t};
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
    const GpsTime time = GpsTimeOf(table.t[k], epoch_gps_ns);
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
