#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "app/recording.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

using Table = std::vector<std::vector<std::string>>;

Table ReadTable(const std::filesystem::path& path) {
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

void WriteTable(const std::filesystem::path& path, const Table& table) {
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
  void Simulate(const std::string& scenario) {
    const Outcome made = Hindsight(
        {"simulate", scenario, "--out=data", "--seed=3"}, folder_.path());
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

TEST_F(DisguisedFolder, FixesWithoutSigmasAreAsNoisyAsTheyShow) {
  for (const char* scenario : {"test_car", "test_aircraft"}) {
    Simulate(scenario);
    DropSigmas("gnss.csv");
    const Outcome run = Run();
    EXPECT_EQ(run.status, 0) << scenario << "\n" << run.out << run.err;
    EXPECT_THAT(Config(), Not(HasSubstr("white: 0.1 m")));
    ExpectHonestPositions();
    std::filesystem::remove_all(folder_.path() / "data");
  }
}

TEST_F(DisguisedFolder, ABarometerKeepsItsClockAndHasADatumOfItsOwn) {
  Simulate("test_aircraft");
  const Outcome run = Run();
  EXPECT_EQ(run.status, 0) << run.out << run.err;
  const std::string config = Config();
  const std::string height =
      config.substr(config.find("  height:"), config.find("  position:"));
  EXPECT_THAT(config, Not(HasSubstr("time_offset: unknown")));
  EXPECT_THAT(height, HasSubstr("estimate: {offset: 50 m}"));
  ExpectHonestPositions();
}

TEST_F(DisguisedFolder, VelocitiesAloneStartWhereTheTruthDoes) {
  Simulate("test_aircraft");
  for (const char* name : {"gnss.csv", "barometer.csv"}) {
    std::filesystem::remove(file(name));
  }
  // Without a truth the place is a local one, and said to be.
  const Outcome local = Run();
  EXPECT_THAT(local.out, HasSubstr("no stream tells the position"));
  EXPECT_THAT(local.out, HasSubstr("initial.position"));
  Table truth = ReadTable(folder_.path() / "truth.csv");
  for (auto& row : truth) row.resize(4);
  WriteTable(file("truth.csv"), truth);
  const Outcome run = Run();
  EXPECT_EQ(run.status, 0) << run.out << run.err;
  EXPECT_THAT(run.out, HasSubstr("the truth's first is the start"));
  EXPECT_THAT(Config(), HasSubstr("position: [48.000000000 deg, 11.500000000 "
                                  "deg, 1500.000 m]"));
  ExpectHonestPositions();
}

TEST_F(DisguisedFolder, AMirroredAxisIsNamedAndNothingIsUsable) {
  for (const char* scenario : {"test_car", "test_aircraft", "test_hand"}) {
    Simulate(scenario);
    MirrorImu();
    const Outcome run = Run();
    EXPECT_NE(run.status, 0) << scenario << "\n" << run.out;
    EXPECT_THAT(run.out, HasSubstr("imu: an axis is mirrored")) << scenario;
    std::filesystem::remove_all(folder_.path() / "data");
  }
}

/// The drive of test_car as loggers and apps write it, by a sensor with x
/// forward, y left and z up.
class LoggedFolder : public DisguisedFolder {
 protected:
  void SetUp() override {
    Simulate("test_car");
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
    for (const char* name : {"imu.csv", "gnss.csv", "odometer.csv"}) {
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

TEST_F(LoggedFolder, OfMessagesWithNamesOfFrames) {
  std::string imu =
      "%time,field.header.seq,field.header.stamp,field.header.frame_id,"
      "field.angular_velocity.x,field.angular_velocity.y,"
      "field.angular_velocity.z,field.angular_velocity_covariance0,"
      "field.linear_acceleration.x,field.linear_acceleration.y,"
      "field.linear_acceleration.z\n";
  const auto head = [](double t, std::size_t k, double late) {
    return fmt::format("{:.0f},{},{:.0f},link", 1e9 * (t + late), k, 1e9 * t);
  };
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    const Sample& s = samples_[k];
    imu += fmt::format("{},{:.9f},0.0,{:.9f}\n", head(s.t, k, 0.003),
                       fmt::join(s.gyro, ","), fmt::join(s.accel, ","));
  }
  WriteFile(file("imu.csv"), imu);
  std::string fixes =
      "%time,field.header.seq,field.header.stamp,field.header.frame_id,"
      "field.status.status,field.latitude,field.longitude,field.altitude\n";
  for (std::size_t k = 0; k < fixes_.size(); ++k) {
    const Fix& x = fixes_[k];
    fixes += fmt::format("{},0,{:.9f},{:.9f},{:.4f}\n", head(x.t, k, 0.2),
                         x.lat, x.lon, x.h);
  }
  WriteFile(file("fix.csv"), fixes);
  ExpectRight();
}

TEST_F(LoggedFolder, OfASpreadsheetWithDecimalCommas) {
  const auto write = [&](const char* name, const char* titles, auto values) {
    std::string text = titles;
    for (const Sample& s : samples_) {
      std::string row =
          fmt::format("{:.6f};{:.8f}\n", s.t, fmt::join(values(s), ";"));
      std::replace(row.begin(), row.end(), '.', ',');
      text += row;
    }
    WriteFile(file(name), text);
  };
  write("Accelerometer.csv",
        "\"Time (s)\";\"X (m/s^2)\";\"Y (m/s^2)\";\"Z (m/s^2)\"\n",
        [](const Sample& s) { return s.accel; });
  write("Gyroscope.csv",
        "\"Time (s)\";\"X (rad/s)\";\"Y (rad/s)\";\"Z (rad/s)\"\n",
        [](const Sample& s) { return s.gyro; });
  std::string fixes =
      "\"Time (s)\";\"Latitude (deg)\";\"Longitude (deg)\";\"Height (m)\"\n";
  for (const Fix& x : fixes_) {
    std::string row =
        fmt::format("{:.1f};{:.9f};{:.9f};{:.4f}\n", x.t, x.lat, x.lon, x.h);
    std::replace(row.begin(), row.end(), '.', ',');
    fixes += row;
  }
  WriteFile(file("Location.csv"), fixes);
  ExpectRight();
}

/// One file between tabs: a fix in some rows, in whole numbers, beside another
/// estimate's and other heights.
TEST_F(LoggedFolder, OfAnAutopilot) {
  std::string text =
      "time_ms\tmode\tGForceX\tGForceY\tGForceZ\tRoll rate\tPitch "
      "rate\tYaw rate\tbaro_alt\tekf_lat\tekf_lon\tgps_lat\tgps_lon\t"
      "gps_alt_msl\tgps_alt_ellipsoid\n";
  std::size_t next = 0;
  for (const Sample& s : samples_) {
    text += fmt::format("{:.0f}\tAUTO", 1e3 * s.t);
    for (const double f : s.accel) {
      text += fmt::format("\t{:.6f}", f / 9.80665);
    }
    for (const double w : s.gyro) {
      text += fmt::format("\t{:.5f}", w * 57.29577951308232);
    }
    text += "\t-1.5";
    // A stamp of its own is within half a row.
    if (next < fixes_.size() && fixes_[next].t <= s.t) {
      const Fix& x = fixes_[next++];
      text += fmt::format("\t{:.7f}\t{:.7f}\t{:.0f}\t{:.0f}\t{:.0f}\t{:.0f}",
                          x.lat + 1e-3, x.lon + 1e-3, 1e7 * x.lat, 1e7 * x.lon,
                          1e3 * (x.h - 46.0), 1e3 * x.h);
    } else {
      text += "\tNA\tNA\t\t\t\t";
    }
    text += "\n";
  }
  WriteFile(file("flight.txt"), text);
  ExpectRight();
}

}  // namespace
}  // namespace hindsight
