#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/recording.h"
#include "support/recordings.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path kClockData =
    std::filesystem::path(HINDSIGHT_SOURCE_DIR) / "data";
const std::filesystem::path kClockRecordings = testing::RecordingsFolder();

/// The IMU's clock is put 500 s ahead, so that the records do not overlap.
class UnknownClock : public ::testing::Test {
 protected:
  void SetUp() override {
    recording_.Replace("config.yaml", "imu:\n", "imu:\n  time_offset: 500 s\n");
    recording_.Edit("config.yaml", [](std::vector<std::string>* lines) {
      const auto begin = std::find_if(
          lines->begin(), lines->end(),
          [](const std::string& line) { return line.starts_with("truth:"); });
      lines->erase(begin, begin + 2);
    });
  }
  void MakeUnknown(const std::string& stream) {
    recording_.Replace("config.yaml", "  " + stream + ":\n",
                       "  " + stream + ":\n    time_offset: unknown\n");
  }
  Recording recording_;
};

TEST_F(UnknownClock, IsFoundCheckedAndEstimated) {
  MakeUnknown("gnss");
  MakeUnknown("speed");
  const Outcome check =
      Hindsight({"check", "data/config.yaml"}, recording_.root());
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("gnss: time offset found: "));
  EXPECT_THAT(check.out, HasSubstr("speed: time offset found: "));
  const Outcome run = recording_.Run({"--out=out", "--methods=batch"});
  ASSERT_TRUE(run.status == 0 || run.status == 3) << run.err << run.out;
  const nlohmann::json batch = nlohmann::json::parse(
      ReadFile(recording_.root() / "out/summary.json"))["methods"]["batch"];
  for (const char* name : {"gnss_time_offset", "speed_time_offset"}) {
    const nlohmann::json& offset = batch["constants"][name];
    EXPECT_NEAR(offset["value"].get<double>(), 500.0,
                4.0 * offset["sigma"].get<double>());
  }
  EXPECT_THAT(ReadFile(recording_.root() / "out/config.resolved.yaml"),
              HasSubstr("time_offset: unknown"));
}

TEST_F(UnknownClock, GoesWithNoSigma) {
  recording_.Replace("config.yaml", "  gnss:\n",
                     "  gnss:\n    time_offset: unknown\n    estimate: "
                     "{time_offset: 0.1 s}\n");
  const Outcome outcome = recording_.Run({"--out=out"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("config.yaml:"));
  EXPECT_THAT(outcome.err,
              HasSubstr("time_offset does not go with `time_offset: unknown`"));
}

TEST_F(UnknownClock, OfAVehicleAtRestIsNotFound) {
  WriteFile(recording_.root() / "still.yaml",
            "name: still\n"
            "start: {position: [48 deg, 11.5 deg, 500 m], heading: 65 deg}\n"
            "segments: [{type: stop, duration: 60 s}]\n"
            "imu:\n"
            "  rate: 100 Hz\n"
            "  noise: {gyro: 0.1 deg/sqrt(h), accel: 0.05 m/s/sqrt(h)}\n"
            "aiding:\n"
            "  gnss: {type: position, rate: 1 Hz, sigma: 0.2 m}\n");
  ASSERT_EQ(
      Hindsight({"simulate", "still.yaml", "--out=still"}, recording_.root())
          .status,
      0);
  const auto config = recording_.root() / "still/config.yaml";
  std::string text = ReadFile(config);
  const std::string key = "  gnss:\n";
  text.insert(text.find(key) + key.size(), "    time_offset: unknown\n");
  WriteFile(config, text);
  for (const char* command : {"check", "run"}) {
    std::vector<std::string> words = {command, "still/config.yaml"};
    if (command == std::string("run")) words.emplace_back("--out=out");
    const Outcome outcome = Hindsight(words, recording_.root());
    EXPECT_EQ(outcome.status, 2) << outcome.out;
    EXPECT_THAT(outcome.err, HasSubstr("gnss.time_offset: is not found"));
  }
}

/// Laps round a square, one like the other.
TEST(ClockOfLaps, IsDoubtfulToCheck) {
  const TemporaryFolder folder;
  std::string scenario =
      "name: laps\n"
      "start: {position: [48 deg, 11.5 deg, 500 m], heading: 65 deg}\n"
      "segments:\n"
      "  - {type: accelerate, speed: 8 m/s, rate: 2 m/s^2}\n";
  for (int side = 0; side < 12; ++side) {
    scenario +=
        "  - {type: straight, duration: 5 s}\n"
        "  - {type: turn, angle: 90 deg, rate: 20 deg/s}\n";
  }
  WriteFile(folder.path() / "laps.yaml",
            scenario +
                "imu:\n"
                "  rate: 100 Hz\n"
                "  noise: {gyro: 0.1 deg/sqrt(h), accel: 0.05 m/s/sqrt(h)}\n"
                "aiding:\n"
                "  gnss: {type: position, rate: 1 Hz, sigma: 0.2 m}\n");
  ASSERT_EQ(
      Hindsight({"simulate", "laps.yaml", "--out=laps"}, folder.path()).status,
      0);
  const auto check = [&] {
    return Hindsight({"check", "laps/config.yaml"}, folder.path());
  };
  EXPECT_EQ(check().status, 0);
  const auto config = folder.path() / "laps/config.yaml";
  std::string text = ReadFile(config);
  const std::string key = "  gnss:\n";
  text.insert(text.find(key) + key.size(), "    time_offset: unknown\n");
  WriteFile(config, text);
  const Outcome outcome = check();
  EXPECT_EQ(outcome.status, 3) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("warning: gnss: "));
  EXPECT_THAT(outcome.out, HasSubstr(" fit about as well: `run` decides"));
  EXPECT_EQ(Lines(outcome.out).back(), "the recording is doubtful: 1 warning");
}

