#include <fmt/chrono.h>
#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cmath>

#include "base/units.h"
#include "io/config/init_config.h"
#include "io/read/file_columns.h"
#include "io/read/time_scale.h"
#include "io/recording_folder.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

/// 2025-07-12 23:59:50 UTC, so that a record of half a minute runs over midnight.
constexpr std::int64_t kUnixBegin = 1752364790;
constexpr int kImuRows = 3000;
constexpr double kImuRate = 100.0;
constexpr double kFixDelay = 0.5;  // s

/// How a date is written: of t seconds since the begin.
struct DateSpelling {
  const char* name;
  const char* imu_title;  ///< of the date's one or two columns
  const char* fix_title;
  const char* format;  ///< of fmt, with seconds behind
  char delimiter = ',';
  const char* zone = "";
  double zone_hours = 0.0;
};

void PrintTo(const DateSpelling& spelling, std::ostream* out) {
  *out << spelling.name;
}

std::string DateOf(const DateSpelling& spelling, double t) {
  const std::int64_t ms = std::llround(1e3 * t);
  const auto zone = std::llround(3600.0 * spelling.zone_hours);
  return fmt::format(fmt::runtime(spelling.format),
                     fmt::gmtime(static_cast<std::time_t>(kUnixBegin + zone +
                                                          ms / 1000))) +
         fmt::format(".{:03}{}", ms % 1000, spelling.zone);
}

std::string JoinedBy(char delimiter, std::initializer_list<std::string> words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : std::string(1, delimiter)) + word;
  }
  return text + "\n";
}

class DatedFolder : public RecordingFolder,
                    public ::testing::WithParamInterface<DateSpelling> {
 protected:
  void WriteRecording(const DateSpelling& spelling) const {
    const char d = spelling.delimiter;
    std::string imu =
        JoinedBy(d, {spelling.imu_title, "ax", "ay", "az", "gx", "gy", "gz"});
    for (int k = 0; k < kImuRows; ++k) {
      const double t = k / kImuRate;
      const double phase = std::max(0.0, t - 5.0);
      const double angle = 0.6 * std::sin(phase);
      const double rate = phase > 0.0 ? 0.6 * std::cos(phase) : 0.0;
      const double noise = 1e-3 * ((k * 7919) % 13 - 6);
      imu += JoinedBy(
          d, {DateOf(spelling, t), fmt::format("{:.6f}", noise),
              fmt::format("{:.6f}", kStandardGravity * std::sin(angle)),
              fmt::format("{:.6f}", kStandardGravity * std::cos(angle)),
              fmt::format("{:.6f}", rate), fmt::format("{:.6f}", 0.1 * noise),
              fmt::format("{:.6f}", -0.1 * noise)});
    }
    Write("imu.txt", imu);
    std::string fixes =
        JoinedBy(d, {spelling.fix_title, "latitude", "longitude", "altitude"});
    for (int k = 0; k < 29; ++k) {
      fixes += JoinedBy(d, {DateOf(spelling, k + kFixDelay),
                            fmt::format("{:.7f}", 48.0 + 1e-5 * k), "11.5",
                            fmt::format("{:.2f}", 500.0 + 0.01 * (k % 3))});
    }
    Write("gps.txt", fixes);
  }
};

