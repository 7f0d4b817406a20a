#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/command_line.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

/// A flight that banks into its turns, with velocities and without positions.
std::string BankedFlight(const std::string& segments) {
  return "start: {position: [48 deg, 11.5 deg, 1500 m], heading: 70 deg, "
         "speed: 60 m/s}\nsegments:\n" +
         segments +
         "imu:\n  rate: 100 Hz\n  noise: {gyro: 0.1 deg/sqrt(h), accel: "
         "0.05 m/s/sqrt(h)}\n  gyro_bias_sigma: 5 deg/h\n"
         "  accel_bias_sigma: 1 mg\n"
         "aiding:\n"
         "  doppler: {type: velocity, rate: 2 Hz, sigma: 0.1 m/s, lever_arm: "
         "[1.5 m, 0 m, -1 m]}\n"
         "truth_rate: 1 Hz\n"
         "start_errors: {position: 1 m, velocity: 0.2 m/s, "
         "attitude: [0.5 deg, 0.5 deg, 2 deg]}\n";
}

const char* const kTurns =
    "  - {type: straight, duration: 20 s}\n"
    "  - {type: turn, angle: 180 deg, rate: 4 deg/s, banked: true}\n"
    "  - {type: straight, duration: 20 s}\n"
    "  - {type: turn, angle: -180 deg, rate: 4 deg/s, banked: true}\n"
    "  - {type: accelerate, speed: 75 m/s, rate: 1 m/s^2}\n"
    "  - {type: turn, angle: 120 deg, rate: 4 deg/s, banked: true}\n"
    "  - {type: straight, duration: 20 s}\n";

/// The configuration without what it knows of the start, but for the position
/// if that is to be kept.
void ForgetStart(const std::filesystem::path& config, bool with_position) {
  const std::string text = ReadFile(config);
  std::string kept;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = text.find('\n', at) + 1;
    const std::string line = text.substr(at, end - at);
    const bool start = line.starts_with("  attitude") ||
                       line.starts_with("  velocity") ||
                       (line.starts_with("  position") && !with_position);
    if (!start) kept += line;
    at = end;
  }
  WriteFile(config, kept);
}

struct Flown {
  Outcome outcome;
  std::string summary;

  nlohmann::json Of(const std::string& method) const {
    return nlohmann::json::parse(summary)["methods"][method];
  }
};

Flown Fly(const TemporaryFolder& folder, const std::string& segments,
          const std::string& seed, bool with_position = true) {
  WriteFile(folder.path() / "scenario.yaml", BankedFlight(segments));
  const Outcome made = Hindsight(
      {"simulate", "scenario.yaml", "--seed=" + seed, "--out=data", "--force"},
      folder.path());
  EXPECT_EQ(made.status, 0) << made.err;
  ForgetStart(folder.path() / "data/config.yaml", with_position);
  Flown flown;
  flown.outcome =
      Hindsight({"run", "data/config.yaml", "--methods=ahrs,ahrs_smoother",
                 "--out=out", "--force"},
                folder.path());
  flown.summary = ReadFile(folder.path() / "out/summary.json");
  return flown;
}

/// Banked turns, in which a plumb line hangs askew, and a heading that nothing
/// but the accelerations tells.
TEST(AttitudeByVelocity, FindsTiltAndHeadingInBankedTurns) {
  const TemporaryFolder folder;
  double nees = 0.0;
  constexpr int kFlights = 4;
  for (int seed = 1; seed <= kFlights; ++seed) {
    const Flown flown = Fly(folder, kTurns, std::to_string(seed));
    EXPECT_EQ(flown.outcome.status, 0)
        << flown.outcome.out << flown.outcome.err;
    for (const char* method : {"ahrs", "ahrs_smoother"}) {
      const auto rms = flown.Of(method)["error"]["attitude_rms_deg"];
      EXPECT_LT(rms[0].get<double>(), 0.4) << method;
      EXPECT_LT(rms[1].get<double>(), 0.4) << method;
      EXPECT_LT(rms[2].get<double>(), 1.5) << method;
    }
    nees += flown.Of("ahrs_smoother")["nees"]["attitude"].get<double>();
  }
  EXPECT_LT(nees / kFlights, 6.0);
}

/// Without any position nothing says how the Earth turns under the gyros, which
/// then have 15 deg/h that are not theirs, more than their bias is said to be.
TEST(AttitudeByVelocity, IsDoubtfulWhereNothingSaysHowTheEarthTurns) {
  const TemporaryFolder folder;
  const Flown flown = Fly(folder, kTurns, "9", /*with_position=*/false);
  EXPECT_EQ(flown.outcome.status, 3);
  EXPECT_THAT(flown.outcome.out, HasSubstr("where on the Earth"));
}

/// A row of numbers changed, in every line of a file behind its titles.
void ChangeRows(const std::filesystem::path& file,
                const std::function<void(std::vector<double>*)>& change) {
  std::istringstream in(ReadFile(file));
  std::string line;
  std::getline(in, line);
  std::string text = line + "\n";
  while (std::getline(in, line)) {
    std::vector<double> row;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) {
      row.push_back(std::stod(field));
    }
    change(&row);
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += fmt::format("{}{:.12g}", i > 0 ? "," : "", row[i]);
    }
    text += "\n";
  }
  WriteFile(file, text);
}

/// What two velocities say of the attitude does not fit what they said before, or
/// tells no heading, and then what the body accelerates does not average out.
TEST(AttitudeByVelocity, WrongReadingsAreNotUsable) {
  struct Case {
    const char* what;
    const char* file;
    std::function<void(std::vector<double>*)> change;
  };
  const TemporaryFolder folder;
  for (const Case& wrong : {
           Case{"north and east exchanged", "doppler.csv",
                [](auto* row) { std::swap((*row)[1], (*row)[2]); }},
           Case{"km/h for m/s", "doppler.csv",
                [](auto* row) {
                  for (std::size_t i = 1; i < 4; ++i) (*row)[i] *= 3.6;
                }},
           Case{"3 s late", "doppler.csv", [](auto* row) { (*row)[0] += 3.0; }},
           Case{"a gyro that counts backwards", "imu.csv",
                [](auto* row) { (*row)[3] = -(*row)[3]; }},
           Case{"an accelerometer that counts backwards", "imu.csv",
                [](auto* row) { (*row)[4] = -(*row)[4]; }},
       }) {
    Fly(folder, kTurns, "31");
    ChangeRows(folder.path() / "data" / wrong.file, wrong.change);
    const Outcome run =
        Hindsight({"run", "data/config.yaml", "--methods=ahrs,ahrs_smoother",
                   "--out=out", "--force"},
                  folder.path());
    EXPECT_EQ(run.status, 1) << wrong.what << run.out << run.err;
    EXPECT_THAT(run.out, HasSubstr("innovations of the ")) << wrong.what;
  }
}

/// Straight ahead at one speed nothing tells the heading: then the velocities
/// are not used, which makes the result doubtful.
TEST(AttitudeByVelocity, IsOfNoUseWithoutAccelerations) {
  const TemporaryFolder folder;
  const Flown flown =
      Fly(folder, "  - {type: straight, duration: 120 s}\n", "3");
  EXPECT_EQ(flown.outcome.status, 3);
  EXPECT_THAT(flown.outcome.out,
              HasSubstr("'doppler' (velocity): nothing tells the heading"));
  for (const char* method : {"ahrs", "ahrs_smoother"}) {
    EXPECT_EQ(flown.Of(method)["grade"], "doubtful") << method;
  }
}

}  // namespace
}  // namespace hindsight
