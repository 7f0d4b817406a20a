#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST_F(DraftOf, DatedFixesBesideAnUndatedImuLoads) {
  int k = 0;
  recording_.Edit("gnss.csv", [&](std::vector<std::string>* lines) {
    lines->front().replace(0, 4, "t[GPST]");
    for (std::size_t i = 1; i < lines->size(); ++i, ++k) {
      const std::string second = (k < 10 ? "0" : "") + std::to_string(k);
      SetColumn(&(*lines)[i], 0, "2025-07-08T12:00:" + second);
    }
  });
  const Outcome init = Init("c.yaml");
  EXPECT_EQ(init.status, 0) << init.err;
  EXPECT_THAT(ReadFile(root() / "c.yaml"),
              HasSubstr("imu: its clock has no date"));
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
