#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/command_line.h"
#include "support/recordings.h"

namespace hindsight {
namespace {

using Json = nlohmann::json;

Json ReadJson(const std::filesystem::path& path) {
  return Json::parse(ReadFile(path));
}

/// The row of a case and method, the values of its first two columns.
Json Cell(const Json& json, const std::string& name,
          const std::string& method) {
  for (const Json& row : json["cells"]) {
    const auto is = [&row](const std::string& text) {
      return std::any_of(row.begin(), row.end(),
                         [&](const Json& value) { return value == text; });
    };
    if (is(name) && is(method)) return row;
  }
  return Json();
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

TEST(Uuv, FusionsOfThePaperPrintEveryReading) {
  const TemporaryFolder folder;
  const Outcome run = Hindsight(
      {"montecarlo", "uuv_search", "--runs=2", "--out=search"}, folder.path());
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("sum,diagonal,white,alike"), std::string::npos);
  const Json json = ReadJson(folder.path() / "search" / "montecarlo.json");
  // Readings and two matched truths by five architectures.
  EXPECT_EQ(json["cells"].size(), 5u * (16u + 2u));
  const std::string equal = "sum,diagonal,white,alike";
  EXPECT_GT(Cell(json, equal, "central")["spatial_mean_m"].get<double>(), 1.0);
  EXPECT_LT(Cell(json, equal, "equalised")["spatial_mean_m"].get<double>(),
            0.1);
  EXPECT_LT(Cell(json, equal, "central")["horizontal_mean_m"],
            Cell(json, equal, "central")["spatial_mean_m"]);
  EXPECT_GT(Cell(json, "matched: two sensors of 9.8 m", "equalised")["nees"]
                .get<double>(),
            2.0);
}

TEST(Uuv, CalibrationJudgesTheConstantsOfTheLog) {
  const TemporaryFolder folder;
  const Outcome run =
      Hindsight({"montecarlo", "uuv_calibration", "--runs=4", "--out=out"},
                folder.path());
  ASSERT_EQ(run.status, 0) << run.err;
  const Json json = ReadJson(folder.path() / "out" / "montecarlo.json");
  const auto constant = [&](const char* name) {
    for (const Json& row : json["constants"]) {
      if (row["method"] == "batch" && row["constant"] == name) return row;
    }
    return Json();
  };
  for (const char* name :
       {"dvl_scale", "dvl_mounting[z]", "dvl_lever_arm[x]"}) {
    EXPECT_EQ(constant(name)["observed"], 4) << name;
    EXPECT_LT(constant(name)["sigma"].get<double>(),
              0.1 * constant(name)["prior_sigma"].get<double>())
        << name;
  }
  // The eights are level: nothing tells how deep the transducer sits.
  EXPECT_EQ(constant("dvl_lever_arm[z]")["unobserved"], 4);
}

TEST(Uuv, SurveySmoothsTheTrackFromOneFix) {
  const TemporaryFolder folder;
  const Outcome run = Hindsight({"montecarlo", "uuv_survey", "--runs=2",
                                 "--set=path=lawnmower", "--out=survey"},
                                folder.path());
  ASSERT_EQ(run.status, 0) << run.err;
  const Json json = ReadJson(folder.path() / "survey" / "montecarlo.json");
  ASSERT_EQ(json["cells"].size(), 3u * 4u);
  for (const Json& cell : json["cells"]) {
    if (cell["method"] != "batch") continue;
    EXPECT_EQ(cell["failed"], 0) << cell;
  }
  const auto rms = [&](const char* method) {
    return Cell(json, "final fix", method)["position_rms_m"].get<double>();
  };
  EXPECT_LT(rms("batch"), 0.5 * rms("ekf"));

  const Outcome unknown =
      Hindsight({"montecarlo", "uuv_survey", "--set=path=winding", "--out=x"},
                folder.path());
  EXPECT_EQ(unknown.status, 2);
  EXPECT_NE(unknown.err.find("path: 'winding'"), std::string::npos);
}

/// The DVL is kept back for two minutes of a real dive that ends with a fix.
TEST(Uuv, SmootherBridgesAGapOfTheLogOnARealDive) {
  const std::filesystem::path source = HINDSIGHT_SOURCE_DIR;
  const std::filesystem::path root = testing::RecordingsFolder();
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

/// A straight dive tells neither scale nor mounting of its log; two others do.
TEST(Uuv, ConstantsOfTwoDivesServeAStraightOne) {
  const std::filesystem::path source = HINDSIGHT_SOURCE_DIR;
  const std::filesystem::path root = testing::RecordingsFolder();
  if (!std::filesystem::exists(root / "auv_dvl")) {
    GTEST_SKIP() << "the recording auv_dvl is not here";
  }
  const TemporaryFolder folder;
  const auto run = [&](const std::string& dive, const std::string& methods,
                       std::vector<std::string> more) {
    more.insert(more.begin(),
                {"run", (source / "data" / dive).string() + ".yaml",
                 "--data-root=" + root.string(), "--methods=" + methods,
                 "--out=" + dive});
    const Outcome outcome = Hindsight(more, folder.path());
    EXPECT_TRUE(HasResults(outcome)) << outcome.err;
    return ReadJson(folder.path() / dive / "summary.json")["methods"];
  };
  run("auv_dvl_2", "batch", {});
  run("auv_dvl_5", "batch", {});
  // Rows are counted: the delay of the log's first is another in each.
  const Outcome combined = Hindsight(
      {"combine", "auv_dvl_2", "auv_dvl_5", "--out=both"}, folder.path());
  EXPECT_EQ(combined.status, 0) << combined.out << combined.err;
  EXPECT_NE(combined.out.find("recording has its own: dvl_time_offset"),
            std::string::npos)
      << combined.out;
  const Json dive = run("auv_dvl_12", "rts,batch", {"--constants=both"});
  for (const char* method : {"rts", "batch"}) {
    EXPECT_LT(dive[method]["error"]["end_horizontal_m"].get<double>(), 1.6)
        << method;
    EXPECT_LT(dive[method]["nees"]["position"].get<double>(), 16.3) << method;
  }
}

}  // namespace
}  // namespace hindsight
