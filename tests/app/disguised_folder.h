#ifndef HINDSIGHT_TESTS_APP_DISGUISED_FOLDER_H_
#define HINDSIGHT_TESTS_APP_DISGUISED_FOLDER_H_

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/recording.h"

namespace hindsight {

using Table = std::vector<std::vector<std::string>>;

inline Table ReadTable(const std::filesystem::path& path) {
  Table table;
  for (const std::string& line : Lines(ReadFile(path))) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream in(line);
    table.emplace_back();
    for (std::string cell; std::getline(in, cell, ',');) {
      table.back().push_back(cell);
    }
  }
  return table;
}

inline void WriteTable(const std::filesystem::path& path, const Table& table) {
  std::string text;
  for (const auto& row : table) {
    text += fmt::format("{}\n", fmt::join(row, ","));
  }
  WriteFile(path, text);
}

/// A shipped scenario as somebody's folder `data`: without configuration and
/// manifest; its truth lies beside.
class DisguisedFolder : public ::testing::Test {
 protected:
  void Simulate(const std::string& scenario,
                const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"simulate", scenario, "--out=data",
                                      "--seed=3"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome made = Hindsight(words, folder_.path());
    ASSERT_EQ(made.status, 0) << made.err;
    for (const char* name : {"config.yaml", "manifest.json"}) {
      std::filesystem::remove(file(name));
    }
    std::filesystem::rename(file("truth.csv"), folder_.path() / "truth.csv");
  }
  std::filesystem::path file(const std::string& name) const {
    return folder_.path() / "data" / name;
  }

  /// Takes away the columns that a file states of its sigmas.
  void DropSigmas(const std::string& name) const {
    Table table = ReadTable(file(name));
    const std::vector<std::string> titles = table.front();
    for (auto& row : table) {
      std::vector<std::string> kept;
      for (std::size_t i = 0; i < row.size(); ++i) {
        if (!titles[i].starts_with("sigma")) kept.push_back(row[i]);
      }
      row = kept;
    }
    WriteTable(file(name), table);
  }

  /// Turns round the y axis of gyros and accelerometers.
  void MirrorImu() const {
    Table table = ReadTable(file("imu.csv"));
    for (std::size_t k = 1; k < table.size(); ++k) {
      for (const std::size_t column : {std::size_t{2}, std::size_t{5}}) {
        std::string& cell = table[k][column];
        cell = cell[0] == '-' ? cell.substr(1) : "-" + cell;
      }
    }
    WriteTable(file("imu.csv"), table);
  }

  Outcome Run() const {
    return Hindsight(
        {"run", "data", "--yes", "--methods=rts", "--out=out", "--force"},
        folder_.path());
  }
  std::string Config() const { return ReadFile(folder_.path() / "out.yaml"); }

  nlohmann::json Errors() const {
    const Outcome judged = Hindsight(
        {"evaluate", "out/rts.csv", "truth.csv", "--json"}, folder_.path());
    EXPECT_TRUE(HasResults(judged)) << judged.err;
    return nlohmann::json::parse(judged.out);
  }
  /// Normalised errors squared of three axes are 3 if their sigmas are right; 7.8
  /// is the 95 % point of a single one, and those of a run are alike.
  void ExpectHonestPositions() const {
    EXPECT_LT(Errors()["nees"]["position"].get<double>(), 7.8);
  }

  TemporaryFolder folder_;
};

/// Half of the drive of test_car as loggers and apps write it, by a sensor with x
/// forward, y left and z up.
class LoggedFolder : public DisguisedFolder {
 protected:
  void SetUp() override {
    Simulate("test_car", {"--set=wander.duration=150 s"});
    const Table imu = ReadTable(file("imu.csv"));
    const Table fixes = ReadTable(file("gnss.csv"));
    constexpr double kStep = 0.01;
    constexpr std::array kSigns = {1.0, -1.0, -1.0};
    for (std::size_t k = 1; k < imu.size(); ++k) {
      Sample sample = {std::stod(imu[k][0]) - 0.5 * kStep, {}, {}};
      for (std::size_t i = 0; i < 3; ++i) {
        sample.gyro[i] = kSigns[i] * std::stod(imu[k][1 + i]) / kStep;
        sample.accel[i] = kSigns[i] * std::stod(imu[k][4 + i]) / kStep;
      }
      samples_.push_back(sample);
    }
    for (std::size_t k = 1; k < fixes.size(); ++k) {
      fixes_.push_back({std::stod(fixes[k][0]), std::stod(fixes[k][1]),
                        std::stod(fixes[k][2]), std::stod(fixes[k][3])});
    }
    std::filesystem::rename(file("odometer.csv"),
                            folder_.path() / "odometer.csv");
    for (const char* name : {"imu.csv", "gnss.csv"}) {
      std::filesystem::remove(file(name));
    }
  }

  /// Within what fixes of 0.5 m allow and an antenna 1.3 m away of which nobody
  /// told.
  void ExpectRight() const {
    const Outcome run = Run();
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    const nlohmann::json errors = Errors();
    EXPECT_LT(errors["errors"]["position_total"]["rms"].get<double>(), 1.8);
    ExpectHonestPositions();
  }

  /// "TITLE,ax,ay,az,gx,gy,gz" in m/s^2 and rad/s, with what `stamp` makes of times.
  template <typename Stamp>
  void WriteImu(const std::string& title, Stamp stamp) const {
    std::string text = title + ",ax,ay,az,gx,gy,gz\n";
    for (const Sample& s : samples_) {
      text += fmt::format("{},{:.6f},{:.8f}\n", stamp(s.t),
                          fmt::join(s.accel, ","), fmt::join(s.gyro, ","));
    }
    WriteFile(file("imu.csv"), text);
  }
  template <typename Stamp>
  void WriteFixes(const std::string& title, Stamp stamp) const {
    std::string text = title + ",latitude,longitude,altitude\n";
    for (const Fix& x : fixes_) {
      text += fmt::format("{},{:.9f},{:.9f},{:.3f}\n", stamp(x.t), x.lat, x.lon,
                          x.h);
    }
    WriteFile(file("gps.csv"), text);
  }

  struct Sample {
    double t;
    std::array<double, 3> gyro;
    std::array<double, 3> accel;
  };
  struct Fix {
    double t, lat, lon, h;
  };
  std::vector<Sample> samples_;
  std::vector<Fix> fixes_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_APP_DISGUISED_FOLDER_H_
