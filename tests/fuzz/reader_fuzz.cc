// Feeds bytes to every reader of text. The first byte chooses the format, the
// second the stream; the rest is the file. Whatever it holds, a reader returns
// rows or throws InputError.

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "base/error.h"
#include "io/reader.h"

namespace hindsight {
namespace {

/// A file in memory that can be opened by its path.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size)
      : file_(memfd_create("reader_fuzz", 0)) {
    if (file_ < 0 || write(file_, data, size) != static_cast<ssize_t>(size)) {
      std::abort();
    }
  }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

constexpr TextFormat::Kind kFormats[] = {
    TextFormat::Kind::kCsv,           TextFormat::Kind::kColumns,
    TextFormat::Kind::kKfGins,        TextFormat::Kind::kRtklibPos,
    TextFormat::Kind::kEuroc,         TextFormat::Kind::kNclt,
    TextFormat::Kind::kControlPoints, TextFormat::Kind::kNmea,
    TextFormat::Kind::kNpy,
};
constexpr SensorType kTypes[] = {
    SensorType::kPosition, SensorType::kVelocity,    SensorType::kHeight,
    SensorType::kOdometer, SensorType::kSpeedCourse, SensorType::kMagnetometer};

void AddColumns(const std::vector<FieldName>& fields, TextFormat* format) {
  format->columns.push_back({"t", 0, "", "ms", 1.0});
  for (const FieldName& field : fields) {
    format->columns.push_back({field.name,
                               static_cast<int>(format->columns.size()), "",
                               SiUnit(field.quantity), -2.0});
  }
}

const std::vector<FieldName>& FieldsOf(SensorType type) {
  switch (type) {
    case SensorType::kVelocity:
      return VelocityFields();
    case SensorType::kHeight:
      return HeightFields();
    case SensorType::kOdometer:
      return OdometerFields();
    case SensorType::kSpeedCourse:
      return SpeedCourseFields();
    case SensorType::kMagnetometer:
      return MagnetometerFields();
    default:
      return PositionFields();
  }
}

void Read(StreamSource source, unsigned stream) {
  StreamClock clock;
  std::vector<PolicyCount> policies;
  const bool takes_columns = TakesColumns(source.format.kind);
  if (stream == 0) {
    if (takes_columns) AddColumns(ImuFields(), &source.format);
    ReadImu(source, {}, &clock, &policies);
  } else if (stream == 1) {
    if (takes_columns) AddColumns(TruthFields(), &source.format);
    ReadTruth(source, {}, &clock, &policies);
  } else {
    AidingReadOptions options;
    options.type = kTypes[stream % std::size(kTypes)];
    if (takes_columns) AddColumns(FieldsOf(options.type), &source.format);
    options.sigma = Eigen::Vector3d::Ones();
    options.course_sigma = 0.1;
    if (stream % 2 == 0) options.accept_quality = {1, 4};
    ReadAiding(source, options, &clock, &policies);
  }
  MapClock(source, clock, std::int64_t{1'000'000'000'000'000'000});
}

}  // namespace
}  // namespace hindsight

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace hindsight;
  if (size < 3) return 0;
  const MemoryFile file(data + 2, size - 2);
  StreamSource source;
  source.name = "fuzz";
  source.path = file.path();
  source.format.kind = kFormats[(data[0] & 0x0f) % std::size(kFormats)];
  source.sort = (data[0] & 0x10) != 0;
  source.absent_values = (data[0] & 0x20) != 0;
  source.allow_truncated_tail = (data[0] & 0x40) != 0;
  if ((data[0] & 0x80) != 0) source.clock.scale = ClockMap::Scale::kUnix;
  try {
    Read(source, data[1] % 16u);
  } catch (const InputError&) {
  }
  return 0;
}
