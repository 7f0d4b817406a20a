#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/recording.h"

namespace hindsight {
namespace {

constexpr const char* kNewcomersDrive = R"(
start: {position: [48 deg, 11.5 deg, 500 m], heading: 65 deg}
segments:
  - {type: stop, duration: 20 s}
  - {type: accelerate, speed: 10 m/s, rate: 2 m/s^2}
  - {type: turn, angle: 90 deg, rate: 15 deg/s}
  - {type: straight, duration: 10 s}
  - {type: accelerate, speed: 4 m/s, rate: 2 m/s^2}
  - {type: turn, angle: -120 deg, rate: 20 deg/s}
  - {type: accelerate, speed: 12 m/s, rate: 1.5 m/s^2}
  - {type: straight, duration: 10 s}
  - {type: turn, angle: 180 deg, rate: 15 deg/s}
  - {type: accelerate, speed: 0 m/s, rate: 2 m/s^2}
  - {type: stop, duration: 10 s}
imu: {rate: 100 Hz, kind: rates, noise: {gyro: 0.3 deg/sqrt(h), accel: 0.1 m/s/sqrt(h)}}
aiding:
  gnss: {type: position, rate: 5 Hz, sigma: [0.05 m, 0.05 m, 0.1 m]}
)";

std::vector<std::vector<std::string>> CellsOf(
    const std::filesystem::path& path) {
  std::vector<std::vector<std::string>> rows;
  for (const std::string& line : Lines(ReadFile(path))) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream in(line);
    rows.emplace_back();
    for (std::string cell; std::getline(in, cell, ',');) {
      rows.back().push_back(cell);
    }
  }
  rows.erase(rows.begin());  // titles
  return rows;
}

/// A drive as a phone's logger might have left it: titles without units, fixes
/// split over three files, notes of a spreadsheet below the last.
class Newcomer : public ::testing::Test {
 protected:
  void SetUp() override {
    WriteFile(root() / "scenario.yaml", kNewcomersDrive);
    const Outcome made = Hindsight(
        {"simulate", "scenario.yaml", "--out=made", "--seed=5"}, root());
    ASSERT_EQ(made.status, 0) << made.err;
    std::filesystem::create_directory(root() / "drive");
    std::string imu = "time,ax,ay,az,gx,gy,gz\n";
    for (const auto& row : CellsOf(root() / "made/imu.csv")) {
      imu += fmt::format("{},{},{},{},{},{},{}\n", row[0], row[4], row[5],
                         row[6], row[1], row[2], row[3]);
    }
    WriteFile(root() / "drive/imu.csv", imu);
    const auto fixes = CellsOf(root() / "made/gnss.csv");
    const std::size_t third = fixes.size() / 3 + 1;
    for (std::size_t part = 0; part < 3; ++part) {
      std::string text = "time,latitude,longitude,altitude\n";
      for (std::size_t k = part * third;
           k < std::min((part + 1) * third, fixes.size()); ++k) {
        text += fmt::format("{},{},{},{}\n", fixes[k][0], fixes[k][1],
                            fixes[k][2], fixes[k][3]);
      }
      if (part == 2) text += "\nDriven by:,Anna,,\nfixes in all,,,\n";
      WriteFile(root() / fmt::format("drive/gps_{}.csv", part + 1), text);
    }
    WriteFile(root() / "drive/notes.txt", "Sunny, dry road.\n");
    WriteGzip(root() / "drive/gps_2.csv.gz",
              ReadFile(root() / "drive/gps_2.csv"));
    std::string mystery = "a,b\n";
    for (int i = 0; i < 20; ++i) mystery += fmt::format("{0},{0}\n", i % 3);
    WriteFile(root() / "drive/mystery.csv", mystery);
  }

  const std::filesystem::path& root() const { return folder_.path(); }

  TemporaryFolder folder_;
};

TEST_F(Newcomer, InitJoinsTheFixesAndNamesTheNotes) {
  const Outcome init = Hindsight({"init", "drive", "--out=c.yaml"}, root());
  ASSERT_EQ(init.status, 0) << init.err;
  const std::string config = ReadFile(root() / "c.yaml");
  constexpr const char* kParts =
      "file: [\"gps_1.csv\", \"gps_2.csv\", \"gps_3.csv\"]  # parts of one "
      "stream: the same columns, names that differ by a number";
  for (const char* text :
       {kParts, "# gps_3.csv: 2 rows further down are no rows of numbers",
        "on_text: drop", "#   notes.txt",
        "# Not used: gps_2.csv.gz, which begins with the rows of gps_2.csv\n",
        "mystery.csv: its numbers were not recognised, and are left out",
        "accel_x: \"2 [m/s^2]\"", "gyro_z: \"7 [rad/s]\""}) {
    EXPECT_NE(config.find(text), std::string::npos) << text << "\n" << config;
  }
  EXPECT_EQ(config.find("position2"), std::string::npos) << config;
  EXPECT_EQ(config.find("notes.txt: its numbers"), std::string::npos);
  // The draft itself can be checked.
  const Outcome check = Hindsight({"check", "c.yaml"}, root());
  EXPECT_NE(check.status, 2) << check.err;
}

