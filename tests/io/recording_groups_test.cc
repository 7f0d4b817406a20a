#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cmath>

#include "base/units.h"
#include "io/config/recording_draft.h"
#include "io/recording_folder.h"

namespace hindsight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// An IMU that is rocked for 20 s.
std::string RockedImu(double begin, double bias = 0.0) {
  std::string text = "time,ax,ay,az,gx,gy,gz\n";
  for (int k = 0; k < 2000; ++k) {
    const double t = 0.01 * k;
    const double noise = 1e-3 * ((k * 7919) % 13 - 6);
    const double angle = 0.6 * std::sin(t);
    text += fmt::format("{:.2f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n",
                        begin + t, noise, kStandardGravity * std::sin(angle),
                        kStandardGravity * std::cos(angle) - noise,
                        0.6 * std::cos(t) + bias, 0.1 * noise, -0.1 * noise);
  }
  return text;
}

std::string NorthboundFixes(double begin, double lat) {
  std::string text = "time,latitude,longitude,altitude\n";
  for (int k = 0; k < 20; ++k) {
    text += fmt::format("{:.1f},{:.7f},11.5,{:.2f}\n", begin + k,
                        lat + 1e-5 * k, 500.0 + 0.01 * (k % 3));
  }
  return text;
}

class FlatFolder : public RecordingFolder {
 protected:
  std::vector<RecordingDraft> Drafts() const {
    return DraftRecordings(folder_.string());
  }
  static std::vector<std::string> FilesOf(const RecordingDraft& draft) {
    std::vector<std::string> files = {draft.imu->file};
    for (const StreamDraft& stream : draft.aiding) {
      files.push_back(stream.found.file);
    }
    return files;
  }
};

constexpr double kTuesday = 1752564790.0;  // s since 1970
constexpr double kDay = 86400.0;

TEST_F(FlatFolder, TwoDaysAreToldByTheirTimes) {
  Write("a.csv", RockedImu(kTuesday));
  Write("b.csv", RockedImu(kTuesday + kDay));
  Write("c.csv", NorthboundFixes(kTuesday + kDay, 49.0));
  Write("d.csv", NorthboundFixes(kTuesday, 48.0));
  const auto drafts = Drafts();
  ASSERT_EQ(drafts.size(), 2u);
  EXPECT_THAT(FilesOf(drafts[0]), ElementsAre("a.csv", "d.csv"));
  EXPECT_THAT(FilesOf(drafts[1]), ElementsAre("b.csv", "c.csv"));
  EXPECT_NE(drafts[0].name, drafts[1].name);
}

TEST_F(FlatFolder, ADatedStreamOfNoneIsNamed) {
  Write("a.csv", RockedImu(kTuesday));
  Write("b.csv", RockedImu(kTuesday + kDay));
  Write("c.csv", NorthboundFixes(kTuesday + 3.0 * kDay, 49.0));
  for (const RecordingDraft& draft : Drafts()) {
    EXPECT_THAT(draft.aiding, IsEmpty());
    EXPECT_THAT(draft.copies,
                ElementsAre(HasSubstr("c.csv: its times are of none")));
  }
}

TEST_F(FlatFolder, ClocksThatBeginAnewAreToldByNames) {
  Write("imu_1730.csv", RockedImu(0.0));
  Write("imu_1934.csv", RockedImu(0.0, 0.01));
  Write("gnss_1730.csv", NorthboundFixes(0.0, 48.0));
  Write("gnss_1934.csv", NorthboundFixes(0.0, 49.0));
  Write("notes_1934.md", "windy\n");
  const auto drafts = Drafts();
  ASSERT_EQ(drafts.size(), 2u);
  EXPECT_THAT(FilesOf(drafts[0]), ElementsAre("imu_1730.csv", "gnss_1730.csv"));
  EXPECT_THAT(FilesOf(drafts[1]), ElementsAre("imu_1934.csv", "gnss_1934.csv"));
  EXPECT_THAT(drafts[0].unknown, IsEmpty());
  EXPECT_THAT(drafts[1].unknown, ElementsAre("notes_1934.md"));
}

/// Beside an accelerometer and gyros, a magnetometer in each.
TEST_F(FlatFolder, OtherColumnsOfAnImuTellNothing) {
  const auto with_field = [](std::string text) {
    for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; ++at) {
      const std::string field = at < 40 ? ",mx,my,mz" : ",20,1,-44";
      text.insert(at, field);
      at += field.size();
    }
    return text;
  };
  Write("front.csv", with_field(RockedImu(0.0)));
  Write("rear.csv", with_field(RockedImu(0.0, 0.01)));
  Write("gnss.csv", NorthboundFixes(0.0, 48.0));
  ASSERT_EQ(Drafts().size(), 1u);
}

TEST_F(FlatFolder, WhatNothingTellsApartIsRefused) {
  const std::string whole = RockedImu(0.0, 0.01);
  Write("a.csv", RockedImu(0.0));
  Write("b.csv", NorthboundFixes(0.0, 48.0));
  Write("c.csv", whole.substr(0, whole.find('\n', whole.size() / 2) + 1));
  Write("d.csv", NorthboundFixes(0.0, 49.0));
  try {
    Drafts();
    FAIL() << "expected an error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("different times (a.csv, c.csv)"));
    EXPECT_THAT(error.what(),
                HasSubstr("expected a folder for each recording"));
  }
}

TEST_F(FlatFolder, TwoImusOfOneRecordingStayTogether) {
  Write("imu_left.csv", RockedImu(0.0));
  Write("imu_right.csv", RockedImu(0.0, 0.01));
  Write("gnss.csv", NorthboundFixes(0.0, 48.0));
  const auto drafts = Drafts();
  ASSERT_EQ(drafts.size(), 1u);
  EXPECT_EQ(drafts[0].aiding.size(), 1u);
  EXPECT_EQ(drafts[0].unused.size(), 1u);
}

}  // namespace
}  // namespace hindsight
