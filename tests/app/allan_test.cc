#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/recording.h"

namespace hindsight {
namespace {

constexpr const char* kRestThenDrive = R"(
start: {position: [48 deg, 11.5 deg, 500 m], heading: 65 deg}
segments:
  - {type: stop, duration: SECONDS s}
  - {type: accelerate, speed: 8 m/s, rate: 2 m/s^2}
  - {type: turn, angle: 90 deg, rate: 20 deg/s}
imu: {rate: 50 Hz, noise: {gyro: 0.3 deg/sqrt(h), accel: 0.1 m/s/sqrt(h)}}
aiding: {gnss: {type: position, rate: 1 Hz, sigma: [0.2 m, 0.2 m, 0.4 m]}}
)";

nlohmann::json RunAtRest(const std::string& seconds,
                         const std::filesystem::path& root) {
  std::string scenario = kRestThenDrive;
  scenario.replace(scenario.find("SECONDS"), 7, seconds);
  WriteFile(root / "scenario.yaml", scenario);
  const Outcome made =
      Hindsight({"simulate", "scenario.yaml", "--out=data", "--seed=11"}, root);
  EXPECT_EQ(made.status, 0) << made.err;
  const Outcome run = Hindsight(
      {"run", "data/config.yaml", "--methods=rts", "--report", "--out=out"},
      root);
  EXPECT_NE(run.status, 2) << run.err;
  return nlohmann::json::parse(ReadFile(root / "out/summary.json"));
}

TEST(AllanInTheReport, IsOfTheLongestRestAndDrawn) {
  const TemporaryFolder folder;
  const auto summary = RunAtRest("400", folder.path());
  ASSERT_TRUE(summary.contains("allan"));
  const auto& axes = summary["allan"]["axes"];
  ASSERT_EQ(axes.size(), 6u);
  const double gyro = 0.3 / 60.0 * 3.14159265358979 / 180.0;
  for (std::size_t i = 0; i < 6; ++i) {
    const double stated = i < 3 ? gyro : 0.1 / 60.0;
    const auto& white = axes[i]["white"];
    EXPECT_NEAR(white["value"].get<double>() / stated, 1.0, 0.1) << i;
    EXPECT_LT(white["sigma"].get<double>(), 0.1 * stated) << i;
    EXPECT_EQ(axes[i]["deviation"].size(), summary["allan"]["tau_s"].size());
  }
  // The page and one that is made of the folder later show it.
  const Outcome again =
      Hindsight({"report", "out", "--out=page.html"}, folder.path());
  EXPECT_EQ(again.status, 0) << again.err;
  for (const char* page : {"out/report.html", "page.html"}) {
    const std::string html = ReadFile(folder.path() / page);
    for (const char* text :
         {"<section id=\"allan\">", "gyro x [deg/s]", "accel z [mg]",
          "cluster time [s]", "white noise</strong>"}) {
      EXPECT_NE(html.find(text), std::string::npos) << page << ": " << text;
    }
  }
}

TEST(AllanInTheReport, SaysWhyThereIsNone) {
  const TemporaryFolder folder;
  const auto summary = RunAtRest("5", folder.path());
  EXPECT_FALSE(summary.contains("allan"));
  EXPECT_NE(ReadFile(folder.path() / "out/report.html")
                .find("No rest of 1000 samples was found."),
            std::string::npos);
}

/// A recording of rest alone, with the readings of one gyro `factor` times as
/// large; the lines that --allan proposes.
std::string ProposedAtRest(const std::filesystem::path& root, double factor) {
  WriteFile(root / "scenario.yaml",
            "start: {position: [48 deg, 11.5 deg, 500 m], heading: 65 deg}\n"
            "segments: [{type: stop, duration: 400 s}]\n"
            "imu: {rate: 50 Hz, kind: rates, noise: {gyro: 0.3 deg/sqrt(h), "
            "accel: 0.1 m/s/sqrt(h)}}\n"
            "aiding: {gnss: {type: position, rate: 1 Hz, sigma: 1 m}}\n"
            "stationary: on\n");
  const Outcome made = Hindsight(
      {"simulate", "scenario.yaml", "--out=data", "--force", "--seed=11"},
      root);
  EXPECT_EQ(made.status, 0) << made.err;
  std::vector<std::string> lines = Lines(ReadFile(root / "data/imu.csv"));
  for (std::string& line : lines) {
    if (line.front() < '0' || line.front() > '9') continue;
    const std::size_t begin = line.find(',', line.find(',') + 1) + 1;
    const double y = std::stod(line.substr(begin));
    SetColumn(&line, 2, std::to_string(1e6 * factor * y) + "e-6");
  }
  WriteFile(root / "data/imu.csv", Join(lines));
  const Outcome check =
      Hindsight({"check", "data/config.yaml", "--allan"}, root);
  const std::size_t at = check.out.find("  noise:\n");
  EXPECT_NE(at, std::string::npos) << check.out << check.err;
  return at == std::string::npos ? "" : check.out.substr(at);
}

TEST(AllanProposal, SaysWhatIsSeenAndWhichAxisIsTheNoisiest) {
  const TemporaryFolder folder;
  const std::string alike = ProposedAtRest(folder.path(), 1.0);
  // Nothing walks in this scenario.
  for (const char* text :
       {"    # gyro_bias_walk: not seen in this rest, below ",
        "    # accel_bias_walk: not seen in this rest"}) {
    EXPECT_NE(alike.find(text), std::string::npos) << alike;
  }
  EXPECT_EQ(alike.find("largest"), std::string::npos) << alike;
  const std::string apart = ProposedAtRest(folder.path(), 4.0);
  const std::string key = "    gyro: ";
  const std::size_t at = apart.find(key);
  ASSERT_NE(at, std::string::npos) << apart;
  EXPECT_NEAR(std::stod(apart.substr(at + key.size())) / (4.0 * 0.3 / 60.0),
              1.0, 0.15)
      << apart;
  EXPECT_NE(apart.find("# gyro y, the largest: "), std::string::npos) << apart;
  EXPECT_NE(apart.find(" times gyro "), std::string::npos) << apart;
}

TEST(VehicleByName, IsToldByTheRun) {
  const TemporaryFolder folder;
  RunAtRest("20", folder.path());
  const auto config = folder.path() / "data/config.yaml";
  WriteFile(config, "vehicle: car\n" + ReadFile(config));
  const Outcome run = Hindsight(
      {"run", "data/config.yaml", "--methods=rts", "--out=car"}, folder.path());
  EXPECT_NE(
      run.out.find("note: vehicle car sets stationary: on; aiding.wheels"),
      std::string::npos)
      << run.out << run.err;
  const std::string resolved =
      ReadFile(folder.path() / "car/config.resolved.yaml");
  for (const char* text :
       {"vehicle: car", "type: non_holonomic", "speed_spread: 15 m/s"}) {
    EXPECT_NE(resolved.find(text), std::string::npos) << resolved;
  }
}

}  // namespace
}  // namespace hindsight
