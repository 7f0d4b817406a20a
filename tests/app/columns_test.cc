#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "app/recording.h"

namespace hindsight {
namespace {

std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

std::vector<std::string> RowsOf(const std::filesystem::path& path) {
  std::vector<std::string> rows = Lines(ReadFile(path));
  std::erase_if(rows, [](const std::string& row) { return row[0] == '#'; });
  return rows;
}

/// The largest difference between the numbers of two files, an angle of a
/// place in metres on the Earth.
double LargestDifference(const std::filesystem::path& a,
                         const std::filesystem::path& b) {
  const auto rows_a = RowsOf(a);
  const auto rows_b = RowsOf(b);
  EXPECT_EQ(rows_a.size(), rows_b.size());
  EXPECT_EQ(rows_a.front(), rows_b.front());
  const std::vector<std::string> titles = Cells(rows_a.front());
  double largest = 0.0;
  for (std::size_t k = 1; k < std::min(rows_a.size(), rows_b.size()); ++k) {
    const auto cells_a = Cells(rows_a[k]);
    const auto cells_b = Cells(rows_b[k]);
    for (std::size_t i = 0; i < titles.size(); ++i) {
      const double size =
          titles[i] == "lat[deg]" || titles[i] == "lon[deg]" ? 1.1e5 : 1.0;
      largest = std::max(largest, size * std::abs(std::stod(cells_a[i]) -
                                                  std::stod(cells_b[i])));
    }
  }
  return largest;
}

constexpr const char* kDrive = R"(
start: {position: [48 deg, 11.5 deg, 500 m], heading: 65 deg}
segments:
  - {type: stop, duration: 10 s}
  - {type: accelerate, speed: 8 m/s, rate: 2 m/s^2}
  - {type: turn, angle: 90 deg, rate: 20 deg/s}
  - {type: straight, duration: 20 s}
imu: {rate: 50 Hz, noise: {gyro: 0.1 deg/sqrt(h), accel: 0.05 m/s/sqrt(h)}}
aiding:
  gnss:
    {type: position, sigma: [0.2 m, 0.3 m, 0.4 m], KEYS
     lever_arm: [0.5 m, 0 m, -1.2 m]}
)";

/// Simulates the drive into DIR and reconstructs it into DIR.run.
void Drive(const std::string& name, const std::string& keys,
           const std::filesystem::path& root) {
  std::string scenario = kDrive;
  scenario.replace(scenario.find("KEYS"), 4, keys);
  WriteFile(root / "scenario.yaml", scenario);
  const Outcome made = Hindsight(
      {"simulate", "scenario.yaml", "--out=" + name, "--seed=3"}, root);
  ASSERT_EQ(made.status, 0) << made.err;
  const Outcome run = Hindsight({"run", name + "/config.yaml",
                                 "--methods=batch", "--out=" + name + ".run"},
                                root);
  ASSERT_EQ(run.status, 0) << run.err << run.out;
}

TEST(LocalPositions, GiveTheResultOfGeodeticOnesInEveryFrame) {
  const TemporaryFolder folder;
  Drive("geodetic", "", folder.path());
  for (const std::string frame : {"ecef", "ned", "enu", "nwu"}) {
    const std::string origin =
        frame == "ecef" ? "" : "origin: [48.03 deg, 11.4 deg, 450 m],";
    Drive(frame, "frame: " + frame + ", " + origin, folder.path());
    const std::string written = ReadFile(folder.path() / frame / "gnss.csv");
    EXPECT_TRUE(written.starts_with("t[s],p_x[m],p_y[m],p_z[m],sigma_x[m]"));
    EXPECT_LT(LargestDifference(folder.path() / "geodetic.run/batch.csv",
                                folder.path() / (frame + ".run") / "batch.csv"),
              2e-6)
        << frame;
    // What was used gives the same again.
    const Outcome again =
        Hindsight({"run", frame + ".run/config.resolved.yaml",
                   "--methods=batch", "--out=" + frame + ".again"},
                  folder.path());
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(ReadFile(folder.path() / (frame + ".run") / "batch.csv"),
              ReadFile(folder.path() / (frame + ".again") / "batch.csv"));
  }
}

TEST(LocalPositions, NeedAnOriginAndLieOnTheEarth) {
  Recording recording;
  const auto refused = [&](const std::string& keys) {
    std::string text = ReadFile(recording.file("config.yaml"));
    text.replace(text.find("type: position"), 14, "type: position\n" + keys);
    WriteFile(recording.file("bad.yaml"), text);
    const Outcome outcome =
        Hindsight({"check", "data/bad.yaml"}, recording.root());
    EXPECT_EQ(outcome.status, 2) << outcome.out;
    return outcome.err;
  };
  EXPECT_NE(refused("    frame: enu\n").find("origin: is missing"),
            std::string::npos);
  EXPECT_NE(refused("    origin: [48 deg, 11 deg, 0 m]\n").find("origin"),
            std::string::npos);
  EXPECT_NE(refused("    frame: ecef\n").find("p_x"), std::string::npos);
  recording.Replace("gnss.csv", "lat[deg],lon[deg],h[m]",
                    "p_x[m],p_y[m],p_z[m]");
  EXPECT_NE(
      refused("    frame: ecef\n    sigma: 1 m\n").find("centre of the Earth"),
      std::string::npos);
}

/// The recording's configuration with `from` in place of `to`.
std::string Edited(const Recording& recording, const std::string& from,
                   const std::string& to) {
  std::string text = ReadFile(recording.file("config.yaml"));
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

constexpr const char* kSpeedByColumns =
    "file: speed.csv\n    format: columns\n    skip_lines: 1\n    columns:\n"
    "      t: 1 [s]\n      v_n: 2 [m/s]\n      v_e: 3 [m/s]\n      V_D\n"
    "      sigma_v_n: 5 [m/s]\n      sigma_v_e: 6 [m/s]\n      SIGMA";

std::string ByColumns(const std::string& v_d, const std::string& sigma) {
  std::string text = kSpeedByColumns;
  text.replace(text.find("V_D"), 3, v_d);
  text.replace(text.find("SIGMA"), 5, sigma);
  return text;
}

TEST(ConstantColumn, GivesTheResultOfAColumnThatRepeatsIt) {
  Recording recording;
  recording.Edit("speed.csv", [](std::vector<std::string>* lines) {
    for (std::size_t k = 1; k < lines->size(); ++k) {
      std::vector<std::string> cells = Cells((*lines)[k]);
      cells[3] = "0";
      cells[6] = "0.2";
      std::string row;
      for (const std::string& cell : cells) {
        row += (row.empty() ? "" : ",") + cell;
      }
      (*lines)[k] = row;
    }
  });
  const auto run = [&](const std::string& name, const std::string& v_d,
                       const std::string& sigma) {
    WriteFile(recording.file("config_" + name + ".yaml"),
              Edited(recording, "file: speed.csv", ByColumns(v_d, sigma)));
    const Outcome outcome = Hindsight({"run", "data/config_" + name + ".yaml",
                                       "--methods=batch", "--out=" + name},
                                      recording.root());
    EXPECT_TRUE(HasResults(outcome)) << outcome.err;
    return ReadFile(recording.root() / name / "batch.csv");
  };
  const std::string column =
      run("column", "v_d: 4 [m/s]", "sigma_v_d: 7 [m/s]");
  EXPECT_EQ(run("constant", "v_d: {constant: 0 m/s}",
                "sigma_v_d: {constant: 20 cm/s}"),
            column);
}

TEST(ConstantColumn, ThatIsAllOfAStreamIsNotTakenForAFrozenSensor) {
  const TemporaryFolder folder;
  WriteFile(folder.path() / "scenario.yaml",
            "start: {position: [48 deg, 11.5 deg, 395 m], heading: 65 deg}\n"
            "segments:\n"
            "  - {type: accelerate, speed: 8 m/s, rate: 2 m/s^2}\n"
            "  - {type: turn, angle: 90 deg, rate: 20 deg/s}\n"
            "  - {type: straight, duration: 60 s}\n"
            "imu: {rate: 50 Hz, noise: {gyro: 0.1 deg/sqrt(h), accel: 0.05 "
            "m/s/sqrt(h)}}\n"
            "aiding:\n  gnss: {type: position, sigma: 0.5 m}\n"
            "  lake: {type: height, sigma: 0.1 m}\n");
  ASSERT_EQ(
      Hindsight({"simulate", "scenario.yaml", "--out=lake"}, folder.path())
          .status,
      0);
  std::string text = ReadFile(folder.path() / "lake/config.yaml");
  const std::string file = "file: lake.csv";
  text.replace(
      text.find(file), file.size(),
      file +
          "\n    format: columns\n    skip_lines: 1\n    columns: {t: "
          "'1 [s]', h: {constant: 395 m}, sigma_h: {constant: 0.1 m}}");
  WriteFile(folder.path() / "lake/constant.yaml", text);
  const Outcome outcome =
      Hindsight({"run", "lake/constant.yaml", "--methods=rts", "--out=out"},
                folder.path());
  EXPECT_TRUE(HasResults(outcome)) << outcome.err;
  EXPECT_EQ(outcome.out.find("repeat"), std::string::npos) << outcome.out;
}

TEST(ConstantColumn, IsRefusedWhereItIsNonsense) {
  Recording recording;
  const auto refused = [&](const std::string& from, const std::string& to) {
    WriteFile(recording.file("bad.yaml"), Edited(recording, from, to));
    const Outcome outcome =
        Hindsight({"check", "data/bad.yaml"}, recording.root());
    EXPECT_EQ(outcome.status, 2) << to;
    return outcome.err;
  };
  const auto speed = [&](const std::string& v_d) {
    return refused("file: speed.csv",
                   ByColumns(v_d, "sigma_v_d: {constant: 0.2 m/s}"));
  };
  EXPECT_NE(speed("v_d: {constant: 0}").find("v_d"), std::string::npos);
  EXPECT_NE(speed("v_d: {constant: 0 m}").find("constant"), std::string::npos);
  EXPECT_NE(speed("v_d: {constant: .nan}").find("constant"), std::string::npos);
  EXPECT_NE(speed("v_d: {constant: 0 m/s, column: 4}").find("column"),
            std::string::npos);
  EXPECT_NE(refused("file: speed.csv",
                    ByColumns("v_d: 4 [m/s]", "sigma_v_d: {constant: 0 m/s}"))
                .find("standard deviation"),
            std::string::npos);
  std::string still = ByColumns("v_d: 4 [m/s]", "sigma_v_d: 7 [m/s]");
  still.replace(still.find("t: 1 [s]"), 8, "t: {constant: 1 s}");
  EXPECT_NE(refused("file: speed.csv", still).find("time"), std::string::npos);
  EXPECT_NE(refused("file: imu.csv",
                    "file: imu.csv\n  format: columns\n  columns: {t: '1 [s]', "
                    "gyro_x: {constant: 0 rad/s}}")
                .find("inertial"),
            std::string::npos);
}

}  // namespace
}  // namespace hindsight