TEST_F(Newcomer, RunOfTheFolderIsRightAndKnowsEveryPart) {
  const Outcome run = Hindsight({"run", "drive", "--out=out"}, root());
  ASSERT_TRUE(HasResults(run)) << run.err << run.out;
  // Doubtful while what was taken for granted is not confirmed.
  EXPECT_EQ(run.status, 3) << run.out;
  EXPECT_NE(run.out.find("taken for granted"), std::string::npos) << run.out;
  const auto summary =
      nlohmann::json::parse(ReadFile(root() / "out/summary.json"));
  std::vector<std::string> inputs;
  for (const auto& input : summary["inputs"]) {
    inputs.push_back(
        std::filesystem::path(input["path"].get<std::string>()).filename());
  }
  EXPECT_EQ(inputs,
            (std::vector<std::string>{"out.yaml", "imu.csv", "gps_1.csv",
                                      "gps_2.csv", "gps_3.csv"}));
  const Outcome judged = Hindsight(
      {"evaluate", "out/batch.csv", "made/truth.csv", "--json"}, root());
  ASSERT_TRUE(HasResults(judged)) << judged.err;
  const auto figures = nlohmann::json::parse(judged.out);
  EXPECT_LT(figures["errors"]["position_total"]["rms"].get<double>(), 0.5)
      << judged.out;
  // How the IMU sits in the vehicle is guessed, and known no better than so.
  EXPECT_LT(figures["nees"]["attitude"].get<double>(), 10.0) << judged.out;
}

TEST_F(Newcomer, TheMotionTellsWhichIsTheLatitudeAndItsUnit) {
  for (const char* name :
       {"gps_1.csv", "gps_2.csv", "gps_3.csv", "gps_2.csv.gz", "mystery.csv"}) {
    std::filesystem::remove(root() / "drive" / name);
  }
  const auto fixes = CellsOf(root() / "made/gnss.csv");
  const auto init = [&](const std::string& text) {
    WriteFile(root() / "drive/places.csv", text);
    const Outcome outcome =
        Hindsight({"init", "drive", "--out=c.yaml", "--force"}, root());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return ReadFile(root() / "c.yaml");
  };
  std::string east_first;
  std::string radians = "time,latitude,longitude,altitude\n";
  for (const auto& row : fixes) {
    east_first += fmt::format("{},{},{},{}\n", row[0], row[2], row[1], row[3]);
    constexpr double kDegrees = 57.29577951308232;
    radians += fmt::format("{},{:.11f},{:.11f},{}\n", row[0],
                           std::stod(row[1]) / kDegrees,
                           std::stod(row[2]) / kDegrees, row[3]);
  }
  const std::string swapped = init(east_first);
  EXPECT_NE(swapped.find("lat: \"3 [deg]\""), std::string::npos) << swapped;
  EXPECT_NE(swapped.find("lon: \"2 [deg]\""), std::string::npos) << swapped;
  EXPECT_NE(swapped.find("the longitude is taken to stand before"),
            std::string::npos)
      << swapped;
  const std::string scaled = init(radians);
  EXPECT_NE(scaled.find("lat: \"2 [rad]\""), std::string::npos) << scaled;
  EXPECT_NE(scaled.find("lon: \"3 [rad]\""), std::string::npos) << scaled;
}

TEST_F(Newcomer, GyrosOfTheOtherSignAreTurnedRound) {
  std::string imu = "time,ax,ay,az,gx,gy,gz\n";
  for (const auto& row : CellsOf(root() / "made/imu.csv")) {
    imu +=
        fmt::format("{},{},{},{},{},{},{}\n", row[0], row[4], row[5], row[6],
                    -std::stod(row[1]), -std::stod(row[2]), -std::stod(row[3]));
  }
  WriteFile(root() / "drive/imu.csv", imu);
  const Outcome run = Hindsight(
      {"run", "drive", "--yes", "--methods=rts,batch", "--out=out"}, root());
  EXPECT_EQ(run.status, 0) << run.out;
  EXPECT_NE(run.out.find("taken for granted: imu: the gyros are taken for ones "
                         "of the other sign"),
            std::string::npos)
      << run.out;
  EXPECT_EQ(run.out.find("declared as"), std::string::npos) << run.out;
  const Outcome judged = Hindsight(
      {"evaluate", "out/batch.csv", "made/config.yaml", "--json"}, root());
  const auto errors = nlohmann::json::parse(judged.out)["errors"];
  EXPECT_LT(errors["position_total"]["rms"].get<double>(), 3.0);
  EXPECT_LT(errors["heading"]["rms"].get<double>(), 3.0);
}

TEST_F(Newcomer, PartsGiveTheResultOfTheWhole) {
  const std::string config = ReadFile(root() / "made/config.yaml");
  const auto run = [&](const std::string& files, const std::string& out) {
    std::string text = config;
    const std::string one = "file: gnss.csv";
    WriteFile(root() / "made/parts.yaml",
              text.replace(text.find(one), one.size(), "file: " + files));
    return Hindsight(
        {"run", "made/parts.yaml", "--methods=rts", "--out=" + out}, root());
  };
  std::vector<std::string> rows = Lines(ReadFile(root() / "made/gnss.csv"));
  const std::string titles = rows.front();
  const auto middle = rows.begin() + 100;
  WriteFile(root() / "made/a.csv", Join({rows.begin(), middle}));
  std::vector<std::string> rest(middle, rows.end());
  rest.insert(rest.begin(), titles);
  WriteGzip(root() / "made/b.csv.gz", Join(rest));
  ASSERT_TRUE(HasResults(run("gnss.csv", "whole")));
  ASSERT_TRUE(HasResults(run("[a.csv, b.csv.gz]", "parts")));
  EXPECT_EQ(ReadFile(root() / "whole/rts.csv"),
            ReadFile(root() / "parts/rts.csv"));
  const Outcome twice = run("[gnss.csv, b.csv.gz]", "twice");
  EXPECT_EQ(twice.status, 2);
  EXPECT_NE(twice.err.find("b.csv.gz:2: begins "), std::string::npos)
      << twice.err;
  EXPECT_NE(twice.err.find("gnss.csv ends"), std::string::npos) << twice.err;
  EXPECT_FALSE(std::filesystem::exists(root() / "twice"));
}

}  // namespace
}  // namespace hindsight
