#ifndef HINDSIGHT_TESTS_APP_RECORDING_H_
#define HINDSIGHT_TESTS_APP_RECORDING_H_

#include <gtest/gtest.h>
#include <zlib.h>

#include <functional>
#include <string>
#include <vector>

#include "app/command_line.h"

namespace hindsight {

/// A short simulated recording in a folder of its own, made by the command
/// itself; lines are counted from 1.
class Recording {
 public:
  Recording() {
    WriteFile(root() / "scenario.yaml", kScenario);
    const Outcome made = Hindsight(
        {"simulate", "scenario.yaml", "--out=data", "--seed=7"}, root());
    if (made.status != 0) throw std::runtime_error(made.err);
    std::filesystem::remove(root() / "scenario.yaml");
  }

  const std::filesystem::path& root() const { return folder_.path(); }
  std::filesystem::path file(const std::string& name) const {
    return root() / "data" / name;
  }
  /// Changes the lines of a file.
  void Edit(const std::string& name,
            const std::function<void(std::vector<std::string>*)>& change) {
    std::vector<std::string> lines = Lines(ReadFile(file(name)));
    change(&lines);
    WriteFile(file(name), Join(lines));
  }

  /// Replaces the first occurrence of `from` in a file; returns its line.
  std::size_t Replace(const std::string& name, const std::string& from,
                      const std::string& to) {
    std::string text = ReadFile(file(name));
    const std::size_t at = text.find(from);
    if (at == std::string::npos) {
      throw std::runtime_error(name + " holds no " + from);
    }
    text.replace(at, from.size(), to);
    WriteFile(file(name), text);
    return 1 + static_cast<std::size_t>(std::count(
                   text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at),
                   '\n'));
  }

  /// The number of the first line that holds data.
  std::size_t FirstRow(const std::string& name) const {
    const std::vector<std::string> lines = Lines(ReadFile(file(name)));
    std::size_t line = 0;
    while (lines[line].find_first_of("0123456789+-") != 0) ++line;
    return line + 1;
  }

  Outcome Run(std::vector<std::string> flags = {}) const {
    flags.insert(flags.begin(), {"run", "data/config.yaml"});
    return Hindsight(flags, root());
  }

 private:
  static constexpr const char* kScenario = R"(
name: short
start: {position: [48 deg, 11.5 deg, 500 m], heading: 65 deg}
segments:
  - {type: stop, duration: 10 s}
  - {type: accelerate, speed: 8 m/s, rate: 2 m/s^2}
  - {type: turn, angle: 90 deg, rate: 20 deg/s}
  - {type: straight, duration: 10 s}
  - {type: turn, angle: -60 deg, rate: 15 deg/s}
  - {type: straight, duration: 40 s}
duration: 50 s
imu:
  rate: 100 Hz
  noise: {gyro: 0.1 deg/sqrt(h), accel: 0.05 m/s/sqrt(h)}
  gyro_bias_sigma: 3 deg/h
  accel_bias_sigma: 1 mg
aiding:
  gnss: {type: position, rate: 1 Hz, sigma: [0.2 m, 0.2 m, 0.4 m],
         lever_arm: [0.5 m, 0 m, -1.2 m]}
  speed: {type: velocity, rate: 1 Hz, sigma: 0.05 m/s}
stationary: {velocity_sigma: 0.01 m/s}
)";
  TemporaryFolder folder_;
};

/// `text` as a gzip file.
inline void WriteGzip(const std::filesystem::path& path,
                      const std::string& text) {
  gzFile out = gzopen(path.c_str(), "wb");
  gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
  gzclose(out);
}

/// Line `line` with its column `column` (from 0) set to `value`.
inline void SetColumn(std::string* line, std::size_t column,
                      const std::string& value) {
  std::size_t begin = 0;
  for (; column > 0; --column) begin = line->find(',', begin) + 1;
  const std::size_t end = std::min(line->find(',', begin), line->size());
  line->replace(begin, end - begin, value);
}

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_APP_RECORDING_H_