/// Half a period off and turned round fits these flights nearly as well.
TEST(ClocksOfRecordings, DronesToAndFro) {
  if (!std::filesystem::exists(kClockRecordings / "drone_paths")) {
    GTEST_SKIP() << "the recording drone_paths is not here";
  }
  const TemporaryFolder folder;
  for (const char* path : {"5", "23", "27"}) {
    const Outcome outcome = Hindsight(
        {"run",
         (kClockData / (std::string("drone_path_") + path + ".yaml")).string(),
         "--data-root=" + kClockRecordings.string(), "--methods=batch",
         "--out=out", "--force"},
        folder.path());
    ASSERT_TRUE(outcome.status == 0 || outcome.status == 3)
        << path << outcome.err << outcome.out;
    const nlohmann::json batch = nlohmann::json::parse(
        ReadFile(folder.path() / "out/summary.json"))["methods"]["batch"];
    EXPECT_LT(batch["withheld"]["horizontal_rms_m"].get<double>(), 0.08)
        << path;
    const double offset = batch["constants"]["rtk_time_offset"]["value"];
    if (path != std::string("5")) {
      EXPECT_NEAR(offset, -0.63, 0.1) << path;
    }
  }
}

/// Where spikes among the fixes keep the filter's clock from settling, the batch
/// that knows them for outliers settles it.
TEST(ClocksOfRecordings, SettleBesideOutliers) {
  if (!std::filesystem::exists(kClockRecordings / "drone_paths")) {
    GTEST_SKIP() << "the recording drone_paths is not here";
  }
  const TemporaryFolder folder;
  const Outcome outcome =
      Hindsight({"run", (kClockData / "drone_path_5.yaml").string(),
                 "--data-root=" + kClockRecordings.string(),
                 "--methods=batch,robust_batch",
                 "--inject=rtk:spikes=10m,share=20%,from=9.7s,to=16.1s",
                 "--seed=101", "--out=out"},
                folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  const nlohmann::json methods = nlohmann::json::parse(
      ReadFile(folder.path() / "out/summary.json"))["methods"];
  EXPECT_EQ(methods["batch"]["grade"], "not usable");
  EXPECT_EQ(methods["robust_batch"]["grade"], "usable");
  EXPECT_LT(
      methods["robust_batch"]["withheld"]["horizontal_rms_m"].get<double>(),
      0.08);
}

/// A flight to and fro that fits its positions 1.3 s later almost as well: what
/// errs for a while must not decide. The clock without errors is the reference.
TEST(ClocksOfRecordings, ErrorsThatLastDoNotTurnAFlight) {
  if (!std::filesystem::exists(kClockRecordings / "drone_paths")) {
    GTEST_SKIP() << "the recording drone_paths is not here";
  }
  const TemporaryFolder folder;
  const auto clock = [&folder](std::vector<std::string> flags) {
    flags.insert(flags.begin(),
                 {"run", (kClockData / "drone_path_27.yaml").string(),
                  "--data-root=" + kClockRecordings.string(),
                  "--methods=robust_batch", "--out=out", "--force"});
    Hindsight(flags, folder.path());
    return nlohmann::json::parse(ReadFile(
        folder.path() /
        "out/summary.json"))["methods"]["robust_batch"]["constants"]
                            ["rtk_time_offset"]["value"]
                                .get<double>();
  };
  const double without = clock({});
  EXPECT_NEAR(clock({"--inject=rtk:multipath=3m,from=15.5s,to=21.8s,tau=20s",
                     "--seed=771755"}),
              without, 0.1);
  EXPECT_NEAR(
      clock({"--inject=rtk:ramp=10m,from=5.7s,to=12.0s", "--seed=380290"}),
      without, 0.1);
}

/// Spikes turn it for the batch. Without what is found to be off the clock is told,
/// and the search begins there again.
TEST(ClocksOfRecordings, SpikesDoNotTurnAFlight) {
  if (!std::filesystem::exists(kClockRecordings / "drone_paths")) {
    GTEST_SKIP() << "the recording drone_paths is not here";
  }
  const TemporaryFolder folder;
  Hindsight(
      {"run", (kClockData / "drone_path_27.yaml").string(),
       "--data-root=" + kClockRecordings.string(),
       "--methods=batch,robust_batch", "--out=out",
       "--inject=rtk:spikes=3m,share=20%,from=7.8s,to=14.1s", "--seed=434671"},
      folder.path());
  const nlohmann::json methods = nlohmann::json::parse(
      ReadFile(folder.path() / "out/summary.json"))["methods"];
  const auto offset = [&](const char* method) {
    return methods[method]["constants"]["rtk_time_offset"]["value"]
        .get<double>();
  };
  EXPECT_GT(offset("batch"), 0.0);
  EXPECT_NEAR(offset("robust_batch"), -0.625, 0.05);
  EXPECT_EQ(methods["robust_batch"]["grade"], "usable");
  EXPECT_LT(
      methods["robust_batch"]["withheld"]["horizontal_rms_m"].get<double>(),
      0.08);
}

/// Through the file, as a logger leaves it that is set anew on the way.
TEST(ImuClock, ThatLeapsIsToldWithItsSize) {
  Recording recording;
  recording.Edit("imu.csv", [](std::vector<std::string>* lines) {
    const std::size_t middle = lines->size() / 2;
    for (std::size_t i = middle; i < lines->size(); ++i) {
      std::string& line = (*lines)[i];
      const std::size_t comma = line.find(',');
      if (comma == std::string::npos) continue;
      line = fmt::format("{:.4f}", std::stod(line.substr(0, comma)) + 0.3) +
             line.substr(comma);
    }
  });
  const Outcome run = recording.Run({"--out=out", "--methods=batch"});
  EXPECT_EQ(run.status, 1) << run.out << run.err;
  EXPECT_THAT(run.out, HasSubstr("the IMU's clock leaps by 0.3 s at "));
  EXPECT_THAT(run.out,
              HasSubstr("0.3 s less in the stamps of the IMU's later"));
}

}  // namespace
}  // namespace hindsight
