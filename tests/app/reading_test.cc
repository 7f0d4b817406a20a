#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <thread>

#include "app/recording.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;
using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// A gzip file of `count` times 16 MB of one character behind `text`.
void WriteLongGzip(const std::filesystem::path& path, const std::string& text,
                   char c, int count) {
  WriteGzip(path, std::string(16u << 20, c));
  const std::string piece = ReadFile(path);
  WriteGzip(path, text);
  std::string packed = ReadFile(path);
  for (int i = 0; i < count; ++i) packed += piece;
  WriteFile(path, packed);
}

TEST(Reading, RefusesWhatIsNoFileAtOnce) {
  Recording recording;
  const std::filesystem::path imu = recording.file("imu.csv");
  std::filesystem::remove(imu);
  ASSERT_EQ(mkfifo(imu.c_str(), 0600), 0);
  const auto begin = Clock::now();
  for (const std::string command : {"check", "run"}) {
    std::vector<std::string> words = {command, "data/config.yaml"};
    if (command == "run") words.push_back("--out=out");
    const Outcome outcome = Hindsight(words, recording.root());
    EXPECT_EQ(outcome.status, 2);
    ASSERT_THAT(Lines(outcome.err), SizeIs(1));
    EXPECT_THAT(outcome.err,
                HasSubstr("imu.csv: is a pipe; expected a regular file"));
  }
  const std::string columns =
      "file: imu.npy\n  format: npy\n  columns: {t: '1 [s]', gyro_x: '2 "
      "[rad/s]', gyro_y: '3 [rad/s]', gyro_z: '4 [rad/s]', accel_x: '5 "
      "[m/s^2]', accel_y: '6 [m/s^2]', accel_z: '7 [m/s^2]'}";
  recording.Replace("config.yaml", "file: imu.csv", columns);
  const std::filesystem::path npy = recording.file("imu.npy");
  std::filesystem::create_symlink("/dev/zero", npy);
  EXPECT_THAT(recording.Run({"--out=out"}).err,
              HasSubstr("imu.npy: is a device; expected a regular file"));
  std::filesystem::remove(npy);
  std::filesystem::create_directory(npy);
  EXPECT_THAT(recording.Run({"--out=out"}).err,
              HasSubstr("imu.npy: is a folder; expected a regular file"));
  EXPECT_LT(SecondsSince(begin), 20.0);
}

/// 1 GB of zeros in 1 MB.
TEST(Reading, ALineWithoutEndIsRefusedInLittleTimeAndMemory) {
  Recording recording;
  std::filesystem::remove(recording.file("imu.csv"));
  recording.Replace("config.yaml", "imu.csv", "imu.csv.gz");
  for (const char c : {'\0', '0'}) {
    WriteLongGzip(recording.file("imu.csv.gz"), "", c, 64);
    const auto begin = Clock::now();
    const Outcome outcome = recording.Run({"--out=out"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr("imu.csv.gz:1: the line is longer than "
                                       "1048576 bytes"));
    EXPECT_LT(outcome.peak_memory, 64.0);
    EXPECT_LT(SecondsSince(begin), 10.0);
  }
}

TEST(Reading, AnswersASignalWithinASecond) {
  Recording recording;
  const std::string imu = ReadFile(recording.file("imu.csv"));
  std::filesystem::remove(recording.file("imu.csv"));
  recording.Replace("config.yaml", "imu.csv", "imu.csv.gz");
  // Empty lines are comments: 16 GB of them, read for many seconds.
  WriteLongGzip(recording.file("imu.csv.gz"), imu, '\n', 1024);
  for (const int signal : {SIGINT, SIGTERM}) {
    Child run({"run", "data/config.yaml", "--out=out", "--progress=json"},
              recording.root());
    while (run.Err().find("reading") == std::string::npos) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const auto begin = Clock::now();
    run.Signal(signal);
    const Outcome outcome = run.Wait();
    EXPECT_LT(SecondsSince(begin), 1.0);
    EXPECT_EQ(outcome.status, 130);
    EXPECT_THAT(outcome.err, HasSubstr("interrupted"));
    EXPECT_LT(outcome.peak_memory, 64.0);
  }
}

TEST(Reading, ListsOfTheCommandLineAreBounded) {
  Recording recording;
  EXPECT_THAT(
      recording.Run({"--out=out", "--withhold=gnss:every=1us,length=1us"}).err,
      HasSubstr("outages of 'gnss'; expected at most 100000"));
  WriteFile(recording.root() / "long.yaml",
            "start: {position: [48 deg, 11 deg, 500 m]}\n"
            "segments: [{type: straight, duration: 1e9 s}]\n"
            "imu:\n  noise: {gyro: 0.1 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n");
  for (const std::string duration : {"1e8", "1e300"}) {
    const Outcome outcome = Hindsight(
        {"simulate", "long.yaml", "--out=long", "--duration=" + duration},
        recording.root());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr("expected at most 2678400"));
  }
}

}  // namespace
}  // namespace hindsight
