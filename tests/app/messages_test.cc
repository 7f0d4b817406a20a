#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/recording.h"
#include "support/walking_foot.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kDriveWithWheels = R"(
name: short
start: {position: [48 deg, 11.5 deg, 500 m], heading: 65 deg}
segments:
  - {type: stop, duration: 10 s}
  - {type: accelerate, speed: 8 m/s, rate: 2 m/s^2}
  - {type: turn, angle: 90 deg, rate: 20 deg/s}
  - {type: straight, duration: 10 s}
  - {type: turn, angle: -60 deg, rate: 15 deg/s}
  - {type: straight, duration: 20 s}
duration: 50 s
imu: {rate: 100 Hz, noise: {gyro: 0.1 deg/sqrt(h), accel: 0.05 m/s/sqrt(h)}}
aiding:
  gnss: {type: position, rate: 1 Hz, sigma: [0.2 m, 0.2 m, 0.4 m]}
  wheel: {type: odometer, rate: 5 Hz, sigma: [0.05, 0.05, 0.05 m/s],
          estimate: {scale: 2 %}}
)";

/// What the command says of recordings that are wrong in one way.
class Messages : public ::testing::Test {
 protected:
  void Simulate(const std::string& scenario) {
    WriteFile(root() / "scenario.yaml", scenario);
    const Outcome made = Hindsight(
        {"simulate", "scenario.yaml", "--out=data", "--seed=7"}, root());
    ASSERT_EQ(made.status, 0) << made.err;
  }
  /// Changes the numbers of each row of a file.
  void Change(const std::string& name,
              const std::function<void(std::vector<double>*)>& change) {
    std::string text;
    for (const std::string& line : Lines(ReadFile(root() / "data" / name))) {
      if (line.find_first_of("0123456789-") != 0) {
        text += line + "\n";
        continue;
      }
      std::vector<double> numbers;
      std::istringstream in(line);
      for (std::string cell; std::getline(in, cell, ',');) {
        numbers.push_back(std::stod(cell));
      }
      change(&numbers);
      text += fmt::format("{}\n", fmt::join(numbers, ","));
    }
    WriteFile(root() / "data" / name, text);
  }
  void Replace(const std::string& from, const std::string& to) {
    const auto config = root() / "data/config.yaml";
    std::string text = ReadFile(config);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << text;
    WriteFile(config, text.replace(at, from.size(), to));
  }
  Outcome Run(const std::string& methods) const {
    return Hindsight(
        {"run", "data/config.yaml", "--methods=" + methods, "--out=out"},
        root());
  }
  Outcome Check(std::vector<std::string> flags = {}) const {
    flags.insert(flags.begin(), {"check", "data/config.yaml"});
    return Hindsight(flags, root());
  }
  std::string Summary() const { return ReadFile(root() / "out/summary.json"); }
  /// The only line of an error.
  std::string ErrorOf(const Outcome& outcome) const {
    EXPECT_EQ(outcome.status, 2) << outcome.out;
    EXPECT_EQ(Lines(outcome.err).size(), 1u) << outcome.err;
    return outcome.err;
  }
  const std::filesystem::path& root() const { return folder_.path(); }

  TemporaryFolder folder_;
};

TEST_F(Messages, AStartThatNobodyGaveIsTheProgramsOwn) {
  Simulate(kDriveWithWheels);
  Change("imu.csv", [](std::vector<double>* row) { (*row)[4] += 0.02; });
  Run("batch");
  EXPECT_THAT(Summary(), HasSubstr("sigma from the program's own start"));
  EXPECT_THAT(Summary(), HasSubstr("initial.accel_bias and "
                                   "initial.accel_bias_sigma in the "
                                   "configuration"));
}

TEST_F(Messages, AWheelThatCountsBackwards) {
  Simulate(kDriveWithWheels);
  EXPECT_THAT(Check().out, HasSubstr("nothing looks wrong"));
  Change("wheel.csv", [](std::vector<double>* row) { (*row)[1] *= -1.0; });
  EXPECT_THAT(Check().out, HasSubstr(" times as fast as it says: "
                                     "its sign is the other"));
  Run("batch");
  EXPECT_THAT(Summary(), HasSubstr("a speed of the wrong sign"));
  EXPECT_THAT(Summary(), HasSubstr("before its column under `columns`"));
}

TEST_F(Messages, ASpeedOverTheGroundOfTheWrongSign) {
  Simulate(kDriveWithWheels);
  std::string rows = "t[s],speed[m/s],course[deg]\n";
  for (int k = 20; k < 40; ++k) rows += fmt::format("{},-8,155\n", k);
  WriteFile(root() / "data/course.csv", rows);
  Replace("aiding:\n",
          "aiding:\n  rmc: {type: speed_course, file: course.csv, sigma: 0.2 "
          "m/s, course_sigma: 2 deg}\n");
  const std::string error = ErrorOf(Run("batch"));
  EXPECT_THAT(error, HasSubstr("course.csv:2: rmc: the speed is -8 m/s"));
  EXPECT_THAT(error, HasSubstr("a leading \"-\" before its column"));
}

