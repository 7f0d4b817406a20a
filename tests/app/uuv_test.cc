#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/command_line.h"

namespace hindsight {
namespace {

using Json = nlohmann::json;

Json ReadJson(const std::filesystem::path& path) {
  return Json::parse(ReadFile(path));
}

/// Beams that drop out, water track after half of the way, a depth gauge.
constexpr const char* kScenario = R"(
name: dive
start: {position: [35 deg, 129 deg, 0 m], heading: 20 deg, speed: 1.5 m/s}
segments:
  - {type: straight, duration: 20 s}
  - {type: pitch, angle: -10 deg, rate: 2 deg/s}
  - {type: turn, angle: 120 deg, rate: 4 deg/s}
  - {type: straight, duration: 60 s}
duration: 100 s
imu:
  rate: 50 Hz
  noise: {gyro: 0.07 deg/sqrt(h), accel: 50 ug/sqrt(Hz)}
  gyro_bias_sigma: 1 deg/h
  accel_bias_sigma: 0.3 mg
aiding:
  dvl: {type: dvl, form: beams, beam_angle: 20 deg, rate: 1 Hz, sigma: 2 cm/s,
        lever_arm: [1 m, 0 m, 0.3 m], beam_dropout: 20 %,
        estimate: {scale: 0.3 %, mounting: 0.2 deg}}
  water: {type: dvl, rate: 1 Hz, sigma: 2 cm/s, track: water,
          current: {sigma: 0.3 m/s, time: 600 s},
          true_current: [0.2, -0.1, 0 m/s]}
  depth: {type: height, rate: 1 Hz, sigma: 0.1 m, estimate: {offset: 0.3 m}}
  lbl: {type: acoustic, rate: 0.2 Hz, sigma: 0.5 m, bearing_sigma: 1 deg,
        transponder: [35.001 deg, 129.001 deg, -80 m]}
start_errors: {position: 1 m, velocity: 0.02 m/s, attitude: 0.2 deg}
)";

TEST(Uuv, SimulatedDiveIsReconstructedFromItsFiles) {
  const TemporaryFolder folder;
  WriteFile(folder.path() / "dive.yaml", kScenario);
  const Outcome made = Hindsight(
      {"simulate", "dive.yaml", "--out=dive", "--seed=3"}, folder.path());
  ASSERT_EQ(made.status, 0) << made.err;
  const std::vector<std::string> rows =
      Lines(ReadFile(folder.path() / "dive" / "dvl.csv"));
  EXPECT_EQ(rows[0].substr(0, 16), "t[s],beam_1[m/s]");
  const Outcome run = Hindsight(
      {"run", "dive/config.yaml", "--methods=ekf,batch", "--out=result"},
      folder.path());
  ASSERT_EQ(run.status, 0) << run.out << run.err;
  const Json summary = ReadJson(folder.path() / "result" / "summary.json");
  const Json& batch = summary["methods"]["batch"];
  EXPECT_LT(batch["error"]["horizontal_max_m"].get<double>(), 3.0);
  EXPECT_NEAR(batch["error"]["distance_m"].get<double>(), 150.0, 5.0);
  EXPECT_TRUE(batch["constants"].contains("dvl_scale"));
  EXPECT_TRUE(batch["constants"].contains("depth_offset"));
  // Residuals of every stream, a line a beam that came back.
  const std::string residuals =
      ReadFile(folder.path() / "result" / "residuals.csv");
  for (const char* sensor : {",dvl,3,", ",water,2,", ",depth,0,", ",lbl,2,"}) {
    EXPECT_NE(residuals.find(sensor), std::string::npos) << sensor;
  }
}

TEST(Uuv, WaterTrackWithoutCurrentIsAnError) {
  const TemporaryFolder folder;
  std::string text = kScenario;
  const std::string current = "current: {sigma: 0.3 m/s, time: 600 s},";
  text.erase(text.find(current), current.size());
  WriteFile(folder.path() / "dive.yaml", text);
  const Outcome made =
      Hindsight({"simulate", "dive.yaml", "--out=dive"}, folder.path());
  EXPECT_EQ(made.status, 2);
  EXPECT_NE(made.err.find("aiding.water.current"), std::string::npos)
      << made.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "dive"));
}

