#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <thread>

#include "app/recording.h"
#include "io/binary_files.h"
#include "support/seed_count.h"

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
    if (command == "run") words.emplace_back("--out=out");
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

/// A sanitizer holds what was freed.
void ExpectMemory(const Outcome& outcome, double most) {
  if (testing::kSanitized) return;
  EXPECT_LT(outcome.peak_memory, most);
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
    ExpectMemory(outcome, 64.0);
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
    ExpectMemory(outcome, 64.0);
  }
}

constexpr std::size_t kLargeInput = 30'000'000;  // [bytes]

/// About 30 MB of lines, of which the last is damaged: the program ends when
/// everything is read.
std::string LargeText(const std::string& titles, const char* values) {
  std::string text = titles + "\n";
  text.reserve(kLargeInput + 1000);
  for (int i = 0; text.size() < kLargeInput; ++i) {
    text += fmt::format("{:.3f},{}\n", 0.005 * i, values);
  }
  return text + "x\n";
}

constexpr int kLargeRows = 535000;

/// Doubles of 7 columns whose last is no number.
std::string LargeDoubles(bool column_major) {
  std::string data;
  data.reserve(std::size_t{8} * 7 * kLargeRows);
  const auto value = [](int row, int column) {
    return column == 0 ? 0.01 * row : 0.001 * column + 1e-7 * (row % 11);
  };
  for (int i = 0; i < 7 * kLargeRows - 1; ++i) {
    data += BytesOf(column_major ? value(i % kLargeRows, i / kLargeRows)
                                 : value(i / 7, i % 7));
  }
  return data + BytesOf(std::nan(""));
}

std::string LargeBag() {
  TextCells rows;
  for (int i = 0; i < 80000; ++i) {
    const std::string t = std::to_string(1483228800.0 + 0.01 * i);
    rows.push_back({t, ".001", ".002", ".003", ".1", ".2", "-9.8"});
  }
  rows.back().back() = "nan";
  return BagBytes(rows);
}

struct LargeInput {
  std::string file;
  std::string keys;
  std::function<std::string()> bytes;
  std::size_t size = kLargeInput;  ///< unpacked
};

constexpr const char* kImuTitles =
    "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],accel_x[m/s^2],accel_y[m/"
    "s^2],accel_z[m/s^2]";
constexpr const char* kImuValues =
    ".00112345,.00212345,.00312345,.1123456,.2123456,-9.8123456";

std::string LargeImu() { return LargeText(kImuTitles, kImuValues); }

std::string LargeMatrix() {
  return MatMatrix("data", 6, kLargeRows, 7, MatElement(9, LargeDoubles(true)));
}

std::vector<LargeInput> LargeInputs() {
  const auto columns = [](const std::string& array) {
    std::string text =
        "  columns: {t: 'D1 [s]', gyro_x: 'D2 [rad/s]', gyro_y: 'D3 [rad/s]', "
        "gyro_z: 'D4 [rad/s]', accel_x: 'D5 [m/s^2]', accel_y: 'D6 [m/s^2]', "
        "accel_z: 'D7 [m/s^2]'}\n";
    for (std::size_t at; (at = text.find("'D")) != text.npos;) {
      text.replace(at, 2, "'" + array);
    }
    return text;
  };
  const std::string imu = "imu:\n  file: FILE\n";
  const std::string mat = imu + "  format: mat\n" + columns("data:");
  const std::size_t numbers = std::size_t{8} * 7 * kLargeRows;
  return {{"large.csv", imu, LargeImu},
          {"large.csv.gz", imu, [] { return Gzipped(LargeImu()); }},
          {"large.npy", imu + "  format: npy\n" + columns(""),
           [] {
             return NpyFile("<f8", std::to_string(kLargeRows) + ", 7",
                            LargeDoubles(false));
           },
           numbers},
          {"large.mat", mat, [] { return MatFile(LargeMatrix()); }, numbers},
          {"packed.mat", mat,
           [] { return MatFile(MatCompressed(LargeMatrix())); }, numbers},
          {"large.bag", imu + "  format: rosbag\n", LargeBag, 28'000'000},
          {"position.csv", "aiding:\n  s: {type: position, file: FILE}\n",
           [] {
             return LargeText(
                 "t[s],lat[deg],lon[deg],h[m],sigma_n[m],sigma_e[m],sigma_d[m]",
                 "48.000000012,11.000000012,500.012,0.1,0.1,0.2");
           }},
          {"velocity.csv", "aiding:\n  s: {type: velocity, file: FILE}\n",
           [] {
             return LargeText(
                 "t[s],v_n[m/s],v_e[m/s],v_d[m/s],sigma_v_n[m/s],"
                 "sigma_v_e[m/s],sigma_v_d[m/s]",
                 "1.0000123,2.0000123,3.0000123,0.1,0.1,0.2");
           }},
          {"truth.csv", "truth: {file: FILE}\n", [] {
             return LargeText(
                 "t[s],lat[deg],lon[deg],h[m],v_n[m/s],v_e[m/s],v_d[m/s],"
                 "roll[deg],pitch[deg],heading[deg]",
                 "48.000000012,11.000000012,500.012,1.0012,2.0012,3.0012,"
                 "1.000012,2.000012,90.000012");
           }}};
}

/// A stream that is read whole and then found to be of another time.
struct NarrowInput {
  std::string name;
  std::string keys;
  std::string titles;
  std::function<std::string(int)> row;
};

std::string Decimal(double value, int digits) {
  return fmt::format("{:.{}f}", value, digits);
}

