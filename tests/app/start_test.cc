#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/recording.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::vector<double> NumbersOf(const std::string& line) {
  std::vector<double> numbers;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) {
    numbers.push_back(std::stod(cell));
  }
  return numbers;
}

std::vector<std::vector<double>> NumericRows(
    const std::filesystem::path& path) {
  std::vector<std::vector<double>> rows;
  for (const std::string& line : Lines(ReadFile(path))) {
    if (line.starts_with('#') || line.starts_with('t')) continue;
    rows.push_back(NumbersOf(line));
  }
  return rows;
}

/// Usable or doubtful.
bool GivesAnAnswer(const Outcome& outcome) {
  return outcome.status == 0 || outcome.status == 3;
}

class StartOfARun : public ::testing::Test {
 protected:
  /// Leaves rows from `t` on.
  void KeepFrom(const std::string& name, double t) {
    recording_.Edit(name, [&](std::vector<std::string>* lines) {
      std::erase_if(*lines, [&](const std::string& line) {
        return std::isdigit(line.front()) != 0 && std::stod(line) < t;
      });
    });
  }
  nlohmann::json StartOf(const std::string& out) const {
    return nlohmann::json::parse(
        ReadFile(recording_.root() / out / "summary.json"))["start"];
  }
  Recording recording_;
};

TEST_F(StartOfARun, StampsOfEitherEndGiveTheSameTrajectory) {
  // Every row is used: the IMU begins where the first interval does.
  const Outcome by_end =
      recording_.Run({"--out=by_end", "--methods=ekf,batch"});
  ASSERT_TRUE(GivesAnAnswer(by_end));
  EXPECT_THAT(by_end.out, HasSubstr("start at t = 0.000 s"));
  const double begin = StartOf("by_end")["t_s"].get<double>();
  EXPECT_EQ(begin, 0.0);
  EXPECT_FALSE(std::signbit(begin));
  recording_.Edit("imu.csv", [](std::vector<std::string>* lines) {
    double before = 0.0;
    for (std::string& line : *lines) {
      if (std::isdigit(line.front()) == 0) continue;
      const double t = std::stod(line);
      SetColumn(&line, 0, std::to_string(before));
      before = t;
    }
  });
  recording_.Replace("config.yaml", "imu:\n", "imu:\n  stamp: start\n");
  ASSERT_TRUE(
      GivesAnAnswer(recording_.Run({"--out=by_start", "--methods=ekf,batch"})));
  for (const char* name : {"ekf.csv", "batch.csv"}) {
    const auto a = NumericRows(recording_.root() / "by_end" / name);
    const auto b = NumericRows(recording_.root() / "by_start" / name);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
      EXPECT_EQ(a[k][0], b[k][0]);
      // Latitude, longitude [deg], height, velocity, attitude.
      for (std::size_t i = 1; i < 10; ++i) {
        const double unit = i < 3 ? 1.0 / 111e3 : 1.0;
        ASSERT_NEAR(a[k][i], b[k][i], 0.001 * unit * a[k][9 + i])
            << name << " " << k << " " << i;
      }
    }
  }
}

TEST_F(StartOfARun, RatesHaveNoStartOfAnInterval) {
  recording_.Edit("imu.csv", [](std::vector<std::string>* lines) {
    lines->front() =
        "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],accel_x[m/s^2],"
        "accel_y[m/s^2],accel_z[m/s^2]";
  });
  recording_.Replace("config.yaml", "kind: increments",
                     "kind: rates\n  stamp: start");
  const Outcome outcome =
      Hindsight({"check", "data/config.yaml"}, recording_.root());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("imu.stamp"));
}

