#include "io/config/scenario_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/units.h"
#include "support/recordings.h"

namespace hindsight {
namespace {

class ScenarioConfig : public ::testing::Test {
 protected:
  ScenarioConfig()
      : path_(std::filesystem::temp_directory_path() /
              ("scenario_config_test_" + std::to_string(getpid()) + ".yaml")) {}
  ~ScenarioConfig() override { std::filesystem::remove(path_); }

  Scenario Load(const std::string& text) const {
    std::ofstream(path_) << text;
    return LoadScenario(path_.string());
  }
  std::string ErrorOf(const std::string& text) const {
    try {
      Load(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::filesystem::path path_;
};

constexpr char kHead[] =
    "start: {position: [48 deg, 11 deg, 500 m], heading: 90 deg}\n";
constexpr char kSegments[] =
    "segments:\n"
    "  - {type: stop, duration: 10 s}\n"
    "  - {type: accelerate, speed: 36 m/s, rate: 2 m/s^2, blend: 0.5 s}\n"
    "  - {type: turn, angle: -90 deg, rate: 9 deg/s, banked: true}\n"
    "  - {type: pitch, angle: 5 deg, rate: 2 deg/s}\n"
    "  - {type: straight, duration: 1 min}\n";
constexpr char kScenarioImu[] =
    "imu:\n"
    "  kind: rates\n"
    "  rate: 100 Hz\n"
    "  noise: {gyro: 0.1 deg/sqrt(h), accel: 0.05 m/s/sqrt(h)}\n"
    "  gyro_bias_sigma: 3 deg/h\n"
    "  accel_scale: [100 ppm, 0 ppm, -100 ppm]\n";
constexpr char kRest[] =
    "aiding:\n"
    "  gnss:\n"
    "    type: position\n"
    "    rate: 4 Hz\n"
    "    sigma: [5 cm, 5 cm, 10 cm]\n"
    "    lever_arm: [0.5 m, 0 m, -1.2 m]\n"
    "    outages: [{from: 20 s, to: 30 s}]\n"
    "truth_rate: 20 Hz\n"
    "start_errors: {position: 0.1 m, velocity: 0.02 m/s, attitude: 0.5 deg}\n";

TEST_F(ScenarioConfig, ReadsEveryPartInSi) {
  const Scenario s = Load(std::string("name: demo\n") + kHead + kSegments +
                          kScenarioImu + kRest);
  EXPECT_EQ(s.name, "demo");
  EXPECT_NEAR(s.start.latitude, 48.0 * kDegree, 1e-15);
  EXPECT_NEAR(s.start_heading, 0.5 * kPi, 1e-15);
  ASSERT_EQ(s.segments.size(), 5U);
  EXPECT_EQ(s.segments[0].kind, Segment::Kind::kStop);
  EXPECT_EQ(s.segments[0].rate, 2.0);
  EXPECT_EQ(s.segments[1].blend, 0.5);
  EXPECT_EQ(s.segments[1].speed, 36.0);
  EXPECT_TRUE(s.segments[2].banked);
  EXPECT_NEAR(s.segments[2].angle, -0.5 * kPi, 1e-15);
  EXPECT_EQ(s.segments[3].kind, Segment::Kind::kPitch);
  EXPECT_EQ(s.segments[4].duration, 60.0);
  EXPECT_EQ(s.imu_kind, ImuStream::Kind::kRates);
  EXPECT_EQ(s.imu_rate_hz, 100.0);
  EXPECT_NEAR(s.imu.noise.gyro_noise_density, 0.1 * kDegreePerSqrtHour, 1e-16);
  EXPECT_NEAR(s.imu.gyro_bias_sigma.y(), 3.0 * kDegree / kHour, 1e-16);
  EXPECT_NEAR(s.imu.accel_scale.z(), -1e-4, 1e-16);
  ASSERT_EQ(s.aiding.size(), 1U);
  EXPECT_EQ(s.aiding[0].rate_hz, 4.0);
  EXPECT_NEAR(s.aiding[0].sigma->z(), 0.1, 1e-15);
  EXPECT_EQ(s.aiding[0].sensor.lever_arm_b.z(), -1.2);
  ASSERT_EQ(s.aiding[0].outages.size(), 1U);
  EXPECT_EQ(s.aiding[0].outages[0].end, 30.0);
  EXPECT_EQ(s.truth_rate_hz, 20.0);
  EXPECT_NEAR(s.start_errors->attitude.x(), 0.5 * kDegree, 1e-15);
  EXPECT_EQ(s.max_node_spacing, 1.0);
}

TEST_F(ScenarioConfig, WanderingRouteEndsWhenAsked) {
  const Scenario s =
      Load(std::string(kHead) + "wander: {duration: 300 s, seed: 4}\n" +
           kScenarioImu);
  EXPECT_GT(s.segments.size(), 10U);
  EXPECT_EQ(Simulate(s, 1).imu.t_end(), 300.0);
}

TEST_F(ScenarioConfig, NamesFileLineAndWhatIsWrong) {
  const std::string head = kHead;
  const std::string imu = kScenarioImu;
  EXPECT_THAT(ErrorOf(head + imu),
              ::testing::HasSubstr("segments: is missing"));
  EXPECT_THAT(
      ErrorOf(head + "segments:\n  - {type: turn, angle: 9 deg, rate: 9}\n" +
              imu),
      ::testing::HasSubstr(path_.string() + ":3: "));
  EXPECT_THAT(
      ErrorOf(head + "segments:\n  - {type: jump, duration: 1 s}\n" + imu),
      ::testing::HasSubstr(path_.string() + ":3: "));
  EXPECT_THAT(ErrorOf(head +
                      "segments:\n  - {type: straight, duration: 1 s}\n"
                      "  - {type: pitch, angle: 95 deg, rate: 5 deg/s}\n" +
                      imu),
              ::testing::HasSubstr("segment 2: the pitch"));
  EXPECT_THAT(ErrorOf(head + kSegments + imu + "color: red\n"),
              ::testing::HasSubstr("color"));
  EXPECT_THAT(
      ErrorOf(head + kSegments + imu + "aiding: {gnss: {type: position}}\n"),
      ::testing::HasSubstr("sigma: is missing"));
  EXPECT_THAT(ErrorOf(head + kSegments), ::testing::HasSubstr("noise"));
  EXPECT_THAT(ErrorOf("profile: none.csv\n" + imu),
              ::testing::HasSubstr("none.csv"));
}

TEST_F(ScenarioConfig, ARateFollowsFromDurationOrBank) {
  const Scenario s =
      Load(std::string(kHead) + kScenarioImu +
           "segments:\n"
           "  - {type: accelerate, speed: 30 m/s, duration: 11 s}\n"
           "  - type: repeat\n"
           "    times: 2\n"
           "    segments:\n"
           "      - {type: turn, bank: -45 deg, duration: 13 s, blend: 3 s}\n"
           "      - {type: pitch, angle: 9 deg, rate: 3 deg/s, blend: 0 s}\n");
  ASSERT_EQ(s.segments.size(), 5U);
  EXPECT_NEAR(s.segments[0].rate, 3.0, 1e-12);
  EXPECT_TRUE(s.segments[3].banked);
  EXPECT_NEAR(s.segments[3].rate, kStandardGravity / 30.0, 1e-12);
  EXPECT_NEAR(s.segments[3].angle, -10.0 * kStandardGravity / 30.0, 1e-12);
  EXPECT_EQ(s.segments[4].kind, Segment::Kind::kPitch);
}

TEST_F(ScenarioConfig, ChangesAndChoicesLayKeysOverTheFile) {
  const std::string text = std::string(kHead) + kSegments + kScenarioImu +
                           kRest +
                           "choices:\n"
                           "  fixes:\n"
                           "    sparse: {aiding: {gnss: {rate: 0.1 Hz}}}\n"
                           "    none: {aiding: {gnss: ~}, truth_rate: 1 Hz}\n";
  EXPECT_EQ(Load(text).aiding[0].rate_hz, 0.1);
  EXPECT_TRUE(Load(text + "fixes: none\n").aiding.empty());
  const auto changed = [&](const ScenarioChanges& changes) {
    return LoadScenario(path_.string(), changes);
  };
  EXPECT_EQ(changed({"fixes=none"}).truth_rate_hz, 1.0);
  const Scenario s = changed({"fixes=sparse", "aiding.*.rate=2 Hz",
                              "aiding.gnss.outages=~", "truth_rate=5 Hz"});
  EXPECT_EQ(s.aiding[0].rate_hz, 2.0);
  EXPECT_TRUE(s.aiding[0].outages.empty());
  EXPECT_EQ(s.truth_rate_hz, 5.0);
  for (const char* bad : {"fixes=many", "colour=red", "name.first=a", "=1",
                          "aiding.gnss.rate", "aiding.gnss.rate=[1"}) {
    EXPECT_THROW(changed({bad}), InputError) << bad;
  }
}

TEST_F(ScenarioConfig, MeasuresAtASpacingOfThePath) {
  const Scenario s = Load(
      std::string("start: {position: [48 deg, 11 deg, 0 m], speed: 10 m/s}\n"
                  "segments:\n"
                  "  - {type: straight, duration: 10 s}\n"
                  "  - {type: accelerate, speed: 20 m/s, rate: 1 m/s^2, blend: "
                  "0 s}\n") +
      kScenarioImu +
      "aiding: {marks: {type: position, spacing: 50 m, sigma: 1 m}}\n");
  const Dataset dataset = Simulate(s, 1);
  std::vector<double> times;
  for (const Measurement& z : dataset.streams[0].measurements) {
    times.push_back(z.t);
  }
  // 100 m in 10 s, then 150 m in 10 s: 10 u + u^2 / 2 = 50, 100, 150.
  ASSERT_EQ(times.size(), 5U);
  EXPECT_EQ(times[0], 5.0);
  EXPECT_EQ(times[1], 10.0);
  EXPECT_NEAR(times[2], 10.0 + std::sqrt(200.0) - 10.0, 1e-5);
  EXPECT_NEAR(times[3], 10.0 + std::sqrt(300.0) - 10.0, 1e-5);
  EXPECT_EQ(times[4], 20.0);
}

TEST_F(ScenarioConfig, FindsBuiltinNamesAndFiles) {
  EXPECT_EQ(FindScenario("short_drive").name, "short_drive");
  Load(std::string("name: mine\n") + kHead + kSegments + kScenarioImu);
  EXPECT_EQ(FindScenario(path_.string()).name, "mine");
  EXPECT_THROW(FindScenario("no_such_scenario"), InputError);
  for (const std::string& name : ScenarioNames()) {
    EXPECT_EQ(FindScenario(name).name, name);
  }
  EXPECT_THAT(ScenarioNames(), ::testing::IsSupersetOf({"flight", "corners"}));
}

TEST(ScenarioFiles, OfTheTreeCanBeSimulated) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(HINDSIGHT_SOURCE_DIR) / "data/scenarios")) {
    Scenario scenario = LoadScenario(entry.path().string());
    scenario.duration = std::min(scenario.duration, 200.0);
    const Dataset dataset = Simulate(scenario, 1);
    EXPECT_GT(dataset.imu.samples.size(), 1000U) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 1);
}

TEST_F(ScenarioConfig, ReadsMotionProfilesWithAndWithoutHeader) {
  const std::string rows =
      "0,48,11,500,10,0,0,0,0,0\n"
      "0.5,48.00004497,11,500,10,0,0,0,0,10\n"
      "1.0,48.00008994,11,500,10,0.5,0,1,2,20\n";
  for (const std::string header :
       {"",
        "t[s],lat[deg],lon[deg],h[m],v_n[m/s],v_e[m/s],v_d[m/s],"
        "roll[deg],pitch[deg],heading[deg]\n"}) {
    std::ofstream(path_) << header << rows;
    const std::vector<ProfilePoint> points = ReadMotionProfile(path_.string());
    ASSERT_EQ(points.size(), 3U);
    EXPECT_EQ(points[2].t, 1.0);
    EXPECT_NEAR(points[2].position.latitude, 48.00008994 * kDegree, 1e-14);
    EXPECT_NEAR(points[2].v_n.y(), 0.5, 1e-12);
    EXPECT_NEAR(points[2].euler.x(), 1.0 * kDegree, 1e-12);
    EXPECT_NEAR(points[2].euler.z(), 20.0 * kDegree, 1e-12);
  }
}

/// The deviations are what integrating the profile's own velocities leaves.
TEST(MotionProfiles, PublishedProfilesAreFollowed) {
  const std::filesystem::path folder =
      testing::RecordingsFolder() / "profiles_groves";
  if (!std::filesystem::exists(folder)) {
    GTEST_SKIP() << folder << " is absent";
  }
  struct Case {
    const char* file;
    double duration;
  };
  for (const Case& c :
       {Case{"Profile_1.csv.gz", 60.0}, Case{"Profile_3.csv.gz", 418.0}}) {
    SampledTrajectory trajectory(ReadMotionProfile((folder / c.file).string()));
    EXPECT_NEAR(trajectory.t_end(), c.duration, 1.0) << c.file;
    EXPECT_LT(trajectory.largest_position_deviation(), 0.002) << c.file;
    RecordProperty(c.file,
                   std::to_string(trajectory.largest_position_deviation()));
  }
}

}  // namespace
}  // namespace hindsight