TEST_F(Messages, AxesOfWhatNeverStands) {
  std::string scenario = kDriveWithWheels;
  const std::string stop = "  - {type: stop, duration: 10 s}\n";
  scenario.erase(scenario.find(stop), stop.size());
  Simulate(scenario);
  Change("imu.csv", [k = 0](std::vector<double>* row) mutable {
    // Shaken by 2 m/s^2 all the time; the rows are increments.
    (*row)[4] += (++k % 2 == 0 ? 0.02 : -0.02);
  });
  const Outcome check = Check();
  EXPECT_THAT(check.out, HasSubstr("axes: z points down, as it should"));
  EXPECT_THAT(check.out,
              HasSubstr("by the mean specific force, as it never stands"));
}

TEST_F(Messages, GyrosThatDoNotFindNorth) {
  Simulate(R"(
start: {position: [48 deg, 11.5 deg, 500 m], heading: 65 deg}
segments: [{type: stop, duration: 40 s}]
imu: {rate: 100 Hz, noise: {gyro: 3 deg/sqrt(h), accel: 0.05 m/s/sqrt(h)}}
aiding: {gnss: {type: position, rate: 1 Hz, sigma: [0.2 m, 0.2 m, 0.4 m]}}
)");
  const Outcome run = Run("rts");
  EXPECT_THAT(run.out,
              HasSubstr("the gyros are too noisy to find north within"));
  EXPECT_THAT(run.out, HasSubstr("give initial.attitude, or a stream of "
                                 "velocities or headings"));
}

TEST_F(Messages, NoiseThatIsNotSeenHasNoFigures) {
  Simulate(kDriveWithWheels);
  const Outcome check = Check({"--noise"});
  EXPECT_THAT(check.out,
              HasSubstr("not seen by the data, leave as stated: imu.accel"));
  EXPECT_THAT(check.out, Not(HasSubstr("e+0")));
}

TEST_F(Messages, SpansWithoutLengthAreLeftOut) {
  Simulate(kDriveWithWheels);
  const Outcome run = Run("rts");
  ASSERT_TRUE(HasResults(run) || run.status == 1) << run.err;
  EXPECT_THAT(run.out, Not(HasSubstr("from 0.0 s to 0.0 s")));
  EXPECT_THAT(run.out, Not(HasSubstr("-0.0 s")));
}

TEST_F(Messages, OfConfigurationsSayWhatToWrite) {
  Simulate(kDriveWithWheels);
  const std::string good = ReadFile(root() / "data/config.yaml");
  const auto error = [&](const std::string& from, const std::string& to) {
    WriteFile(root() / "data/config.yaml", good);
    Replace(from, to);
    return ErrorOf(Check());
  };
  const std::string file = "file: gnss.csv\n";
  EXPECT_THAT(
      error(file, file + "    format: columns\n"
                         "    columns: {t: \"1 [s]\", sd_n: \"2 [m]\"}"
                         "\n"),
      HasSubstr("expected perhaps 'sd_ne', or one of t, t_rest, week, date, "
                "lat"));
  EXPECT_THAT(
      error(file, file + "    format: columns\n    columns: {t: 1 [s]}\n"),
      HasSubstr("a value with [ ] inside of { } stands in quotes"));
  EXPECT_THAT(error("file: truth.csv", "file: nothing.csv"),
              HasSubstr("there is no file"));
  WriteFile(root() / "data/untitled.csv",
            "time,lat[deg],lon[deg],h[m]\n"
            "1,48,11.5,500\n");
  EXPECT_THAT(error("gnss.csv", "untitled.csv"),
              HasSubstr("`format: columns` reads titles of any name"));
  WriteFile(root() / "data/late.csv",
            "t[s],lat[deg],lon[deg],h[m],sigma_n[m],sigma_e[m],sigma_d[m]\n"
            "1000,48,11.5,500,1,1,1\n90000,48,11.5,500,1,1,1\n");
  EXPECT_THAT(error("gnss.csv", "late.csv"),
              HasSubstr("is the unit of its t, or the rate, that of the file"));
}