std::string Stamped(int i, const std::string& values) {
  return Decimal(0.001 * i, 3) + "," + values;
}

/// Anything but a regular pattern, of so many digits.
int Mixed(int i, unsigned most) {
  return static_cast<int>(static_cast<unsigned>(i) * 2654435761u % most);
}

std::vector<NarrowInput> NarrowInputs() {
  const auto speed = [](int i) {
    return Stamped(i, Decimal(0.001 * Mixed(i, 40000), 3));
  };
  const auto digits = [](int i, int count) {
    std::string text = std::to_string(Mixed(i, 10));
    for (int k = 1; k < count; ++k) {
      text += "," + std::to_string(Mixed(i + 1000 * k, 10));
    }
    return text;
  };
  const std::string odometer = "type: odometer, sigma: 0.1 m/s";
  const std::string height = "type: height, sigma: 1 m";
  return {
      {"odometer", odometer, "t[s],speed[m/s]", speed},
      {"odometer.gz", odometer, "t[s],speed[m/s]", speed},
      {"unordered", odometer + ", on_unordered: sort", "t[s],speed[m/s]",
       [speed](int i) { return speed(i ^ 1); }},
      {"counts", "type: odometer, form: increments, sigma: 1 cm",
       "t[s],distance[m]",
       [](int i) { return Stamped(i, Decimal(0.01 * i, 2)); }},
      {"height", height, "t[s],h[m]",
       [](int i) { return Stamped(i, Decimal(0.1 * Mixed(i, 90000), 1)); }},
      {"depth", "type: depth, surface: 50 m, sigma: 1 m", "t[s],depth[m]",
       [](int i) { return Stamped(i, std::to_string(Mixed(i, 100))); }},
      {"by_row", height, "h[m]", [digits](int i) { return digits(i, 1); }},
      {"flags", "type: zero_velocity, sigma: 1 cm/s", "t[s],zero_velocity[1]",
       [](int i) { return Stamped(i, "1"); }},
      {"magnetometer",
       "type: magnetometer, sigma: 1 uT, horizontal: 20 uT, declination: 0 deg",
       "t[s],mag_x[uT],mag_y[uT],mag_z[uT]",
       [digits](int i) { return Stamped(i, digits(i, 3)); }},
      {"position", "type: position, sigma: 1 m", "t[s],lat[deg],lon[deg],h[m]",
       [digits](int i) { return Stamped(i, digits(i, 3)); }},
      {"truth", "", "t[s],lat[deg],lon[deg],h[m]",
       [digits](int i) { return Stamped(i, digits(i, 3)); }},
      {"truth.gz", "",
       "t[s],lat[deg],lon[deg],h[m],v_n[m/s],v_e[m/s],v_d[m/s],roll[deg],"
       "pitch[deg],heading[deg]",
       [digits](int i) { return Stamped(i, digits(i, 9)); }},
  };
}

class ReadingMemory : public ::testing::Test {
 protected:
  ReadingMemory() {
    WriteFile(folder_.path() / "small.csv", std::string(kImuTitles) + "\n0," +
                                                kImuValues + "\n999999," +
                                                kImuValues + "\n");
  }

  /// The keys of the IMU, the aiding or the truth, with FILE for the file.
  void ExpectBound(const std::string& file, const std::string& bytes,
                   std::size_t size, const std::string& keys) {
    WriteFile(folder_.path() / file, bytes);
    const std::string noise =
        "  max_gap: 1000000 s\n"
        "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n";
    std::string text = keys.starts_with("imu")
                           ? keys + noise
                           : "imu:\n  file: small.csv\n" + noise + keys;
    text.replace(text.find("FILE"), 4, file);
    WriteFile(folder_.path() / "config.yaml",
              "epoch: 2017-01-01 00:00:00 UTC\n" + text);
    // A child begins with what its parent holds.
    malloc_trim(0);
    const Outcome outcome = Hindsight({"check", "config.yaml"}, folder_.path());
    EXPECT_EQ(outcome.status, 2) << file;
    EXPECT_THAT(outcome.err, HasSubstr(file));
    const double most = 64.0 + 3.0 * static_cast<double>(size) / (1 << 20);
    SCOPED_TRACE(file);
    ExpectMemory(outcome, most);
    std::printf("%s: %.0f MB of %.0f: %s", file.c_str(), outcome.peak_memory,
                most, outcome.err.c_str());
    std::filesystem::remove(folder_.path() / file);
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(ReadingMemory, IsAtMost64MbAndThreeTimesTheInput) {
  for (const LargeInput& input : LargeInputs()) {
    ExpectBound(input.file, input.bytes(), input.size, input.keys);
  }
}

TEST_F(ReadingMemory, IsBoundedHoweverNarrowTheRowsAre) {
  constexpr std::size_t kSize = 16'000'000;  // [bytes]
  for (const NarrowInput& input : NarrowInputs()) {
    std::string text = input.titles + "\n";
    for (int i = 0; text.size() < kSize; ++i) text += input.row(i) + "\n";
    const bool is_packed = input.name.ends_with(".gz");
    ExpectBound(is_packed ? "narrow.csv.gz" : "narrow.csv",
                is_packed ? Gzipped(text) : text, text.size(),
                (input.keys.empty() ? "truth: {"
                                    : "aiding:\n  s: {" + input.keys + ", ") +
                    "file: FILE, time: {start: 5000000 s" +
                    (input.name == "by_row" ? ", rate: 100 Hz" : "") + "}}\n");
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
