#include <gtest/gtest.h>

#include "io/config/config_help.h"
#include "io/config/init_config.h"
#include "io/read/file_format.h"
#include "io/read/open_text.h"
#include "io/recording_folder.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// A log of fixes, which nothing but this file knows: "FIX t lat lon h" with
/// stamps since 1970, whose standard deviations are a key's [m].
OpenedTable OpenFixLog(const TableRequest& request) {
  if (!request.Is(PositionKind())) {
    throw InputError(request.path, 0, "a fix log holds positions alone");
  }
  OpenedTable lines = OpenLines(request);
  RowBuffer rows(request.path, request.fields, request.options.allow_absent);
  for (const char* field :
       {"lat", "lon", "h", "sigma_n", "sigma_e", "sigma_d"}) {
    rows.Declare(field);
  }
  const double sigma = *ParseNumber(request.format.values.at("spread"));
  for (std::string_view line; lines.lines->Next(&line);) {
    const auto numbers = NumbersOf(std::string(line.substr(4)));
    const double whole = std::floor(numbers[0]);
    rows.Append({static_cast<std::int64_t>(whole), numbers[0] - whole},
                lines.lines->number());
    rows.Set("lat", numbers[1]);
    rows.Set("lon", numbers[2]);
    rows.Set("h", numbers[3]);
    for (const char* field : {"sigma_n", "sigma_e", "sigma_d"}) {
      rows.Set(field, sigma);
    }
  }
  return OpenBuffer(std::move(rows), false);
}

std::optional<FoundStream> RecogniseFixLog(const TextProbe& probe) {
  if (!probe.lines[0].starts_with("FIX ")) return std::nullopt;
  FoundStream found = FoundAiding({&PositionKind()});
  found.lines = {{"spread", "3", {}}};
  return found;
}

const FileFormat& FixLog() {
  static const FileFormat kFormat = {
      .name = "fix_log",
      .help = "fixes, made up for a test",
      .streams = "position",
      .counts_from_1970 = true,
      .keys = {{"spread", "standard deviation of each axis in metres", "-"}},
      .open = OpenFixLog,
      .recognise_text = RecogniseFixLog};
  return kFormat;
}

class MadeUpFormat : public RecordingFolder {
 protected:
  static void SetUpTestSuite() { AddFileFormat(FixLog()); }

  MadeUpFormat() {
    // 2017-01-01 00:00:00 UTC.
    Write("fixes.log",
          "FIX 1483228800.5 0.8 0.2 500\nFIX 1483228801 0.8 0.2 501\n");
    std::string imu =
        "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],accel_x[m/s^2],accel_y["
        "m/s^2],accel_z[m/s^2]\n";
    for (int i = 0; i < 200; ++i) {
      imu += std::to_string(0.01 * i) + ",0,0,0,0,0,-9.8\n";
    }
    Write("imu.csv", imu);
  }

  void WriteConfig(const std::string& fixes) const {
    Write("config.yaml",
          "epoch: 2017-01-01 00:00:00 UTC\n"
          "imu:\n  file: imu.csv\n"
          "  noise: {gyro: 1 deg/sqrt(h), accel: 1 mg/sqrt(Hz)}\n" +
              fixes);
  }
};

TEST_F(MadeUpFormat, IsReadWithItsKeyAndItsEpoch) {
  WriteConfig(
      "aiding:\n  gnss: {type: position, file: fixes.log, format: fix_log, "
      "spread: 3}\n");
  ASSERT_EQ(LoadError(), "");
  const Dataset data = Load();
  ASSERT_EQ(data.streams.size(), 1U);
  ASSERT_EQ(data.streams[0].measurements.size(), 2U);
  const Measurement first = data.streams[0].measurements[0];
  EXPECT_EQ(first.t, 0.5);
  const auto& fix = std::get<PositionFix>(first.model);
  EXPECT_EQ(fix.R_n, Eigen::Matrix3d(9.0 * Eigen::Matrix3d::Identity()));
}

TEST_F(MadeUpFormat, RefusesWhatItCannotHoldAndTheKeyOfAnother) {
  WriteConfig(
      "aiding:\n  v: {type: velocity, file: fixes.log, format: fix_log, "
      "spread: 3}\n");
  EXPECT_NE(LoadError().find("a fix log holds positions alone"),
            std::string::npos);
  WriteConfig(
      "aiding:\n  gnss: {type: position, file: fixes.log, format: csv, "
      "spread: 3}\n");
  EXPECT_NE(LoadError().find("spread"), std::string::npos);
  WriteConfig("truth: {file: fixes.log, format: fix_lag}\n");
  EXPECT_NE(LoadError().find("fix_log"), std::string::npos) << LoadError();
}

TEST_F(MadeUpFormat, IsRecognisedInAFolder) {
  const auto drafts = DraftRecordings(folder_.string());
  ASSERT_EQ(drafts.size(), 1U);
  const std::string config = DraftText(drafts[0]);
  EXPECT_NE(config.find("format: fix_log\n    spread: 3\n"), std::string::npos)
      << config;
  Write("config.yaml", "epoch: 2017-01-01 00:00:00 UTC\n" + config);
  EXPECT_EQ(LoadError(), "");
}

TEST_F(MadeUpFormat, IsDocumentedWithItsKey) {
  EXPECT_NE(FormatMarkdown().find(
                "| `fix_log` * | fixes, made up for a test | position |\n"),
            std::string::npos);
  EXPECT_NE(ConfigHelp("spread").find("spread  (-; with format: fix_log)"),
            std::string::npos);
  const std::string clock = ConfigHelp("clock");
  EXPECT_NE(clock.find("fix_log"), std::string::npos) << clock;
  EXPECT_NE(ConfigSchema().find("\"spread\""), std::string::npos);
}

TEST_F(MadeUpFormat, ANameIsTakenOnce) {
  EXPECT_THROW(AddFileFormat(FixLog()), std::invalid_argument);
}

}  // namespace
}  // namespace hindsight
