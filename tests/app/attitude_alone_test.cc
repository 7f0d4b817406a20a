#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "app/command_line.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

/// An IMU, alone unless something is `aiding`, on a body that goes where `segments`
/// say.
std::string BodyAlone(const std::string& segments, const std::string& imu,
                      const std::string& aiding = "") {
  return "start: {position: [48 deg, 11.5 deg, 0 m], heading: 70 deg, "
         "speed: 1.5 m/s}\nsegments:\n" +
         segments + "imu:\n  rate: 100 Hz\n" + imu + "aiding: {" + aiding +
         "}\ntruth_rate: 10 Hz\n"
         "start_errors: {position: 1 m, velocity: 0.2 m/s, "
         "attitude: [0.05 deg, 0.05 deg, 0.1 deg]}\n";
}

const char* const kFibreOptic =
    "  noise: {gyro: 0.01 deg/sqrt(h), accel: 20 ug/sqrt(Hz)}\n"
    "  gyro_bias_sigma: 0.05 deg/h\n  accel_bias_sigma: 0.1 mg\n";
const char* const kMems =
    "  noise: {gyro: 0.15 deg/sqrt(h), accel: 0.05 m/s/sqrt(h)}\n"
    "  gyro_bias_sigma: 10 deg/h\n  accel_bias_sigma: 2 mg\n";

class AttitudeAlone : public ::testing::Test {
 protected:
  void Simulate(const std::string& scenario) {
    WriteFile(folder_.path() / "scenario.yaml", scenario);
    const Outcome made =
        Hindsight({"simulate", "scenario.yaml", "--seed=5", "--out=data"},
                  folder_.path());
    ASSERT_EQ(made.status, 0) << made.err;
  }

  std::filesystem::path config() const {
    return folder_.path() / "data/config.yaml";
  }

  /// Of `ahrs` and `ahrs_smoother`.
  nlohmann::json Run() {
    const Outcome run =
        Hindsight({"run", "data/config.yaml", "--methods=ahrs,ahrs_smoother",
                   "--out=out", "--force"},
                  folder_.path());
    said_ = run.out + run.err;
    return nlohmann::json::parse(
        ReadFile(folder_.path() / "out/summary.json"))["methods"];
  }

  void ReplaceStart(const std::string& lines) {
    const std::string text = ReadFile(config());
    const std::size_t begin = text.find("initial:");
    const std::size_t end = text.find("truth:");
    ASSERT_NE(end, std::string::npos);
    WriteFile(config(), text.substr(0, begin) + lines + text.substr(end));
  }

  TemporaryFolder folder_;
  std::string said_;
};

/// Stamps of the rows of a table [s].
std::vector<double> StampsOf(const std::string& table) {
  std::vector<double> stamps;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    if (line.find_first_of("0123456789") == 0) {
      stamps.push_back(std::stod(line));
    }
  }
  return stamps;
}

// More of them than rows are written at once.
TEST_F(AttitudeAlone, HasARowASample) {
  Simulate(BodyAlone("  - {type: straight, duration: 125 s}\n", kFibreOptic));
  Run();
  const std::vector<double> stamps =
      StampsOf(ReadFile(folder_.path() / "out/ahrs.csv"));
  ASSERT_GT(stamps.size(), 12000u) << said_;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    ASSERT_NEAR(stamps[i] - stamps[i - 1], 0.01, 1e-5) << i;
  }
  EXPECT_EQ(StampsOf(ReadFile(folder_.path() / "out/ahrs.motion.csv")).size(),
            stamps.size());
}

TEST_F(AttitudeAlone, IsNotUsableWhereTheBodyAccelerates) {
  std::string drive;
  for (int i = 0; i < 5; ++i) {
    drive +=
        "  - {type: accelerate, speed: 20 m/s, rate: 1.5 m/s^2}\n"
        "  - {type: straight, duration: 10 s}\n"
        "  - {type: turn, angle: 90 deg, rate: 15 deg/s}\n"
        "  - {type: accelerate, speed: 1.5 m/s, rate: 2 m/s^2}\n";
  }
  Simulate(BodyAlone(drive, kMems));
  const nlohmann::json methods = Run();
  for (const auto& [name, method] : methods.items()) {
    EXPECT_EQ(method["grade"], "not usable") << name << said_;
  }
  EXPECT_THAT(said_, HasSubstr("innovations of the accelerometer"));
}

