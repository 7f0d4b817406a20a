// Feeds bytes to everything that reads text. The first byte chooses the kind of
// file, the second the stream and, of a recording's file, the format; the rest
// is the file. Whatever it holds, a reader returns what it read or throws
// InputError.

#include <algorithm>
#include <string>
#include <string_view>

#include "base/error.h"
#include "fuzz/fuzz_input.h"
#include "io/config/config.h"
#include "io/config/scenario_config.h"
#include "io/read/file_formats.h"
#include "io/read/reader.h"
#include "io/read/time_list.h"
#include "io/write/solution_csv.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

const FuzzFolder& TheFolder() {
  static const FuzzFolder folder("reader_fuzz");
  return folder;
}

/// The text up to `separator`, which is removed from it.
std::string_view Cut(std::string_view separator, std::string_view* text) {
  const std::size_t end = text->find(separator);
  const std::string_view head = text->substr(0, end);
  text->remove_prefix(end == std::string_view::npos ? text->size()
                                                    : end + separator.size());
  return head;
}

/// Further ones are a recording's files.
constexpr unsigned kOtherKinds = 6;

void AddColumns(const std::vector<FieldName>& fields, TextFormat* format) {
  format->columns.push_back({"t", 0, "", "ms", 1.0});
  for (const FieldName& field : fields) {
    format->columns.push_back({field.name,
                               static_cast<int>(format->columns.size()), "",
                               SiUnit(field.quantity), -2.0});
  }
}

void Read(StreamSource source, unsigned stream) {
  StreamClock clock;
  std::vector<PolicyCount> policies;
  const bool takes_columns = source.format.kind->takes_columns;
  if (stream == 0) {
    if (takes_columns) AddColumns(ImuFields(), &source.format);
    ReadImu(source, {}, &clock, &policies);
  } else if (stream == 1) {
    if (takes_columns) AddColumns(TruthFields(), &source.format);
    ReadTruth(source, {}, &clock, &policies);
  } else {
    std::vector<const SensorKind*> kinds = SensorKinds();
    std::erase_if(kinds,
                  [](const SensorKind* kind) { return kind->read == nullptr; });
    SensorSettings settings = SettingsOf(*kinds[stream % kinds.size()]);
    const SensorKind& kind = *settings.sensor.kind;
    if (takes_columns) AddColumns(kind.columns, &source.format);
    settings.sigma = Eigen::Vector3d::Ones();
    if (kind.complete != nullptr) kind.complete(&settings);
    if (stream % 2 == 0) settings.accept_quality = {1, 4};
    ReadAiding(source, settings, 0, &clock, &policies);
  }
  MapClock(source, clock, std::int64_t{1'000'000'000'000'000'000});
}

/// timestamps.txt up to an empty line, then each line a file of data/.
void ReadOxtsFolder(std::string_view text, StreamSource source,
                    unsigned stream) {
  constexpr int kMostFiles = 8;
  const FuzzFolder& folder = TheFolder();
  for (int i = 0; i < kMostFiles; ++i) {
    std::filesystem::remove(
        folder.Path("oxts/data/" + std::to_string(i) + ".txt"));
  }
  folder.Write("oxts/timestamps.txt", Cut("\n\n", &text));
  for (int i = 0; i < kMostFiles && !text.empty(); ++i) {
    folder.Write("oxts/data/" + std::to_string(i) + ".txt", Cut("\n", &text));
  }
  source.path = folder.Path("oxts");
  source.format.kind = &OxtsFormat();
  Read(std::move(source), stream);
}

/// A configuration beside a recording in own CSV.
void ReadConfiguration(std::string_view text) {
  const FuzzFolder& folder = TheFolder();
  static const bool written = [&] {
    folder.Write("imu.csv",
                 "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],"
                 "accel_x[m/s^2],accel_y[m/s^2],accel_z[m/s^2]\n"
                 "0,0,0,0,0,0,-9.8\n0.1,0,0,0,0,0,-9.8\n");
    folder.Write("gnss.csv",
                 "t[s],lat[deg],lon[deg],h[m]\n0,48,11,500\n0.1,48,11,500\n");
    folder.Write("speed.csv", "t[s],speed[m/s]\n0,1\n0.1,1\n");
    folder.Write("truth.csv", "t[s],lat[deg],lon[deg],h[m]\n0,48,11,500\n");
    return true;
  }();
  static_cast<void>(written);
  ResolvedConfig resolved;
  LoadDataset(folder.Write("config.yaml", text), {.data_root = "."}, &resolved);
}

void ReadOther(unsigned kind, unsigned stream, std::string_view text,
               StreamSource source) {
  switch (kind) {
    case 0:
      return ReadOxtsFolder(text, std::move(source), stream);
    case 1:
      return ReadConfiguration(text);
    case 2:
      LoadScenario(source.path);
      return;
    case 3:
      ReadSolutionTable(source.path);
      return;
    case 4:
      ReadTimeList(source.path);
      return;
    default:
      ReadMotionProfile(source.path);
  }
}

}  // namespace

void FuzzReaders(const std::uint8_t* data, std::size_t size) {
  if (size < 3) return;
  const MemoryFile file(data + 2, size - 2);
  StreamSource source;
  source.name = "fuzz";
  source.path = file.path();
  const unsigned kind = data[0] & 0x0fu;
  const std::size_t format = data[1] / 16u;
  source.format.kind = FileFormats()[format % FileFormats().size()];
  source.sort = (data[0] & 0x10) != 0;
  source.absent_values = (data[0] & 0x20) != 0;
  source.allow_truncated_tail = (data[0] & 0x40) != 0;
  if ((data[0] & 0x80) != 0) source.clock.scale = ClockMap::Scale::kUnix;
  try {
    if (kind >= kOtherKinds) {
      Read(source, data[1] % 16u);
    } else {
      ReadOther(kind, data[1] % 16u,
                {reinterpret_cast<const char*>(data) + 2, size - 2}, source);
    }
  } catch (const InputError&) {
  }
}

}  // namespace hindsight
