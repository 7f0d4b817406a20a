#include <fmt/core.h>

#include <cmath>
#include <string>

#include "io/config/init_config.h"
#include "io/recording_folder.h"

namespace hindsight {
namespace {

std::string JoinedImu(int from, int to, const std::string& titles) {
  std::string text = titles;
  for (int k = from; k < to; ++k) {
    text += std::to_string(0.01 * k) + ",0,0,0,0,0,-9.8\n";
  }
  return text;
}

constexpr const char* kJoinedTitles =
    "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],accel_x[m/s^2],"
    "accel_y[m/s^2],accel_z[m/s^2]\n";

std::string JoinedConfig(const std::string& files,
                         const std::string& keys = "") {
  return "name: joined\nfolder: .\nimu: {file: " + files + ", " + keys +
         "noise: {gyro: 1 deg/sqrt(h), accel: 1 m/s/sqrt(h)}}\n"
         "initial: {position: [50 deg, 8 deg, 100 m], attitude: [0, 0, 0 deg],"
         " position_sigma: 1 m, attitude_sigma: 1 deg}\n";
}

class JoinedFilesTest : public RecordingFolder {};

TEST_F(JoinedFilesTest, SortedRowsAreNamedByTheirFile) {
  // A stamp that the other file has as well, in the second row of each.
  Write("a.csv", JoinedImu(0, 30, kJoinedTitles));
  Write("b.csv", std::string(kJoinedTitles) + "0.305,0,0,0,0,0,-9.8\n" +
                     "0.01,0,0,0,0,0,-9.8\n0.31,0,0,0,0,0,-9.8\n");
  Write("config.yaml", JoinedConfig("[a.csv, b.csv]", "on_unordered: sort, "));
  EXPECT_NE(LoadError().find("b.csv:3: the stamp is the same"),
            std::string::npos)
      << LoadError();
}

TEST_F(JoinedFilesTest, AreReadAsOne) {
  Write("whole.csv", JoinedImu(0, 90, kJoinedTitles));
  Write("a.csv", JoinedImu(0, 30, kJoinedTitles));
  WriteGzip("b.csv.gz", JoinedImu(30, 60, kJoinedTitles));
  Write("c.csv", JoinedImu(60, 90, kJoinedTitles));
  Write("config.yaml", JoinedConfig("whole.csv"));
  const Dataset whole = Load();
  Write("config.yaml", JoinedConfig("[a.csv, b.csv.gz, c.csv]"));
  ResolvedConfig resolved;
  const Dataset joined = Load(&resolved);
  ASSERT_EQ(joined.imu.samples.size(), whole.imu.samples.size());
  for (std::size_t i = 0; i < whole.imu.samples.size(); ++i) {
    EXPECT_EQ(joined.imu.samples[i].t, whole.imu.samples[i].t);
  }
  EXPECT_NE(resolved.yaml.find("file: [" + Path("a.csv") + ", " +
                               Path("b.csv.gz") + ", " + Path("c.csv") + "]"),
            std::string::npos)
      << resolved.yaml;
  const auto inputs = ConfigInputs(Path("config.yaml"), {});
  ASSERT_EQ(inputs.size(), 4u);
  EXPECT_EQ(inputs[3], Path("c.csv"));
  // What was resolved loads again.
  Write("config.yaml", resolved.yaml);
  EXPECT_EQ(LoadError(), "");
}

TEST_F(JoinedFilesTest, AreOneWhereRowsAreCounted) {
  Write("a.csv", JoinedImu(0, 30, kJoinedTitles));
  Write("b.csv", JoinedImu(0, 30, kJoinedTitles));
  Write("config.yaml",
        JoinedConfig("[a.csv, b.csv]", "time: {rate: 100 Hz}, "));
  const Dataset data = Load();
  ASSERT_EQ(data.imu.samples.size(), 60u);
  EXPECT_DOUBLE_EQ(data.imu.samples.back().t, 0.59);
}

TEST_F(JoinedFilesTest, SecondOfWeekGoesOnOverItsEnd) {
  const auto rows = [](double from) {
    std::string text = kJoinedTitles;
    for (int k = 0; k < 3; ++k) {
      text += std::to_string(from + 0.01 * k) + ",0,0,0,0,0,-9.8\n";
    }
    return text;
  };
  Write("a.csv", rows(604799.97));
  Write("b.csv", rows(0.0));
  Write("config.yaml", JoinedConfig("[a.csv, b.csv]", "time: {week: 2300}, "));
  const Dataset data = Load();
  EXPECT_NEAR(data.imu.t_end() - data.imu.t_begin(), 0.05, 1e-6);
}

TEST_F(JoinedFilesTest, OverlapNamesBothFiles) {
  Write("a.csv", JoinedImu(0, 30, kJoinedTitles));
  Write("b.csv", JoinedImu(20, 60, kJoinedTitles));
  Write("config.yaml", JoinedConfig("[a.csv, b.csv]"));
  EXPECT_EQ(LoadError(),
            "b.csv:2: begins 0.09 s before a.csv ends; expected the files of "
            "`file` in the order of time, none overlapping the next "
            "(on_unordered: sort puts the rows in order)");
  Write("c.csv", JoinedImu(30, 60, kJoinedTitles));
  Write("config.yaml", JoinedConfig("[c.csv, a.csv]"));
  EXPECT_EQ(LoadError().find("a.csv:2: begins 0.59 s before c.csv ends"), 0u)
      << LoadError();
  Write("config.yaml", JoinedConfig("[c.csv, a.csv]", "on_unordered: sort, "));
  EXPECT_EQ(LoadError(), "");
  EXPECT_EQ(Load().imu.samples.size(), 60u);
}

TEST_F(JoinedFilesTest, OfOtherColumnsAreRefused) {
  Write("a.txt", "0 1 2 3 4 5 6\n0.01 1 2 3 4 5 6\n");
  Write("b.txt", "0.02 1 2 3 4 5 6 7\n0.03 1 2 3 4 5 6 7\n");
  const std::string columns =
      "format: columns, columns: {t: \"1 [s]\", gyro_x: \"2 [rad/s]\", "
      "gyro_y: \"3 [rad/s]\", gyro_z: \"4 [rad/s]\", accel_x: \"5 [m/s^2]\", "
      "accel_y: \"6 [m/s^2]\", accel_z: \"7 [m/s^2]\"}, ";
  Write("config.yaml", JoinedConfig("[a.txt, b.txt]", columns));
  EXPECT_EQ(LoadError(),
            "b.txt:1: has 8 columns, and a.txt 7; expected files of one stream "
            "with the same columns");
  Write("a.csv", JoinedImu(0, 30, kJoinedTitles));
  Write("b.csv", "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s]\n0.3,0,0,0\n");
  Write("config.yaml", JoinedConfig("[a.csv, b.csv]"));
  EXPECT_EQ(LoadError(),
            "b.csv: has no column accel_x, unlike a.csv; expected files of one "
            "stream with the same columns");
}

TEST_F(JoinedFilesTest, ListsAreChecked) {
  Write("a.csv", JoinedImu(0, 30, kJoinedTitles));
  Write("config.yaml", JoinedConfig("[]"));
  EXPECT_EQ(LoadError(),
            "config.yaml:3: imu.file: expected a file, or a list of files");
  Write("config.yaml", JoinedConfig("[a.csv, a.csv]"));
  EXPECT_EQ(LoadError(), "config.yaml:3: imu.file: a.csv stands twice");
  Write("config.yaml", JoinedConfig("[a.csv, b.csv]"));
  EXPECT_EQ(LoadError(), "config.yaml:3: imu.file: there is no file b.csv");
}

TEST_F(JoinedFilesTest, InitJoinsWhatGoesOn) {
  Write("imu_1.csv", JoinedImu(0, 30, kJoinedTitles));
  Write("imu_2.csv", JoinedImu(30, 60, kJoinedTitles));
  WriteGzip("imu_10.csv.gz", JoinedImu(60, 90, kJoinedTitles));
  const std::string titles =
      "t[s],lat[deg],lon[deg],h[m],sigma_n[m],sigma_e[m],sigma_d[m]\n";
  // Two receivers at a time are two streams.
  Write("gnss1.csv", titles + "0,50,8,100,1,1,1\n0.5,50,8,100,1,1,1\n");
  Write("gnss2.csv", titles + "0,50,8,102,1,1,1\n0.5,50,8,102,1,1,1\n");
  // A copy of one is none.
  WriteGzip("gnss3.csv.gz", titles + "0,50,8,102,1,1,1\n0.5,50,8,102,1,1,1\n");
  const auto drafts = DraftRecordings(folder_.string());
  ASSERT_EQ(drafts.size(), 1u);
  const std::string config = DraftText(drafts.front());
  EXPECT_NE(config.find("file: [\"imu_1.csv\", \"imu_2.csv\", "
                        "\"imu_10.csv.gz\"]  # parts of one stream: the same "
                        "columns, names that differ by a number, and stamps "
                        "that go on within 0.01 s"),
            std::string::npos)
      << config;
  EXPECT_NE(config.find("# Not used: gnss3.csv.gz, which begins with the rows "
                        "of gnss2.csv\n"),
            std::string::npos)
      << config;
  Write("config.yaml", config);
  EXPECT_EQ(LoadError(), "");
  const Dataset data = Load();
  EXPECT_EQ(data.imu.samples.size(), 90u);
  EXPECT_EQ(data.streams.size(), 2u);
}

/// Rows of a logger that writes titles once.
std::string RockedRows(int from, int to, const std::string& titles) {
  std::string text = titles;
  for (int k = from; k < to; ++k) {
    const double t = 0.01 * k;
    const double angle = 0.6 * std::sin(t);
    text += fmt::format("{:.2f},{:.4f},{:.6f},{:.6f},{:.6f},0.001,0.002\n", t,
                        1e-3 * (k % 7), 9.8 * std::sin(angle),
                        9.8 * std::cos(angle), 0.6 * std::cos(t));
  }
  return text;
}

std::string RowsOfFixes(int from, int to, const std::string& titles) {
  std::string text = titles;
  for (int k = from; k < to; ++k) {
    text += fmt::format("{}.0,{:.7f},11.5000000,{:.2f}\n", k, 48.0 + 1e-5 * k,
                        500.0 + 0.1 * (k % 3));
  }
  return text;
}

constexpr const char* kLoggerTitles = "time,ax,ay,az,gx,gy,gz\n";
constexpr const char* kFixTitles = "time,latitude,longitude,altitude\n";

TEST_F(JoinedFilesTest, PartsWithoutTitlesGoOn) {
  Write("imu_1.csv", RockedRows(0, 1500, kLoggerTitles));
  Write("imu_2.csv", RockedRows(1500, 3000, ""));
  Write("gps_1.csv", RowsOfFixes(0, 15, kFixTitles));
  Write("gps_2.csv", RowsOfFixes(15, 30, ""));
  const auto drafts = DraftRecordings(folder_.string());
  ASSERT_EQ(drafts.size(), 1u);
  EXPECT_TRUE(drafts[0].unused.empty());
  Write("config.yaml", DraftText(drafts[0]));
  ASSERT_EQ(LoadError(), "") << Read("config.yaml");
  const Dataset data = Load();
  EXPECT_EQ(data.imu.samples.size(), 3000u);
  ASSERT_EQ(data.streams.size(), 1u) << Read("config.yaml");
  EXPECT_EQ(data.streams[0].measurements.size(), 30u);
}

TEST_F(JoinedFilesTest, APartWithoutTitlesThatDoesNotGoOnIsNamed) {
  Write("imu.csv", RockedRows(0, 3000, kLoggerTitles));
  Write("gps_1.csv", RowsOfFixes(0, 15, kFixTitles));
  Write("gps_2.csv", RowsOfFixes(10, 30, ""));
  const auto drafts = DraftRecordings(folder_.string());
  ASSERT_EQ(drafts.size(), 1u);
  EXPECT_EQ(drafts[0].aiding.size(), 1u);
  const std::string text = DraftText(drafts[0]);
  EXPECT_NE(text.find("gps_2.csv: its numbers were not recognised"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace hindsight
