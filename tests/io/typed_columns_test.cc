#include <fmt/core.h>
#include <gmock/gmock.h>

#include "io/read/file_columns.h"
#include "io/recording_folder.h"

namespace hindsight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class TypedColumns : public RecordingFolder {
 protected:
  std::vector<FileColumns> Tables(const std::string& text) const {
    Write("log.txt", text);
    return ReadTypedColumns((folder_ / "log.txt").string());
  }
};

/// ArduPilot tells the columns of each message by messages.
TEST_F(TypedColumns, OfAnAutopilotAreTitledByItsFormats) {
  std::string text =
      "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n"
      "FMT, 129, 35, IMU, Qffffff, TimeUS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ\n"
      "FMT, 130, 50, GPS, QBLLe, TimeUS,Status,Lat,Lng,Alt\n";
  for (int k = 0; k < 50; ++k) {
    text += fmt::format("IMU, {}, 0.1, 0.2, 0.3, 1, 2, {}\n", 10000 * k, -k);
    if (k % 10 == 0) {
      text += fmt::format("GPS, {}, 3, 48.1, 11.2, {}\n", 10000 * k, 500 + k);
    }
  }
  const auto tables = Tables(text);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].row_word, (RowWord{0, "IMU"}));
  EXPECT_EQ(tables[0].rows, 50u);
  EXPECT_EQ(tables[0].columns[7].title, "AccZ");
  EXPECT_EQ(tables[0].columns[7].values[49], -49.0);
  EXPECT_EQ(tables[1].row_word.word, "GPS");
  EXPECT_EQ(tables[1].columns[5].title, "Alt");
  EXPECT_THAT(tables[1].columns[5].values,
              ElementsAre(500.0, 510.0, 520.0, 530.0, 540.0));
}

/// Its "I" counts devices of a kind; of a kind of which there is one it parts
/// nothing.
TEST_F(TypedColumns, OfSeveralDevicesAreApart) {
  std::string text =
      "FMT, 129, 35, IMU, QBfff, TimeUS,I,GyrX,GyrY,GyrZ\n"
      "FMT, 130, 35, MAG, QBfff, TimeUS,I,MagX,MagY,MagZ\n"
      "FMT, 131, 35, BAT, Qfff, TimeUS,I,Volt,Temp\n";
  for (int k = 0; k < 30; ++k) {
    text += fmt::format(
        "IMU, {0}, 0, 1, 0, {0}\nIMU, {0}, 1, 2, 0, {0}\nMAG, {0}, 0, 7, 8, "
        "9\nBAT, {0}, 0.1{0}, 12, 20\n",
        10000 * k);
  }
  const auto tables = Tables(text);
  ASSERT_EQ(tables.size(), 4u);
  EXPECT_EQ(tables[0].row_word, (RowWord{0, "IMU", 2, "0"}));
  EXPECT_EQ(tables[0].row_word.Name(), "IMU 0");
  EXPECT_EQ(tables[1].row_word, (RowWord{0, "IMU", 2, "1"}));
  EXPECT_EQ(tables[1].rows, 30u);
  EXPECT_EQ(tables[1].columns[3].values[29], 2.0);
  EXPECT_EQ(tables[2].row_word, (RowWord{0, "MAG"}));
  EXPECT_EQ(tables[3].row_word, (RowWord{0, "BAT"}));
  EXPECT_EQ(tables[3].rows, 30u);
}

/// The word may stand in another column, below titles that all rows share.
TEST_F(TypedColumns, OfRowsOfOneWidthAreToldByNamesOfSensors) {
  std::string text = "time,sensor,x,y,z\n";
  for (int k = 0; k < 20; ++k) {
    text += fmt::format("{0},accelerometer,{0},0,9.8\n{0},gyroscope,0,0,-{0}\n",
                        0.01 * k);
  }
  const auto tables = Tables(text);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[1].row_word, (RowWord{1, "gyroscope"}));
  EXPECT_EQ(tables[1].columns[2].title, "x");
  EXPECT_NEAR(tables[1].columns[4].values[19], -0.19, 1e-12);
}

/// Without titles, and fixes below titles that name axes.
TEST_F(TypedColumns, OfRowsWithoutTitlesAreAxesOrFixes) {
  std::string text;
  for (int k = 0; k < 20; ++k) {
    text += fmt::format("{0},gyroscope,{0},0,0.1\n{0},location,48,11,500\n",
                        0.01 * k);
  }
  EXPECT_EQ(Tables(text)[0].columns[2].title, "x");
  const auto titled = Tables("time,sensor,x,y,z\n" + text);
  EXPECT_EQ(titled[0].columns[4].title, "z");
  EXPECT_EQ(titled[1].columns[2].title, "");
}

/// What somebody noted of each row parts nothing.
TEST_F(TypedColumns, NotesBesideRowsArePartOfThem) {
  std::string text = "time,activity,ax,ay,az\n";
  for (int k = 0; k < 40; ++k) {
    text += fmt::format("{},{},0,0,9.8\n", 0.01 * k,
                        k / 5 % 2 == 0 ? "walking" : "standing");
  }
  EXPECT_TRUE(Tables(text).empty());
}

class RowsOfAWord : public RecordingFolder {
 protected:
  void WriteConfig(const std::string& rows) const {
    std::string text = "ACCE;0.000;9;9;9\n";
    for (int k = 0; k < 400; ++k) {
      text += fmt::format("IMU;{};0.01;0.02;0.03;0;0;-9.81\nACCE;{};1;2;3\n",
                          0.01 * k, 0.01 * k);
    }
    Write("log.txt", text);
    Write(
        "config.yaml",
        "name: x\nimu:\n  file: log.txt\n  format: columns\n  " + rows +
            "\n  columns: {t: \"2 [s]\", gyro_x: \"3 [rad/s]\", gyro_y: \"4 "
            "[rad/s]\", gyro_z: \"5 [rad/s]\", accel_x: \"6 [m/s^2]\", "
            "accel_y: \"7 [m/s^2]\", accel_z: \"8 [m/s^2]\"}\n  noise: {gyro: "
            "0.1 deg/sqrt(h), accel: 0.1 m/s/sqrt(h)}\n");
  }
};

TEST_F(RowsOfAWord, AreTheStream) {
  WriteConfig("rows: {word: IMU}");
  ASSERT_EQ(LoadError(), "");
  const ImuStream imu = Load().imu;
  ASSERT_EQ(imu.samples.size(), 400u);
  EXPECT_EQ(imu.samples[399].gyro.z(), 0.03);
}

TEST_F(RowsOfAWord, ThatNoRowHasAreRefused) {
  WriteConfig("rows: {column: 1, word: GYRO}");
  EXPECT_THAT(LoadError(),
              HasSubstr("log.txt: the file holds no rows that have "
                        "'GYRO' in column 1"));
  WriteConfig("rows: {column: 0, word: IMU}");
  EXPECT_THAT(LoadError(), HasSubstr("rows.column: expected 1 or more"));
  WriteConfig("rows: {column: 1}");
  EXPECT_THAT(LoadError(), HasSubstr("rows.word: is missing"));
}

}  // namespace
}  // namespace hindsight
