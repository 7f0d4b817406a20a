#include "io/write/kml.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "io/read/time_scale.h"
#include "io/write/atomic_file.h"
#include "io/write/number_format.h"

namespace hindsight {
namespace {

std::string EscapeXml(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::vector<std::size_t> ThinnedIndices(std::size_t size) {
  const std::size_t count = std::min(size, kMaxKmlPoints);
  std::vector<std::size_t> indices(count);
  for (std::size_t i = 0; i < count; ++i) {
    indices[i] = count == 1 ? 0 : i * (size - 1) / (count - 1);
  }
  return indices;
}

/// The indices, parted where the path crosses +-180 deg of longitude: a viewer
/// would draw the step around the Earth.
std::vector<std::vector<std::size_t>> Pieces(const SolutionTable& table) {
  std::vector<std::vector<std::size_t>> pieces(1);
  double last = 0.0;
  for (const std::size_t k : ThinnedIndices(table.size())) {
    const double longitude = GeodeticFromEcef(table.p_e[k]).longitude;
    if (!pieces.back().empty() && std::abs(longitude - last) > kPi) {
      pieces.emplace_back();
    }
    pieces.back().push_back(k);
    last = longitude;
  }
  return pieces;
}

/// "lon<separator>lat<separator>h".
std::string Coordinates(const Eigen::Vector3d& p_e, char separator) {
  const Geodetic g = GeodeticFromEcef(p_e);
  std::string text;
  AppendFixed(g.longitude / kDegree, 9, &text);
  text += separator;
  AppendFixed(g.latitude / kDegree, 9, &text);
  text += separator;
  AppendFixed(g.height, 3, &text);
  return text;
}

void WriteTrack(const SolutionTable& table,
                const std::vector<std::size_t>& indices,
                std::int64_t epoch_gps_ns, AtomicFile* file) {
  file->Write(
      "<Placemark><name>track</name><gx:Track>"
      "<altitudeMode>absolute</altitudeMode>\n");
  for (const std::size_t k : indices) {
    const std::int64_t gps_ns = epoch_gps_ns + std::llround(table.t[k] * 1e9);
    file->Write("<when>" + FormatUtcTime(gps_ns) + "</when>\n");
  }
  for (const std::size_t k : indices) {
    file->Write("<gx:coord>" + Coordinates(table.p_e[k], ' ') +
                "</gx:coord>\n");
  }
  if (!table.q_eb.empty()) {
    for (const std::size_t k : indices) {
      const Eigen::Vector3d euler = EulerFromQuaternion(table.q_nb(k));
      file->Write("<gx:angles>" + FormatFixed(euler.z() / kDegree, 2) +
                  " 0 0</gx:angles>\n");
    }
  }
  file->Write("</gx:Track></Placemark>\n");
}

}  // namespace

void WriteKml(const std::string& path, const SolutionTable& table,
              std::optional<std::int64_t> epoch_gps_ns, const std::string& name,
              const std::string& description) {
  if (table.p_e.empty()) {
    throw EstimationError(path +
                          ": a KML file needs positions, which the solution "
                          "lacks");
  }
  AtomicFile file(path);
  file.Write(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<kml xmlns=\"http://www.opengis.net/kml/2.2\" "
      "xmlns:gx=\"http://www.google.com/kml/ext/2.2\">\n<Document><name>" +
      EscapeXml(name) + "</name>\n");
  if (!description.empty()) {
    file.Write("<description>" + EscapeXml(description) + "</description>\n");
  }
  const std::vector<std::vector<std::size_t>> pieces = Pieces(table);
  for (const std::vector<std::size_t>& piece : pieces) {
    file.Write(
        "<Placemark><name>path</name><LineString>"
        "<altitudeMode>absolute</altitudeMode><coordinates>\n");
    for (const std::size_t k : piece) {
      file.Write(Coordinates(table.p_e[k], ',') + "\n");
    }
    file.Write("</coordinates></LineString></Placemark>\n");
  }
  if (epoch_gps_ns) {
    for (const std::vector<std::size_t>& piece : pieces) {
      WriteTrack(table, piece, *epoch_gps_ns, &file);
    }
  }
  file.Write("</Document>\n</kml>\n");
  file.Commit();
}

}  // namespace hindsight