TEST_F(StartOfARun, ShortErrorsAndCountsAreCarriedBackToTheFirstSample) {
  std::string counts = "t[s],distance[m]\n";
  double distance = 0.0;
  double before = 0.0;
  for (const auto& row : NumericRows(recording_.file("truth.csv"))) {
    distance += std::hypot(row[4], row[5]) * (row[0] - before);
    before = row[0];
    if (row[0] > 22.0) {
      counts += std::to_string(row[0]) + "," + std::to_string(distance) + "\n";
    }
  }
  WriteFile(recording_.file("wheel.csv"), counts);
  KeepFrom("gnss.csv", 20.0);
  KeepFrom("speed.csv", 20.0);
  recording_.Replace("config.yaml", "file: gnss.csv\n",
                     "file: gnss.csv\n    noise: {model: gauss_markov, sigma: "
                     "0.2 m, tau: 0.1 s, white: 0.05 m}\n");
  recording_.Replace("config.yaml", "aiding:\n",
                     "aiding:\n  wheel: {type: odometer, form: increments, "
                     "file: wheel.csv, sigma: 0.05 m, count_sigma: 0.01 m}\n");
  // Without aiding smooth motion would be called rest.
  recording_.Edit("config.yaml", [](std::vector<std::string>* lines) {
    bool inside = false;
    std::erase_if(*lines, [&](const std::string& line) {
      inside =
          line.starts_with("stationary:") || (inside && line.starts_with(' '));
      return inside;
    });
  });
  const Outcome outcome = recording_.Run(
      {"--out=out", "--methods=ekf,two_filter,rts,iterated,batch"});
  EXPECT_TRUE(GivesAnAnswer(outcome)) << outcome.err << outcome.out;
  EXPECT_THAT(outcome.out, Not(HasSubstr("nan")));
  EXPECT_THAT(outcome.out, HasSubstr("back to the start by the IMU"));
  EXPECT_LT(StartOf("out")["t_s"].get<double>(), 1.0);
  EXPECT_THAT(outcome.out, Not(HasSubstr("not positive definite")));
}

TEST_F(StartOfARun, MoreValuesThanTheLayoutHoldsAreRefusedByCheckToo) {
  std::string receivers = "aiding:\n";
  for (int i = 0; i < 6; ++i) {
    receivers += "  gnss_" + std::to_string(i) +
                 ": {type: position, file: gnss.csv, estimate: {lever_arm: 1 "
                 "m, time_offset: 1 s}, noise: {model: gauss_markov, sigma: 1 "
                 "m, tau: 9 s, white: 0.1 m}}\n";
  }
  recording_.Replace("config.yaml", "aiding:\n", receivers);
  const Outcome check =
      Hindsight({"check", "data/config.yaml"}, recording_.root());
  EXPECT_EQ(check.status, 2);
  EXPECT_THAT(check.err, HasSubstr("config.yaml"));
  EXPECT_THAT(check.err, HasSubstr("42 values"));
  EXPECT_THAT(check.err, HasSubstr("at most 33"));
  EXPECT_THAT(check.err, HasSubstr("aiding.gnss_0 7"));
  const Outcome run = recording_.Run({"--out=out"});
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(run.err, check.err);
}

TEST_F(StartOfARun, AFlippedMagnetometerIsNamedByCheckAndRun) {
  // The field of Munich in body axes, the z axis up.
  std::string text = "t[s],mag_x[uT],mag_y[uT],mag_z[uT]\n";
  for (const auto& row : NumericRows(recording_.file("truth.csv"))) {
    const double heading = row[9] * M_PI / 180.0;
    text += std::to_string(row[0]) + "," +
            std::to_string(21.0 * std::cos(heading)) + "," +
            std::to_string(-21.0 * std::sin(heading)) + ",-43.0\n";
  }
  WriteFile(recording_.file("compass.csv"), text);
  recording_.Replace("config.yaml", "aiding:\n",
                     "aiding:\n  compass: {type: magnetometer, file: "
                     "compass.csv, form: vector, sigma: 0.5 uT, horizontal: 21 "
                     "uT, down: 43 uT}\n");
  const Outcome check =
      Hindsight({"check", "data/config.yaml"}, recording_.root());
  EXPECT_EQ(check.status, 3);
  EXPECT_THAT(check.out, HasSubstr("compass: axis z looks flipped"));
  const Outcome run = recording_.Run({"--out=out", "--methods=ekf,rts"});
  EXPECT_THAT(run.out, HasSubstr("compass: axis z looks flipped"));
  EXPECT_THAT(run.status, ::testing::AnyOf(1, 3));
  const nlohmann::json summary =
      nlohmann::json::parse(ReadFile(recording_.root() / "out/summary.json"));
  for (const auto& [name, method] : summary["methods"].items()) {
    EXPECT_NE(method["grade"], "usable") << name;
  }
}

}  // namespace
}  // namespace hindsight
