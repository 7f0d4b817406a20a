#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
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
      for (const std::size_t column : {2, 5}) {
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

}  // namespace
}  // namespace hindsight
