#include "io/read/time_list.h"

#include <optional>
#include <string_view>

#include "base/error.h"
#include "io/read/text_lines.h"
#include "io/read/units.h"

namespace hindsight {

std::vector<double> ReadTimeList(const std::string& path) {
  TextLines lines(path);
  std::vector<double> times;
  for (std::string_view line; lines.Next(&line);) {
    const std::string_view text = Trim(line);
    if (text.empty() || text.front() == '#') continue;
    if (times.empty() && text == "t[s]") continue;
    const std::optional<double> t = ParseNumber(text);
    if (!t) {
      throw InputError(path, lines.number(),
                       "'" + std::string(text) +
                           "' is no time, expected one number of seconds");
    }
    if (!times.empty() && *t <= times.back()) {
      throw InputError(path, lines.number(),
                       "time " + FormatNumber(*t) + " s does not come after " +
                           FormatNumber(times.back()) + " s");
    }
    times.push_back(*t);
  }
  if (times.empty()) throw InputError(path, 0, "holds no times");
  return times;
}

}  // namespace hindsight
