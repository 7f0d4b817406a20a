#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "app/recording.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The files of a recording as somebody's folder, without what `simulate` says
/// of them.
class DraftOf : public ::testing::Test {
 protected:
  DraftOf() {
    for (const char* name : {"config.yaml", "manifest.json", "truth.csv"}) {
      std::filesystem::remove(recording_.file(name));
    }
  }
  Outcome Init(const std::string& out) const {
    return Hindsight({"init", "data", "--out=" + out}, root());
  }
  const std::filesystem::path& root() const { return recording_.root(); }

  Recording recording_;
};

TEST_F(DraftOf, DamagedRowsIsWrittenAndEndsWithTheirPlace) {
  recording_.Edit("gnss.csv", [](std::vector<std::string>* lines) {
    SetColumn(&(*lines)[20], 0, "abc");
  });
  const Outcome init = Init("c.yaml");
  EXPECT_EQ(init.status, 2) << init.out;
  EXPECT_THAT(init.err, HasSubstr("data/gnss.csv:21: column 1 (time): 'abc'"));
  EXPECT_THAT(ReadFile(root() / "c.yaml"), Not(HasSubstr("does not load")));
  const Outcome run = Hindsight({"run", "data", "--out=out"}, root());
  EXPECT_EQ(run.status, 2) << run.out;
  EXPECT_THAT(run.err, HasSubstr("data/gnss.csv:21:"));
  EXPECT_THAT(run.out, Not(HasSubstr("does not load")));
  EXPECT_FALSE(std::filesystem::exists(root() / "out"));
}

/// What a key of the draft itself is about stands at its line in the file that
/// was written, wherever that is.
TEST_F(DraftOf, WhatARunRefusesNamesTheFileThatWasWritten) {
  WriteFile(recording_.file("truth.csv"),
            "t[GPST],lat[deg],lon[deg],h[m]\n"
            "2025-07-08T12:00:00,48,11.5,500\n"
            "2025-07-08T12:00:01,48,11.5,500\n");
  const Outcome init = Init("other name.yaml");
  const Outcome check = Hindsight({"check", "other name.yaml"}, root());
  EXPECT_EQ(init.status, 2) << init.out;
  EXPECT_EQ(check.status, 2) << check.out;
  EXPECT_THAT(init.err, HasSubstr("other name.yaml:"));
  EXPECT_THAT(init.err, HasSubstr("truth has dates"));
  EXPECT_EQ(init.err, check.err);
}

/// Gives the fixes dates, a second apart from noon on.
void DateFixes(Recording* recording) {
  int k = 0;
  recording->Edit("gnss.csv", [&](std::vector<std::string>* lines) {
    lines->front().replace(0, 4, "t[GPST]");
    for (std::size_t i = 1; i < lines->size(); ++i, ++k) {
      const std::string second = (k < 10 ? "0" : "") + std::to_string(k);
      SetColumn(&(*lines)[i], 0, "2025-07-08T12:00:" + second);
    }
  });
}

/// A time tag of RTKLIB, opened half a second after noon, of a log whose last
/// bytes came so many milliseconds later (2.4.3, stream.c).
std::string TimeTag(std::uint32_t milliseconds) {
  std::string tag = "TIMETAG RTKLIB 2.4.3";
  tag.resize(84, '\0');
  const std::uint32_t noon = 1751976000;  // 2025-07-08T12:00:00
  const double fraction = 0.5;
  const std::uint32_t bytes = 1;
  std::memcpy(&tag[64], &noon, 4);
  std::memcpy(&tag[68], &fraction, 8);
  std::memcpy(&tag[76], &milliseconds, 4);
  std::memcpy(&tag[80], &bytes, 4);
  return tag;
}

TEST_F(DraftOf, DatedFixesBesideAnUndatedImuLoads) {
  DateFixes(&recording_);
  const Outcome init = Init("c.yaml");
  EXPECT_EQ(init.status, 0) << init.err;
  EXPECT_THAT(ReadFile(root() / "c.yaml"),
              HasSubstr("imu: its clock has no date"));
}

/// A tag says when bytes came, with what lay in buffers: to tenths of a second it
/// is no reason to stretch the IMU's own stamps; beyond, they are no quartz's.
TEST_F(DraftOf, ATimeTagStretchesTheStampsThatItContradictsAlone) {
  DateFixes(&recording_);
  recording_.Edit("imu.csv", [](std::vector<std::string>* lines) {
    lines->front() = "time,gx,gy,gz,ax,ay,az";  // of no format of its own
  });
  const double span = 50.0;  // of the recording
  for (const double later : {0.0, 0.3, 3.0}) {
    const auto milliseconds =
        static_cast<std::uint32_t>(std::lround(1e3 * (span + later)));
    WriteFile(recording_.file("imu.csv.tag"), TimeTag(milliseconds));
    const Outcome init = Init("c.yaml");
    EXPECT_EQ(init.status, 0) << init.err;
    const std::string draft = ReadFile(root() / "c.yaml");
    EXPECT_THAT(draft,
                HasSubstr("time: {start: 2025-07-08 12:00:00.500000000 GPST"));
    const std::string duration =
        fmt::format("duration: {:.3f} s", 1e-3 * milliseconds);
    if (later > 1.0) {
      EXPECT_THAT(draft, HasSubstr(duration));
    } else {
      EXPECT_THAT(draft, Not(HasSubstr("duration:"))) << later;
    }
    std::filesystem::remove(root() / "c.yaml");
  }
}

TEST_F(DraftOf, RefusesAnOutputThatCannotBeWrittenBeforeItLooks) {
  // A folder that takes no files from anybody; what is to be looked at is not
  // there, which would be said otherwise.
  const Outcome init =
      Hindsight({"init", "nowhere", "--out=/proc/self"}, root());
  EXPECT_EQ(init.status, 4) << init.err;
  EXPECT_THAT(init.err, HasSubstr("/proc/self/NAME.yaml"));
}

TEST_F(DraftOf, AnImuAloneSaysByWhichMethods) {
  for (const char* name : {"gnss.csv", "speed.csv"}) {
    std::filesystem::remove(recording_.file(name));
  }
  const Outcome init = Init("c.yaml");
  EXPECT_EQ(init.status, 0) << init.err;
  EXPECT_THAT(init.out, HasSubstr("attitude alone, by hindsight run c.yaml "
                                  "--methods=ahrs_smoother,ahrs --out=DIR"));
}

TEST_F(DraftOf, GzipDataThatAreCutOffAreSaidToBe) {
  const std::string text = ReadFile(recording_.file("imu.csv"));
  WriteGzip(recording_.file("imu.csv.gz"), text);
  std::filesystem::remove(recording_.file("imu.csv"));
  const auto path = recording_.file("imu.csv.gz");
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const Outcome init = Init("c.yaml");
  EXPECT_EQ(init.status, 2) << init.out;
  EXPECT_THAT(init.err, HasSubstr("imu.csv.gz: is cut off"));
}

}  // namespace
}  // namespace hindsight
