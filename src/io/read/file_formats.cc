#include "io/read/file_formats.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "base/error.h"
#include "io/read/text_lines.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

std::vector<const FileFormat*>& TheList() {
  static std::vector<const FileFormat*> list = {
      &CsvFormat(),   &ColumnsFormat(), &RtklibPosFormat(),     &KfGinsFormat(),
      &EurocFormat(), &NcltFormat(),    &ControlPointsFormat(), &OxtsFormat(),
      &NmeaFormat(),  &NpyFormat(),     &MatFormat(),           &RosbagFormat(),
  };
  return list;
}

/// Lines enough to tell formats and rates apart.
constexpr int kProbeLines = 60;

TextProbe ReadProbe(const std::string& path) {
  TextProbe probe{path, {}, {}};
  TextLines lines(path);
  std::string_view line;
  while (static_cast<int>(probe.lines.size()) < kProbeLines &&
         lines.Next(&line)) {
    (IsComment(line) ? probe.comments : probe.lines).emplace_back(line);
  }
  return probe;
}

std::optional<FoundStreams> Named(const FileFormat& format,
                                  std::optional<FoundStreams> found) {
  if (found) found->format = format.name;
  return found;
}

}  // namespace

bool TableRequest::Is(const SensorKind& kind) const {
  return &fields == &kind.columns;
}

const std::vector<const FileFormat*>& FileFormats() { return TheList(); }

void AddFileFormat(const FileFormat& format) {
  for (const FileFormat* known : FileFormats()) {
    if (known->name != format.name) continue;
    throw std::invalid_argument("there is a format named " +
                                std::string(format.name));
  }
  TheList().push_back(&format);
}

std::optional<FoundStreams> RecogniseFormat(const std::string& path) {
  for (const FileFormat* format : FileFormats()) {
    if (format->recognise_name == nullptr) continue;
    auto found = Named(*format, format->recognise_name(path));
    if (found) return found;
  }
  TextProbe probe;
  try {
    probe = ReadProbe(path);
  } catch (const InputError&) {
    return std::nullopt;
  }
  if (probe.lines.empty()) return std::nullopt;
  for (const FileFormat* format : FileFormats()) {
    if (format->recognise_text == nullptr) continue;
    auto found = Named(*format, format->recognise_text(probe));
    if (found) return found;
  }
  return std::nullopt;
}

FoundStreams FoundImu() {
  FoundStreams found;
  found.imu = true;
  return found;
}

FoundStreams FoundTruth() {
  FoundStreams found;
  found.truth = true;
  return found;
}

FoundStreams FoundAiding(std::vector<const SensorKind*> kinds) {
  FoundStreams found;
  found.kinds = std::move(kinds);
  return found;
}

}  // namespace hindsight
