// Feeds bytes to the readers of binary files: NumPy, MATLAB, ROS bags, archives
// of arrays. The first byte chooses the format and the stream, the second how
// stamps are counted; the rest is the file. Of MATLAB, the arrays "data" and
// "time" are asked for.

#include <string>

#include "base/error.h"
#include "fuzz/fuzz_input.h"
#include "io/read/file_formats.h"
#include "io/read/npz.h"
#include "io/read/reader.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

void AddArrayColumns(const std::vector<FieldName>& fields, std::uint8_t clock,
                     TextFormat* format) {
  const bool mat = format->kind == &MatFormat();
  const char* const units[] = {"s", "ms", "ns", "min"};
  ColumnMapping time{"t", mat ? -1 : 0, mat ? "time" : "", units[clock % 4],
                     clock % 8 < 4 ? 1.0 : 0.003};
  if ((clock & 0x10) != 0) {
    format->ignore_time = true;
  } else {
    format->columns.push_back(time);
  }
  int column = 1;
  for (const FieldName& field : fields) {
    ColumnMapping mapping{field.name, column, "", SiUnit(field.quantity), 1.0};
    if (mat) {
      mapping.column = -1;
      mapping.title = "data:" + std::to_string(column);
    }
    format->columns.push_back(mapping);
    if (++column == 7) break;
  }
}

void ReadStream(StreamSource source, bool imu, std::uint8_t clock) {
  if (source.format.kind != &RosbagFormat()) {
    AddArrayColumns(imu ? ImuFields() : PositionKind().columns, clock,
                    &source.format);
    if (source.format.ignore_time) source.clock.rate = 100.0;
  }
  StreamClock stream_clock;
  std::vector<PolicyCount> policies;
  if (imu) {
    ReadImu(source, {}, &stream_clock, &policies);
  } else {
    SensorSettings settings = SettingsOf(PositionKind());
    settings.sigma = Eigen::Vector3d::Ones();
    ReadAiding(source, settings, 0, &stream_clock, &policies);
  }
}

}  // namespace

void FuzzArrays(const std::uint8_t* data, std::size_t size) {
  if (size < 3) return;
  const MemoryFile file(data + 2, size - 2);
  const FileFormat* const kinds[] = {&NpyFormat(), &MatFormat(),
                                     &RosbagFormat()};
  StreamSource source;
  source.name = "fuzz";
  source.path = file.path();
  source.format.kind = kinds[(data[0] & 0x0f) % 3];
  source.sort = (data[0] & 0x10) != 0;
  source.absent_values = (data[0] & 0x20) != 0;
  try {
    if ((data[0] & 0x40) != 0) {
      ReadNpz(source.path);
      return;
    }
    ReadStream(source, (data[0] & 0x80) == 0, data[1]);
  } catch (const InputError&) {
  }
}

}  // namespace hindsight