TEST(Uuv, FusionsOfThePaperPrintTheReadingsAskedFor) {
  const TemporaryFolder folder;
  const Outcome run =
      Hindsight({"montecarlo", "uuv_search", "--runs=2",
                 "--reading=sum,white,diagonal", "--out=search"},
                folder.path());
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("sum,diagonal,white,alike"), std::string::npos);
  const Json json = ReadJson(folder.path() / "search" / "montecarlo.json");
  EXPECT_EQ(json["readings"].size(), 2u);
  const Json& equal = json["readings"]["sum,diagonal,white,alike"];
  EXPECT_GT(equal["central"]["spatial"]["mean_m"].get<double>(), 1.0);
  EXPECT_LT(equal["equalised"]["spatial"]["mean_m"].get<double>(), 0.1);
  EXPECT_FALSE(equal["central"]["horizontal"]["histogram"].empty());
  EXPECT_GT(json["matched"]["two sensors of 9.8 m"]["equalised"]["nees"]
                .get<double>(),
            2.0);

  const Outcome unknown =
      Hindsight({"montecarlo", "uuv_search", "--reading=tidal", "--out=x"},
                folder.path());
  EXPECT_EQ(unknown.status, 2);
  EXPECT_NE(unknown.err.find("tidal"), std::string::npos);
}

TEST(Uuv, CalibrationJudgesTheConstantsOfTheLog) {
  const TemporaryFolder folder;
  const Outcome run =
      Hindsight({"montecarlo", "uuv_calibration", "--runs=4", "--out=out"},
                folder.path());
  ASSERT_EQ(run.status, 0) << run.err;
  const Json constants =
      ReadJson(folder.path() / "out" /
               "montecarlo.json")["methods"]["batch"]["constants"];
  for (const char* name :
       {"dvl_scale", "dvl_mounting[z]", "dvl_lever_arm[x]"}) {
    EXPECT_EQ(constants[name]["observed"], 4) << name;
    EXPECT_LT(constants[name]["sigma"].get<double>(),
              0.1 * constants[name]["prior_sigma"].get<double>())
        << name;
  }
  // The eights are level: nothing tells how deep the transducer sits.
  EXPECT_EQ(constants["dvl_lever_arm[z]"]["unobserved"], 4);
}

TEST(Uuv, SurveySmoothsTheTrackFromOneFix) {
  const TemporaryFolder folder;
  const Outcome run = Hindsight({"montecarlo", "uuv_survey", "--runs=2",
                                 "--path=lawnmower", "--out=survey"},
                                folder.path());
  ASSERT_EQ(run.status, 0) << run.err;
  const Json json = ReadJson(folder.path() / "survey" / "montecarlo.json");
  ASSERT_EQ(json["dives"].size(), 3u);
  for (const auto& [name, dive] : json["dives"].items()) {
    EXPECT_EQ(dive.size(), 4u) << name;
    EXPECT_EQ(dive["batch"]["failed"].get<int>(), 0) << name;
  }
  const auto rms = [&](const char* dive, const char* method) {
    return json["dives"][dive][method]["position_rms_m"].get<double>();
  };
  EXPECT_LT(rms("lawnmower, final fix", "batch"),
            0.5 * rms("lawnmower, final fix", "ekf"));

  const Outcome unknown = Hindsight(
      {"montecarlo", "uuv_survey", "--path=winding", "--out=x"}, folder.path());
  EXPECT_EQ(unknown.status, 2);
  EXPECT_NE(unknown.err.find("--path=winding"), std::string::npos);
}

/// The DVL is kept back for two minutes of a real dive that ends with a fix.
TEST(Uuv, SmootherBridgesAGapOfTheLogOnARealDive) {
  const std::filesystem::path source = HINDSIGHT_SOURCE_DIR;
  const std::filesystem::path root = source / "../shared/data";
  if (!std::filesystem::exists(root / "auv_dvl")) {
    GTEST_SKIP() << "the recording auv_dvl is not here";
  }
  for (const char* dive : {"auv_dvl_2_fix", "auv_dvl_5_fix"}) {
    const TemporaryFolder folder;
    const Outcome run = Hindsight(
        {"run", (source / "data" / dive).string() + ".yaml",
         "--data-root=" + root.string(), "--methods=ekf,rts,batch",
         "--withhold=dvl:every=400s,length=120s,from=150s", "--out=out"},
        folder.path());
    ASSERT_EQ(run.status, 0) << run.err;
    const Json methods =
        ReadJson(folder.path() / "out" / "summary.json")["methods"];
    const auto largest = [&](const char* method) {
      return methods[method]["error"]["horizontal_max_m"].get<double>();
    };
    // The truth itself is good for a metre or two.
    EXPECT_LT(largest("batch"), 2.0) << dive;
    EXPECT_LT(largest("batch"), largest("ekf")) << dive;
    EXPECT_LT(largest("rts"), largest("ekf")) << dive;
  }
}

}  // namespace
}  // namespace hindsight
