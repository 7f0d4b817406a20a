#include <gmock/gmock.h>

#include "io/recording_folder.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

class LeavingOut : public RecordingFolder {
 protected:
  LeavingOut() {
    std::string imu =
        "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],accel_x[m/s^2],"
        "accel_y[m/s^2],accel_z[m/s^2]\n";
    for (int i = 0; i < 2000; ++i) {
      imu += std::to_string(0.01 * i) + ",0,0,0,0,0,-9.8\n";
    }
    Write("imu.csv", imu);
  }

  /// Fixes of one file, with further keys of their stream and of the top.
  std::string Config(const std::string& keys, const std::string& top) const {
    return "imu:\n  file: imu.csv\n  noise: {gyro: 1 deg/sqrt(h), accel: 1 "
           "mg/sqrt(Hz)}\naiding:\n  gnss:\n    type: position\n    file: "
           "fixes.csv\n    sigma: 1 m\n" +
           keys + top;
  }
  std::size_t Fixes(const std::string& keys, const std::string& top = "") {
    Write("config.yaml", Config(keys, top));
    return Load().streams.at(0).measurements.size();
  }
};

constexpr const char* kColumns =
    "    format: columns\n    columns: {t: \"1 [s]\", lat: \"2 [deg]\", lon: "
    "\"3 "
    "[deg]\", h: \"4 [m]\"}\n";

TEST_F(LeavingOut, RowsOfTextAreDroppedWhereThatIsAskedFor) {
  Write("fixes.csv",
        "1,50,8,100\nTime,Lat,Lon,H\n2,50,8,100\nmean,50\n3,50,8,100\n");
  Write("config.yaml", Config(kColumns, ""));
  EXPECT_THAT(LoadError(), HasSubstr("fixes.csv:2: "));
  EXPECT_EQ(Fixes(std::string(kColumns) + "    on_text: drop\n"), 3u);
  const Dataset data = Load();
  ASSERT_EQ(data.policies.size(), 1u);
  EXPECT_EQ(data.policies[0].action, "row of text dropped");
  EXPECT_EQ(data.policies[0].count, 2);
}

TEST_F(LeavingOut, RepeatedFixesAreDroppedWhereThatIsAskedFor) {
  Write("fixes.csv",
        "1,50,8,100\n2,50,8,100\n3,50,8,101\n4,50,8,101\n5,50,8,100\n");
  EXPECT_EQ(Fixes(kColumns), 5u);
  EXPECT_EQ(Fixes(std::string(kColumns) + "    on_repeat: drop\n"), 3u);
  EXPECT_EQ(Load().streams[0].measurements[1].t, 3.0);
}

TEST_F(LeavingOut, OmittedSpansAreGone) {
  std::string fixes;
  for (int i = 0; i < 10; ++i) fixes += std::to_string(i) + ",50,8,100\n";
  Write("fixes.csv", fixes);
  EXPECT_EQ(Fixes(kColumns, "omit: [{sensor: gnss, from: 2 s, to: 5 s}]\n"),
            7u);
  EXPECT_EQ(Fixes(kColumns, "omit: [{sensor: position, from: 2 s, to: 5 s}]\n"),
            7u);
  for (const auto& [top, says] :
       {std::pair("omit: [{sensor: gps, from: 2 s, to: 5 s}]\n",
                  "no aiding stream is named or of the type 'gps'"),
        std::pair("omit: [{sensor: gnss, from: 20 s, to: 50 s}]\n",
                  "holds no measurement"),
        std::pair("omit: [{sensor: gnss, from: 0 s, to: 50 s}]\n",
                  "leaves no measurement of gnss"),
        std::pair("omit: [{sensor: gnss, from: 5 s, to: 5 s}]\n",
                  "must lie behind from")}) {
    Write("config.yaml", Config(kColumns, top));
    EXPECT_THAT(LoadError(), HasSubstr(says));
    EXPECT_THAT(LoadError(), HasSubstr("config.yaml:11: "));
  }
}

/// Every message says what to do.
TEST_F(LeavingOut, MessagesSayWhatToDo) {
  Write("fixes.csv", "1,50,8,100\n2,50,8,100\n");
  const auto error = [&](const std::string& keys) {
    Write("config.yaml", Config(keys, ""));
    return LoadError();
  };
  EXPECT_THAT(error("    format: columns\n    columns: {t: 1 [s], lat: 2}\n"),
              HasSubstr("stands in quotes"));
  EXPECT_THAT(
      error("    format: columns\n    columns: {t: \"1 [s]\", sd_n: "
            "\"2 [m]\"}\n"),
      HasSubstr("perhaps 'sd_ne', or one of t, t_rest, week, date, lat"));
  EXPECT_THAT(error("    format: columns\n    columns: {lat: \"2 [deg]\"}\n"),
              HasSubstr("`time: {rate: ...}`"));
  Write("fixes.csv", "lat[deg],lon[deg],h[m]\n50,8,100\n");
  EXPECT_THAT(error(""), HasSubstr("`format: columns` reads titles of any"));
  Write("fixes.csv", "1001,50,8,100\n9001,50,8,100\n");
  EXPECT_THAT(error(kColumns), HasSubstr("is the unit of its t"));
  Write("fixes.csv", "1001,50,8,100\n1010,50,8,100\n");
  EXPECT_THAT(error(kColumns), HasSubstr("give both `time: {start: 0 s}`"));
}

TEST_F(LeavingOut, WhatIsNotConfirmedIsToldByTheLoad) {
  Write("fixes.csv", "1,50,8,100\n2,50,8,100\n");
  Write("config.yaml",
        Config(kColumns, "unconfirmed: [the clock, the axes]\n"));
  ResolvedConfig resolved;
  Load(&resolved);
  EXPECT_THAT(resolved.unconfirmed,
              ::testing::ElementsAre("the clock", "the axes"));
}

}  // namespace
}  // namespace hindsight
