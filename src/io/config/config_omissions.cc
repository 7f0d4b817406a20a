#include "io/config/config_omissions.h"

#include <fmt/core.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "base/error.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

bool Speaks(const Omission& omission, const Sensor& sensor) {
  return omission.sensor == sensor.name ||
         omission.sensor == sensor.kind->name ||
         omission.sensor == sensor.kind->family;
}

/// Takes the measurements of a span out of every stream that it names.
void Omit(const Omission& omission, const std::string& place,
          Dataset* dataset) {
  bool known = false;
  long count = 0;
  for (AidingStream& stream : dataset->streams) {
    if (!Speaks(omission, stream.sensor)) continue;
    known = true;
    MeasurementSeries kept;
    for (const Measurement& z : stream.measurements) {
      const double t = z.t + stream.sensor.time_offset;
      const bool omitted = t >= omission.from && t < omission.to;
      if (!omitted) kept.push_back(z);
      count += omitted ? 1 : 0;
    }
    if (kept.empty()) {
      throw InputError(place + ": leaves no measurement of " +
                       stream.sensor.name + "; --without leaves it out whole");
    }
    stream.measurements = std::move(kept);
  }
  const std::string span =
      omission.sensor + " from " +
      fmt::format("{:g} s to {:g} s", omission.from, omission.to);
  if (!known) {
    throw InputError(place + ": no aiding stream is named or of the type '" +
                     omission.sensor + "'");
  }
  if (count == 0) {
    throw InputError(place + ": " + span +
                     " holds no measurement; expected times since the data "
                     "set's epoch");
  }
  dataset->policies.push_back({omission.sensor, "omitted", count});
}

}  // namespace

void ApplyOmissions(const std::vector<Omission>& declared,
                    const LoadOptions& options, ConfigMap* top,
                    Dataset* dataset) {
  for (const Omission& omission : declared) {
    Omit(omission,
         top->file() + ":" + std::to_string(top->Line("omit")) + ": omit",
         dataset);
  }
  for (const Omission& omission : options.omit) {
    Omit(omission, "--omit", dataset);
    YAML::Node entry;
    entry["sensor"] = omission.sensor;
    entry["from"] = FormatNumber(omission.from) + " s";
    entry["to"] = FormatNumber(omission.to) + " s";
    top->resolved()["omit"].push_back(entry);
  }
}

Omission ParseOmission(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::size_t dots = text.find("..", std::min(colon, text.size()));
  if (colon == 0 || colon == text.npos || dots == text.npos) {
    throw std::invalid_argument(
        "expected SENSOR:T1..T2, as gnss:100..130, in seconds since the data "
        "set's epoch");
  }
  const auto seconds = [](const std::string& word) {
    const auto number = ParseNumber(Trim(word));
    return number ? *number : ParseQuantity(word, Quantity::kTime);
  };
  Omission omission{text.substr(0, colon),
                    seconds(text.substr(colon + 1, dots - colon - 1)),
                    seconds(text.substr(dots + 2))};
  if (!(omission.to > omission.from)) {
    throw std::invalid_argument("T2 must lie behind T1");
  }
  return omission;
}

}  // namespace hindsight
