// Makes configurations of recordings and scenarios out of their own keys
// (config_keys.h) and reads them. The first byte chooses between the two; every
// further one is a choice: which key, its usual value or another, another key
// or the end. What loads is taken as far as its nodes, so that no list a
// configuration asks for grows without bound.

#include <algorithm>
#include <string>

#include "base/error.h"
#include "dataset/rest.h"
#include "dataset/timeline_builder.h"
#include "fuzz/config_keys.h"
#include "fuzz/fuzz_input.h"
#include "io/config/config.h"
#include "io/config/scenario_config.h"

namespace hindsight {
namespace {

/// Choices taken from bytes; past their end, always the first.
class Choices {
 public:
  Choices(const std::uint8_t* data, std::size_t size)
      : data_(data), size_(size) {}
  std::size_t Next(std::size_t count) {
    return at_ < size_ ? data_[at_++] % count : 0;
  }
  bool AtEnd() const { return at_ >= size_; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

class ConfigWriter {
 public:
  ConfigWriter(const std::vector<FuzzMap>& maps, Choices* choices)
      : maps_(maps), choices_(*choices) {}

  std::string Write() {
    AppendMap("top", 0);
    return text_;
  }

 private:
  const FuzzMap& Find(std::string_view name) const {
    return *std::find_if(maps_.begin(), maps_.end(),
                         [&](const FuzzMap& map) { return map.name == name; });
  }

  std::vector<FuzzKey> KeysOf(std::string_view name) const {
    std::vector<FuzzKey> keys = Find(name).keys;
    if (name == "imu" || name == "aiding" || name == "truth") {
      const std::vector<FuzzKey>& more = Find("stream").keys;
      keys.insert(keys.begin(), more.begin(), more.end());
    }
    return keys;
  }

  /// What a map does not load without comes first, most of the time.
  void AppendNeeded(std::string_view name, int level) {
    if (choices_.Next(16) == 15) return;
    const std::string_view file = name == "imu"      ? "file: imu.csv"
                                  : name == "truth"  ? "file: truth.csv"
                                  : name == "aiding" ? "file: gnss.csv"
                                                     : "";
    if (!file.empty()) Line(level, file);
    if (name == "aiding") Line(level, "type: position");
    if (name == "imu") {
      Line(level, "noise: {gyro: 0.1 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}");
    }
    if (name == "top" && &maps_ == &RecordingMaps()) {
      Line(level, "imu:");
      AppendMap("imu", level + 1);
    }
  }

  void AppendMap(std::string_view name, int level) {
    AppendNeeded(name, level);
    const std::vector<FuzzKey> keys = KeysOf(name);
    const std::size_t count = choices_.Next(keys.size() + 1);
    for (std::size_t i = 0; i < count && !choices_.AtEnd(); ++i) {
      Append(keys[choices_.Next(keys.size())], level);
    }
  }

  void Append(const FuzzKey& key, int level) {
    const std::string head(key.key);
    if (choices_.Next(4) == 3) {
      const auto& values = FuzzValues();
      Line(level,
           head + ": " + std::string(values[choices_.Next(values.size())]));
    } else if (key.value.starts_with("<[")) {
      Line(level, head + ":");
      const std::string_view inner = key.value.substr(2, key.value.size() - 4);
      const std::size_t count = 1 + choices_.Next(3);
      for (std::size_t i = 0; i < count; ++i) {
        Line(level, "  - ");
        AppendMap(inner, level + 2);
      }
    } else if (key.value.starts_with('<')) {
      Line(level, head + ":");
      AppendMap(key.value.substr(1, key.value.size() - 2), level + 1);
    } else {
      Line(level, head + ": " + std::string(key.value));
    }
  }

  void Line(int level, std::string_view line) {
    text_.append(static_cast<std::size_t>(2 * level), ' ');
    text_ += line;
    text_ += '\n';
  }

  const std::vector<FuzzMap>& maps_;
  Choices& choices_;
  std::string text_;
};

/// Two seconds of a body at rest.
const FuzzFolder& RecordingFiles() {
  static const FuzzFolder folder("config_fuzz");
  static const bool written = [] {
    std::string imu =
        "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],"
        "accel_x[m/s^2],accel_y[m/s^2],accel_z[m/s^2]\n";
    std::string gnss =
        "t[s],lat[deg],lon[deg],h[m],sigma_n[m],sigma_e[m],"
        "sigma_d[m],v_n[m/s],v_e[m/s],v_d[m/s]\n";
    std::string truth =
        "t[s],lat[deg],lon[deg],h[m],roll[deg],pitch[deg],heading[deg]\n";
    std::string speed = "t[s],speed[m/s],course[deg],distance[m],depth[m]\n";
    for (int i = 0; i < 200; ++i) {
      const std::string t = std::to_string(0.01 * i);
      imu += t + ",0,0,0,0,0,-9.8\n";
      if (i % 10 != 0) continue;
      gnss += t + ",48,11,500,1,1,1,0,0,0\n";
      truth += t + ",48,11,500,0,0,40\n";
      speed += t + ",1,40," + t + ",5\n";
    }
    folder.Write("imu.csv", imu);
    folder.Write("gnss.csv", gnss);
    folder.Write("speed.csv", speed);
    folder.Write("truth.csv", truth);
    return true;
  }();
  static_cast<void>(written);
  return folder;
}

}  // namespace

void FuzzConfigurations(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return;
  Choices choices(data + 1, size - 1);
  const bool scenario = data[0] % 4 == 3;
  const FuzzFolder& folder = RecordingFiles();
  const std::string path = folder.Write(
      "config.yaml",
      ConfigWriter(scenario ? ScenarioMaps() : RecordingMaps(), &choices)
          .Write());
  try {
    if (scenario) {
      LoadScenario(path);
      return;
    }
    ResolvedConfig resolved;
    Dataset dataset = LoadDataset(path, {.data_root = "."}, &resolved);
    AddRestStreams(FindRest(dataset), &dataset);
    TimelineOptions options;
    options.t_begin = dataset.imu.t_begin();
    options.t_end = dataset.imu.t_end();
    BuildTimeline(dataset, options);
  } catch (const InputError&) {
  }
}

}  // namespace hindsight