/// A turn that rest by a hand's thresholds would hide.
TEST_F(AttitudeAlone, FollowsASlowSteadyTurn) {
  Simulate(
      BodyAlone("  - {type: straight, duration: 20 s}\n"
                "  - {type: turn, angle: 60 deg, rate: 0.2 deg/s}\n"
                "  - {type: straight, duration: 20 s}\n",
                kFibreOptic));
  const nlohmann::json methods = Run();
  for (const auto& [name, method] : methods.items()) {
    EXPECT_EQ(method["grade"], "usable") << name << said_;
    EXPECT_LT(method["nees"]["attitude"].get<double>(), 8.0) << name << said_;
  }
}

/// While it turns by 10 deg/s, an attitude of 3.005 s is none of the beginning.
TEST_F(AttitudeAlone, StartsAtTheTimeOfTheAttitudeThatIsGiven) {
  Simulate(
      BodyAlone("  - {type: turn, angle: 360 deg, rate: 10 deg/s}\n"
                "  - {type: straight, duration: 30 s}\n",
                kFibreOptic));
  ReplaceStart(
      "initial:\n  from: truth\n  time: 3.005 s\n"
      "  attitude_sigma: [0.05 deg, 0.05 deg, 0.1 deg]\n"
      "  gyro_bias_sigma: 0.05 deg/h\n");
  const nlohmann::json methods = Run();
  for (const auto& [name, method] : methods.items()) {
    EXPECT_LT(method["nees"]["attitude"].get<double>(), 8.0) << name << said_;
    EXPECT_LT(method["error"]["attitude_rms_deg"][2].get<double>(), 0.5)
        << name << said_;
  }
}

/// Attitude alone needs the direction of gravity, not its size: a unit that is a
/// thousand times off would not show otherwise.
TEST_F(AttitudeAlone, HearsOfAccelerationsThatAreNotGravity) {
  Simulate(BodyAlone("  - {type: straight, duration: 60 s}\n", kFibreOptic));
  std::istringstream in(ReadFile(folder_.path() / "data/imu.csv"));
  std::string text;
  std::string line;
  std::getline(in, text);
  text += "\n";
  while (std::getline(in, line)) {
    std::size_t at = 0;
    for (int column = 0; column < 4; ++column) at = line.find(',', at) + 1;
    text += line.substr(0, at) + "0,0,-0.0001\n";
  }
  WriteFile(folder_.path() / "data/imu.csv", text);
  const nlohmann::json methods = Run();
  for (const auto& [name, method] : methods.items()) {
    EXPECT_NE(method["grade"], "usable") << name;
  }
  EXPECT_THAT(said_, HasSubstr("times gravity in the median"));
}

/// A heading that the velocities of turns contradict.
TEST_F(AttitudeAlone, HearsOfAStartThatIsContradicted) {
  Simulate(BodyAlone(
      "  - {type: accelerate, speed: 20 m/s, rate: 1 m/s^2}\n"
      "  - {type: turn, angle: 180 deg, rate: 10 deg/s}\n"
      "  - {type: accelerate, speed: 5 m/s, rate: 1 m/s^2}\n"
      "  - {type: turn, angle: -90 deg, rate: 10 deg/s}\n",
      kMems, "doppler: {type: velocity, rate: 2 Hz, sigma: 0.1 m/s}"));
  ReplaceStart(
      "initial:\n  time: 0 s\n  position: [48 deg, 11.5 deg, 0 m]\n"
      "  attitude: [0 deg, 0 deg, 130 deg]\n"
      "  attitude_sigma: [0.5, 0.5, 2 deg]\n  gyro_bias_sigma: 10 deg/h\n"
      "  accel_bias_sigma: 2 mg\n");
  const nlohmann::json methods = Run();
  EXPECT_NE(methods["ahrs_smoother"]["grade"], "usable") << said_;
}

/// A sensor in the hand with a magnetometer, a minute and a half.
class WornSensor : public ::testing::Test {
 protected:
  void SetUp() override {
    const Outcome made = Hindsight({"simulate", "test_worn", "--seed=3",
                                    "--set=hand.duration=90 s", "--out=data"},
                                   folder_.path());
    ASSERT_EQ(made.status, 0) << made.err;
  }

  /// Verdicts of `ahrs` and `ahrs_smoother`, each run alone.
  /// By name, of one run.
  nlohmann::json RunBoth() {
    Hindsight({"run", "data/config.yaml", "--methods=ahrs,ahrs_smoother",
               "--out=out", "--force"},
              folder_.path());
    return nlohmann::json::parse(
        ReadFile(folder_.path() / "out/summary.json"))["methods"];
  }

