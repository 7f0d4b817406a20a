#include <array>
#include <cctype>
#include <string>
#include <string_view>

#include "base/error.h"
#include "io/config/scenario_config.h"
#include "io/read/file_formats.h"
#include "io/read/reader.h"
#include "io/read/text_lines.h"
#include "io/read/text_tokens.h"

namespace hindsight {
namespace {

struct ProfileColumn {
  const char* quantity;
  const char* unit;
};
constexpr std::array<ProfileColumn, 10> kHeaderless = {{{"t", "s"},
                                                        {"lat", "deg"},
                                                        {"lon", "deg"},
                                                        {"h", "m"},
                                                        {"v_n", "m/s"},
                                                        {"v_e", "m/s"},
                                                        {"v_d", "m/s"},
                                                        {"roll", "deg"},
                                                        {"pitch", "deg"},
                                                        {"heading", "deg"}}};

/// True if the first line that is no comment names columns.
bool HasHeader(const std::string& path) {
  TextLines lines(path);
  std::string_view line;
  while (lines.Next(&line)) {
    const std::string_view text = Trim(line);
    if (IsComment(text)) continue;
    return std::isalpha(static_cast<unsigned char>(text.front())) != 0;
  }
  throw InputError(path + ": there are no lines with data");
}

TextFormat HeaderlessFormat() {
  TextFormat format;
  format.kind = &ColumnsFormat();
  int column = 0;
  for (const ProfileColumn& entry : kHeaderless) {
    ColumnMapping mapping;
    mapping.quantity = entry.quantity;
    mapping.column = column++;
    mapping.unit = entry.unit;
    format.columns.push_back(mapping);
  }
  return format;
}

}  // namespace

std::vector<ProfilePoint> ReadMotionProfile(const std::string& path) {
  StreamSource source;
  source.name = "profile";
  source.path = path;
  source.config_path = path;
  if (!HasHeader(path)) source.format = HeaderlessFormat();
  StreamClock clock;
  std::vector<PolicyCount> policies;
  std::vector<ProfilePoint> points;
  for (const TruthPoint& truth : ReadTruth(source, {}, &clock, &policies)) {
    if (!truth.p_e || !truth.v_n || !truth.q_nb) {
      throw InputError(path +
                       ": a motion profile needs position, velocity and "
                       "attitude");
    }
    points.push_back({truth.t, GeodeticFromEcef(*truth.p_e), *truth.v_n,
                      EulerFromQuaternion(*truth.q_nb)});
  }
  return points;
}

}  // namespace hindsight
