#include "io/read/file_formats.h"

#include <stdexcept>

#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

std::vector<const FileFormat*>& TheList() {
  static std::vector<const FileFormat*> list = {
      &CsvFormat(),           &RtklibPosFormat(), &KfGinsFormat(),
      &ControlPointsFormat(), &EurocFormat(),     &NcltFormat(),
      &OxtsFormat(),          &NmeaFormat(),      &NpyFormat(),
      &MatFormat(),           &RosbagFormat(),    &ColumnsFormat(),
      &GpxFormat(),
  };
  return list;
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

}  // namespace hindsight