  std::vector<nlohmann::json> Run() {
    std::vector<nlohmann::json> methods;
    for (const std::string method : {"ahrs", "ahrs_smoother"}) {
      Hindsight({"run", "data/config.yaml", "--methods=" + method, "--out=out",
                 "--force"},
                folder_.path());
      methods.push_back(nlohmann::json::parse(
          ReadFile(folder_.path() / "out/summary.json"))["methods"][method]);
    }
    return methods;
  }

  void Replace(const std::string& from, const std::string& to) {
    std::string text = ReadFile(folder_.path() / "data/config.yaml");
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << text;
    WriteFile(folder_.path() / "data/config.yaml",
              text.replace(at, from.size(), to));
  }

  /// Changes the numbers of columns first to last, counted from 0.
  void Edit(const std::string& file, int first, int last,
            double (*change)(double)) {
    const auto path = folder_.path() / "data" / file;
    std::istringstream lines(ReadFile(path));
    std::string text;
    for (std::string line; std::getline(lines, line); text += "\n") {
      if (line.find('[') != std::string::npos) {
        text += line;
        continue;
      }
      std::istringstream fields(line);
      int column = 0;
      for (std::string field; std::getline(fields, field, ','); ++column) {
        text += column > 0 ? "," : "";
        text += column < first || column > last
                    ? field
                    : std::to_string(change(std::stod(field)));
      }
    }
    WriteFile(path, text);
  }

  TemporaryFolder folder_;
};

TEST_F(WornSensor, IsUsableAsItIs) {
  for (const nlohmann::json& method : Run()) {
    EXPECT_EQ(method["grade"], "usable") << method["verdict"];
    EXPECT_LT(method["nees"]["attitude"], 4.0);
  }
}

TEST_F(WornSensor, HearsOfAMagnetometerThatIsMountedAskew) {
  Replace("type: magnetometer",
          "type: magnetometer\n    mounting: [0 deg, 0 deg, 8 deg]");
  for (const nlohmann::json& method : Run()) {
    EXPECT_NE(method["grade"], "usable");
    EXPECT_THAT(method["evidence"].dump(), HasSubstr("8.0 deg about"));
  }
}

/// A hard iron that the smoother takes off and the filter cannot: the dip that
/// the filter finds says so.
TEST_F(WornSensor, IronThatTheSmootherTakesOffIsDoubtfulInTheFilterAlone) {
  Edit("compass.csv", 1, 1, [](double x) { return x + 15.0; });
  const nlohmann::json methods = RunBoth();
  EXPECT_EQ(methods["ahrs"]["grade"], "doubtful");
  EXPECT_EQ(methods["ahrs_smoother"]["grade"], "usable")
      << methods["ahrs_smoother"]["verdict"];
  EXPECT_LT(methods["ahrs_smoother"]["nees"]["attitude"], 4.0);
}

/// Without a dip that says so the two are apart, which is known once both have
/// run.
TEST_F(WornSensor, TheTableHasTheGradesThatTheEvidenceGives) {
  Replace("form: vector", "form: heading");
  Replace("    down: 43 uT\n", "");
  Edit("compass.csv", 1, 1, [](double x) { return x + 15.0; });
  const nlohmann::json methods = RunBoth();
  for (const auto& [name, method] : methods.items()) {
    std::string worst = "usable";
    for (const auto& evidence : method["evidence"]) {
      if (evidence["grade"] == "not usable" ||
          (evidence["grade"] == "doubtful" && worst == "usable")) {
        worst = evidence["grade"];
      }
    }
    EXPECT_NE(worst, "usable") << name;
    EXPECT_EQ(method["grade"], worst) << name;
  }
}

/// The field of test_worn, 21 and 43 uT.
TEST_F(WornSensor, TellsTheFieldThatItFound) {
  const nlohmann::json methods = RunBoth();
  EXPECT_THAT(methods["ahrs_smoother"]["found"].dump(),
              ::testing::ContainsRegex("a field of 2[01].. uT horizontal and "
                                       "4[23].. uT down"));
}

TEST_F(WornSensor, HearsOfGyrosOfAnotherScale) {
  Edit("imu.csv", 1, 3, [](double w) { return 0.95 * w; });
  for (const nlohmann::json& method : Run()) {
    EXPECT_NE(method["grade"], "usable");
    EXPECT_THAT(method["evidence"].dump(), HasSubstr("gyro_scale"));
  }
}

TEST_F(WornSensor, HearsOfAFieldThatScattersBeyondItsSigma) {
  Replace("sigma: 1 uT", "sigma: 0.3 uT");
  for (const nlohmann::json& method : Run()) {
    EXPECT_EQ(method["grade"], "doubtful");
    EXPECT_THAT(method["evidence"].dump(), HasSubstr("times what its sigma"));
  }
}

}  // namespace
}  // namespace hindsight