TEST_F(Messages, GyrosWhoseUnitIsAnotherOne) {
  const testing::WalkRows rows =
      testing::Steps({.rate = 100.0, .force_noise = 0.01}, 1);
  std::string imu;
  for (std::size_t k = 0; k < rows.accel.size(); ++k) {
    constexpr double kDegrees = 57.29577951308232;
    imu +=
        fmt::format("{:.2f},{},{},{},{},{},{}\n", 0.01 * static_cast<double>(k),
                    kDegrees * rows.gyro[k].x(), kDegrees * rows.gyro[k].y(),
                    kDegrees * rows.gyro[k].z(), rows.accel[k].x(),
                    rows.accel[k].y(), rows.accel[k].z());
  }
  std::filesystem::create_directory(root() / "data");
  WriteFile(root() / "data/imu.csv", imu);
  WriteFile(root() / "data/config.yaml",
            "imu:\n  file: imu.csv\n  format: columns\n  columns: {t: \"1 "
            "[s]\", gyro_x: \"2 [rad/s]\", gyro_y: \"3 [rad/s]\", gyro_z: \"4 "
            "[rad/s]\", accel_x: \"5 [g]\", accel_y: \"6 [g]\", accel_z: \"7 "
            "[g]\"}\n  axes: [x, -y, -z]\n  noise: {gyro: 0.1 deg/s/sqrt(Hz), "
            "accel: 5 mg/sqrt(Hz)}\n");
  const Outcome check = Check();
  EXPECT_THAT(check.out, HasSubstr("they look like deg/s, declared as rad/s; "
                                   "correct the unit of gyro_x"))
      << check.err;
}

TEST_F(Messages, GyrosOfACarWhoseUnitIsAnotherOne) {
  std::string scenario = kDriveWithWheels;
  const std::string imu = "imu: {rate: 100 Hz, ";
  Simulate(
      scenario.replace(scenario.find(imu), imu.size(), imu + "kind: rates, "));
  EXPECT_THAT(Check().out, Not(HasSubstr("they look like")));
  Change("imu.csv", [](std::vector<double>* row) {
    for (std::size_t i = 1; i < 4; ++i) (*row)[i] *= 180.0 / 3.14159265358979;
  });
  EXPECT_THAT(Check().out,
              HasSubstr("the course turns 0.0175 times as far as the gyros "
                        "say: they look like deg/s, declared as rad/s"));
  Change("imu.csv", [](std::vector<double>* row) { (*row)[3] *= -1.0; });
  EXPECT_THAT(Check().out,
              HasSubstr("the course turns against the gyros: they have the "
                        "other sign"));
}

TEST_F(Messages, IncrementsWhoseUnitIsAnotherOne) {
  Simulate(kDriveWithWheels);
  EXPECT_THAT(Check().out, Not(HasSubstr("they look like")));
  Change("imu.csv", [](std::vector<double>* row) {
    for (std::size_t i = 1; i < 4; ++i) (*row)[i] *= 180.0 / 3.14159265358979;
  });
  EXPECT_THAT(Check().out,
              HasSubstr("they look like deg, declared as rad; correct the unit "
                        "of dtheta_x"));
}

TEST_F(Messages, StampsWhoseUnitIsShorterThanTheyAre) {
  Simulate(kDriveWithWheels);
  EXPECT_THAT(Check().out, HasSubstr("nothing looks wrong"));
  Change("gnss.csv", [](std::vector<double>* row) { (*row)[0] *= 1e-3; });
  EXPECT_THAT(Check().out, HasSubstr("gnss: 51 rows in 0.05 s of the IMU's "
                                     "50.0 s; the IMU's may be ms, or its own "
                                     "longer than they say"));
}

TEST_F(Messages, OfFilesThatAreNoNames) {
  Simulate(kDriveWithWheels);
  const std::string good = ReadFile(root() / "data/config.yaml");
  for (const auto& [value, said] :
       {std::pair{"[gnss.csv, '']", "is empty; expected a file, or a list"},
        {"{gnss.csv: 1}", "is a map; expected a file, or a list of files"},
        {"''", "is empty; expected a file"}}) {
    WriteFile(root() / "data/config.yaml", good);
    Replace("file: gnss.csv", std::string("file: ") + value);
    EXPECT_THAT(ErrorOf(Check()),
                HasSubstr(std::string("aiding.gnss.file: ") + said));
  }
}

TEST_F(Messages, TitlesAboveColumnsThatAreCounted) {
  Simulate(kDriveWithWheels);
  Replace("file: gnss.csv\n",
          "file: gnss.csv\n    format: columns\n    columns: {t: \"1 [s]\", "
          "lat: \"2 [deg]\", lon: \"3 [deg]\", h: \"4 [m]\", sigma_n: \"5 "
          "[m]\", sigma_e: \"6 [m]\", sigma_d: \"7 [m]\"}\n");
  EXPECT_THAT(ErrorOf(Check()), HasSubstr("is passed over by skip_lines: 1"));
}

}  // namespace
}  // namespace hindsight
