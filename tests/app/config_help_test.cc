#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/command_line.h"

namespace hindsight {
namespace {

Outcome Help(const std::vector<std::string>& words) {
  return Hindsight(words, std::filesystem::current_path());
}

TEST(ConfigHelp, ThePageOfTheDocumentationIsWhatTheProgramWrites) {
  const std::string text = ReadFile(
      std::filesystem::path(HINDSIGHT_SOURCE_DIR) / "docs/configuration.md");
  const Outcome outcome = Help({"help", "config", "--markdown"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, text);
}

TEST(FormatHelp, TheTableOfTheDocumentationIsWhatTheProgramWrites) {
  const std::string text =
      ReadFile(std::filesystem::path(HINDSIGHT_SOURCE_DIR) / "docs/formats.md");
  const Outcome outcome = Help({"help", "formats", "--markdown"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(text.find("\n\n" + outcome.out + "\n"), std::string::npos)
      << outcome.out;
  const Outcome plain = Help({"help", "formats"});
  EXPECT_NE(plain.out.find("nclt *  (imu, position, height"),
            std::string::npos);
  EXPECT_EQ(Help({"help", "formats", "nonsense"}).status, 2);
}

TEST(VehicleHelp, TheTableOfTheDocumentationIsWhatTheProgramWrites) {
  const std::string text =
      ReadFile(std::filesystem::path(HINDSIGHT_SOURCE_DIR) / "docs/running.md");
  const Outcome outcome = Help({"help", "vehicles", "--markdown"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(text.find("\n\n" + outcome.out + "\n"), std::string::npos)
      << outcome.out;
  EXPECT_NE(Help({"help", "vehicles"}).out.find("underwater"),
            std::string::npos);
  EXPECT_EQ(Help({"help", "vehicles", "nonsense"}).status, 2);
}

TEST(ConfigHelp, FindsAKindAMapAndAKey) {
  const Outcome kind = Help({"help", "config", "dvl"});
  EXPECT_NE(kind.out.find("beam_angle  (30 deg; with form: beams)"),
            std::string::npos);
  const Outcome map = Help({"help", "config", "stationary"});
  EXPECT_NE(map.out.find("gyro_threshold  (0.01 rad/s)"), std::string::npos);
  const Outcome key = Help({"help", "config", "lever_arm"});
  EXPECT_NE(key.out.find("aiding: odometer"), std::string::npos);
  EXPECT_EQ(key.out.find("level_on_average"), std::string::npos);
  const Outcome none = Help({"help", "config", "nonsense"});
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("nonsense"), std::string::npos);
}

TEST(ConfigHelp, TheSchemaKnowsEveryKind) {
  const auto schema =
      nlohmann::json::parse(Help({"help", "config", "--schema"}).out);
  std::vector<std::string> kinds;
  for (const auto& kind :
       schema["properties"]["aiding"]["additionalProperties"]["oneOf"]) {
    kinds.push_back(kind["properties"]["type"]["const"]);
    EXPECT_TRUE(kind["properties"].contains("gate")) << kinds.back();
  }
  EXPECT_NE(std::find(kinds.begin(), kinds.end(), "heading"), kinds.end());
  EXPECT_GE(kinds.size(), 12u);
  EXPECT_EQ(schema["properties"]["withhold"]["items"]["required"],
            (std::vector<std::string>{"sensor", "every", "length"}));
}

}  // namespace
}  // namespace hindsight