TEST_P(DatedFolder, ItsDatesAreTheTimes) {
  WriteRecording(GetParam());
  const auto drafts = DraftRecordings(folder_.string());
  ASSERT_EQ(drafts.size(), 1u);
  const std::string text = DraftText(drafts[0]);
  EXPECT_TRUE(drafts[0].assumptions.empty()) << text;
  Write("config.yaml", text);
  ASSERT_EQ(LoadError(), "") << text;
  const Dataset data = Load();
  ASSERT_NEAR(static_cast<double>(data.imu.samples.size()), kImuRows, 2.0);
  EXPECT_NEAR(data.imu.nominal_dt, 1.0 / kImuRate, 1e-6);
  const std::int64_t leap = std::string(GetParam().imu_title) == "gps_time"
                                ? 0
                                : LeapSeconds(kUnixBegin);
  ASSERT_TRUE(data.epoch_gps_ns);
  EXPECT_EQ(*data.epoch_gps_ns,
            (kUnixBegin - kGpsEpochUnix + leap) * 1'000'000'000);
  ASSERT_EQ(data.streams.size(), 1u);
  ASSERT_EQ(data.streams[0].measurements.size(), 29u);
  EXPECT_NEAR(data.streams[0].measurements[0].t, kFixDelay, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(
    All, DatedFolder,
    ::testing::Values(
        DateSpelling{"Iso", "timestamp", "timestamp", "{:%Y-%m-%dT%H:%M:%S}"},
        DateSpelling{"IsoZulu", "time", "time", "{:%Y-%m-%dT%H:%M:%S}", ',',
                     "Z"},
        DateSpelling{"IsoZone", "logged at", "logged at",
                     "{:%Y-%m-%dT%H:%M:%S}", ';', "+02:00", 2.0},
        DateSpelling{"Blank", "Date Time (UTC)", "Date Time (UTC)",
                     "{:%Y-%m-%d %H:%M:%S}"},
        DateSpelling{"Gpst", "gps_time", "gps_time", "{:%Y/%m/%d %H:%M:%S}"},
        DateSpelling{"TwoColumns", "date,clock", "date,clock",
                     "{:%Y-%m-%d,%H:%M:%S}"},
        DateSpelling{"TwoByBlanks", "date time", "date time",
                     "{:%Y/%m/%d %H:%M:%S}", ' '},
        DateSpelling{"DayFirst", "Date", "Date", "{:%d/%m/%Y %H:%M:%S}"},
        DateSpelling{"MonthFirst", "Date", "Date", "{:%m/%d/%Y %H:%M:%S}"},
        DateSpelling{"DaysAndPoints", "Datum", "Datum", "{:%d.%m.%Y %H:%M:%S}",
                     ';'},
        DateSpelling{"OneTitleForTwo", "time", "time", "{:%Y-%m-%d %H:%M:%S}",
                     ' '}),
    [](const auto& info) { return std::string(info.param.name); });

/// 11 and 12 could both be months: what lies closer together is right.
TEST_F(RecordingFolder, DatesOfEitherOrderAreOfOneNight) {
  const auto order_of = [&](const char* before, const char* behind) {
    std::string text = "Date,a,b\n";
    for (int k = 0; k < 10; ++k) {
      text += fmt::format("{} 11:59:5{} PM,{},1.5\n", before, k, k);
    }
    for (int k = 0; k < 10; ++k) {
      text += fmt::format("{} 12:00:0{} AM,{},1.5\n", behind, k, k);
    }
    Write("log.csv", text);
    const auto file = ReadTextColumns(Path("log.csv"));
    EXPECT_EQ(file->rows, 20u);
    EXPECT_TRUE(file->columns[0].order_told);
    EXPECT_EQ(file->columns[0].values[19] - file->columns[0].values[0], 19.0);
    return file->columns[0].date_order;
  };
  EXPECT_EQ(order_of("11/06/2025", "12/06/2025"), DateOrder::kDayFirst);
  EXPECT_EQ(order_of("06/11/2025", "06/12/2025"), DateOrder::kMonthFirst);
}

class DatedImu : public DatedFolder {};

class OfDay : public DatedFolder {};

TEST_P(OfDay, AloneCountsOnOverMidnight) {
  WriteRecording(GetParam());
  const auto drafts = DraftRecordings(folder_.string());
  const std::string text = DraftText(drafts.at(0));
  EXPECT_THAT(text, HasSubstr("t: \"1 [hms]\""));
  Write("config.yaml", text);
  ASSERT_EQ(LoadError(), "") << text;
  const Dataset data = Load();
  EXPECT_FALSE(data.epoch_gps_ns);
  EXPECT_NEAR(static_cast<double>(data.imu.samples.size()), kImuRows, 2.0);
  EXPECT_NEAR(data.imu.nominal_dt, 1.0 / kImuRate, 1e-6);
  ASSERT_EQ(data.streams.size(), 1u);
  EXPECT_NEAR(
      data.streams[0].measurements[1].t - data.streams[0].measurements[0].t,
      1.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(
    All, OfDay,
    ::testing::Values(DateSpelling{"Colons", "time", "time", "{:%H:%M:%S}"},
                      DateSpelling{"Digits", "utc_time", "utc_time",
                                   "{:%H%M%S}"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST_F(DatedImu, FixesWithoutDatesBeginWithIt) {
  WriteRecording({"Iso", "time", "time", "{:%Y-%m-%dT%H:%M:%S}"});
  std::string fixes = "time,latitude,longitude,altitude\n";
  for (int k = 0; k < 29; ++k) {
    fixes += fmt::format("{},{:.7f},11.5,{:.2f}\n", k, 48.0 + 1e-5 * k,
                         500.0 + 0.01 * (k % 3));
  }
  Write("gps.txt", fixes);
  const auto drafts = DraftRecordings(folder_.string());
  const std::string text = DraftText(drafts.at(0));
  EXPECT_THAT(text, HasSubstr("position: its clock has no date; it begins"));
  Write("config.yaml", text);
  ASSERT_EQ(LoadError(), "") << text;
  EXPECT_NEAR(Load().streams.at(0).measurements[0].t, 0.0, 1e-6);
}

TEST_F(DatedImu, WholeSecondsAreNoStampsOfFastRows) {
  WriteRecording({"Iso", "time", "time", "{:%Y-%m-%dT%H:%M:%S}"});
  std::string text;
  int k = 0;
  std::istringstream rows(Read("imu.txt"));
  for (std::string row; std::getline(rows, row); ++k) {
    const std::size_t point = row.find('.');
    // The fraction goes; a column that counts milliseconds comes.
    text += k == 0 ? "elapsed," + row + "\n"
                   : fmt::format("{},", 10 * k) + row.substr(0, point) +
                         row.substr(row.find(',')) + "\n";
  }
  Write("imu.txt", text);
  std::filesystem::remove(Path("gps.txt"));
  Write("config.yaml", DraftText(DraftRecordings(folder_.string()).at(0)));
  ASSERT_EQ(LoadError(), "") << Read("config.yaml");
  EXPECT_NEAR(Load().imu.nominal_dt, 0.01, 1e-6);
}

}  // namespace
}  // namespace hindsight
