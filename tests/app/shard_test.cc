#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/command_line.h"

namespace hindsight {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

const std::string kHeld =
    "--set=withhold=[{sensor: position, every: 70 s, length: 5 s, from: 30 s}, "
    "{sensor: position, every: 70 s, length: 25 s, from: 50 s}]";

std::vector<std::string> ShardWords(const std::string& out,
                                    const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {"montecarlo",
                                    "short_drive",
                                    "--runs=7",
                                    "--seed=5",
                                    "--methods=ekf,rts",
                                    kHeld,
                                    "--sweep=aiding.gnss.sigma=0.2,1 m",
                                    "--out=" + out};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class MonteCarloShards : public ::testing::Test {
 protected:
  Outcome Call(const std::vector<std::string>& words) {
    return Hindsight(words, folder_.path());
  }
  std::string Error(const std::vector<std::string>& words) {
    const Outcome outcome = Call(words);
    EXPECT_EQ(outcome.status, 2) << outcome.out;
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "bad"));
    return outcome.err;
  }
  std::string File(const std::string& name) const {
    return ReadFile(folder_.path() / name);
  }

  TemporaryFolder folder_;
};

TEST_F(MonteCarloShards, MergeToTheBytesOfOneProcess) {
  ASSERT_EQ(Call(ShardWords("one", {"--threads=2"})).status, 0);
  for (const auto& [number, threads] :
       {std::pair("2/3", "1"), std::pair("1/3", "2"), std::pair("3/3", "3")}) {
    const Outcome outcome = Call(ShardWords(
        std::string("s") + number[0], {std::string("--shard=") + number,
                                       std::string("--threads=") + threads}));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  EXPECT_THAT(Names(folder_.path() / "s2"),
              ElementsAre("manifest.json", "shard.cbor"));
  const Outcome merged =
      Call({"merge", "s3", "s1", "s2", "--out=merged", "--report"});
  ASSERT_EQ(merged.status, 0) << merged.err;
  for (const char* name : {"cells.csv", "curves.csv", "runs.csv",
                           "agreement.csv", "outages.csv"}) {
    if (!std::filesystem::exists(folder_.path() / "one" / name)) continue;
    EXPECT_EQ(File(std::string("merged/") + name),
              File(std::string("one/") + name))
        << name;
  }
  EXPECT_THAT(Lines(File("one/runs.csv")), SizeIs(1 + 7 * 2 * 2));
  EXPECT_THAT(File("merged/report.html"),
              AllOf(HasSubstr("aiding.gnss.sigma [m]"),
                    HasSubstr("Scatter and consistency by time")));

  EXPECT_THAT(Error({"merge", "s1", "s3", "--out=bad"}),
              AllOf(HasSubstr("shard 2/3 is missing: run hindsight montecarlo "
                              "short_drive "),
                    HasSubstr("--runs=7 --seed=5 --shard=2/3")));
  EXPECT_THAT(Error({"merge", "s1", "s2", "s3", "s1", "--out=bad"}),
              HasSubstr("shard 1 is there twice: s1 and s1"));
  ASSERT_EQ(Call(ShardWords("other", {"--shard=2/3", "--methods=ekf"})).status,
            0);
  EXPECT_THAT(Error({"merge", "s1", "other", "s3", "--out=bad"}),
              HasSubstr("are not of one comparison"));
  EXPECT_THAT(Error({"merge", "one", "--out=bad"}), HasSubstr("shard.cbor"));
  std::string bytes = File("s2/shard.cbor");
  WriteFile(folder_.path() / "s2/shard.cbor", bytes.substr(0, 1000));
  EXPECT_THAT(Error({"merge", "s1", "s2", "s3", "--out=bad"}),
              HasSubstr("s2/shard.cbor: damaged"));
  // Another build of the program: its hash stands in the file as hexadecimal.
  const std::string key = "ebuildx(";
  const std::size_t at = bytes.find(key);
  ASSERT_NE(at, bytes.npos);
  char& digit = bytes[at + key.size()];
  digit = digit == '0' ? '1' : '0';
  WriteFile(folder_.path() / "s2/shard.cbor", bytes);
  EXPECT_THAT(Error({"merge", "s1", "s2", "s3", "--out=bad"}),
              HasSubstr("s2 is of another build of the program"));
}

TEST_F(MonteCarloShards, AreAsTheFlagSays) {
  for (const char* shard :
       {"0/2", "3/2", "1", "1/2/3", "a/b", "1.5/2", "1/8"}) {
    EXPECT_THAT(Error(ShardWords("bad", {std::string("--shard=") + shard})),
                HasSubstr("--shard=" + std::string(shard) + ": expected I/N"));
  }
}

/// Against the same spans withheld: the same data reach the methods.
TEST_F(MonteCarloShards, AScenariosOwnOutagesCountAsWithheldOnesDo) {
  const auto outages = [&](const std::string& out,
                           const std::vector<std::string>& sets) {
    std::vector<std::string> words = {"montecarlo",    "short_drive",
                                      "--runs=2",      "--seed=5",
                                      "--methods=ekf", "--out=" + out};
    for (const std::string& set : sets) words.push_back("--set=" + set);
    const Outcome outcome = Call(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Lines(File(out + "/outages.csv"));
  };
  const auto silent = outages(
      "silent", {"aiding.gnss.outages=[{from: 39.5 s, to: 59.5 s}, "
                 "{from: 170 s, to: 190 s}]",
                 "aiding.gnss_velocity.outages=[{from: 39.5 s, to: 59.5 s}]"});
  const auto withheld = outages(
      "withheld", {"withhold=[{sensor: position, every: 400 s, length: 20 s, "
                   "from: 39.5 s}, {sensor: velocity, every: 400 s, "
                   "length: 20 s, from: 39.5 s}]"});
  // The one that the end of the recording cuts is none.
  ASSERT_THAT(silent, SizeIs(2));
  EXPECT_EQ(silent, withheld);
  EXPECT_THAT(silent[1], HasSubstr("20 s,gnss+gnss_velocity,ekf"));
}

TEST_F(MonteCarloShards, SweepsAndOutagesHaveTheirRows) {
  const Outcome outcome = Call(ShardWords("mc"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json json = nlohmann::json::parse(File("mc/montecarlo.json"));
  ASSERT_THAT(json["cells"], SizeIs(4));
  EXPECT_EQ(json["cells"][0]["aiding.gnss.sigma"], "0.2 m");
  EXPECT_EQ(json["cells"][2]["aiding.gnss.sigma"], "1 m");
  EXPECT_LT(json["cells"][1]["position_rms_m"],
            json["cells"][3]["position_rms_m"]);
  // Two lengths of outages, two sigmas, two methods.
  ASSERT_THAT(json["outages"], SizeIs(8));
  for (const nlohmann::json& row : json["outages"]) {
    EXPECT_THAT(row["sensor"].get<std::string>(), StartsWith("gnss"));
    EXPECT_LE(row["horizontal_p50_m"], row["horizontal_p68_m"]);
    EXPECT_LE(row["horizontal_p68_m"], row["horizontal_p95_m"]);
  }
  const auto worst = [&](const std::string& length, const std::string& method) {
    for (const nlohmann::json& row : json["outages"]) {
      if (row["outage"] == length && row["method"] == method &&
          row["aiding.gnss.sigma"] == "0.2 m") {
        return row["horizontal_p95_m"].get<double>();
      }
    }
    return -1.0;
  };
  EXPECT_GT(worst("25 s", "ekf"), worst("5 s", "ekf"));
  EXPECT_GT(worst("25 s", "ekf"), worst("25 s", "rts"));
  EXPECT_GT(worst("5 s", "rts"), 0.0);
  for (const auto& [sweep, expected] :
       {std::pair("aiding.gnss.sigma", "expected KEY=V1,V2,... UNIT"),
        std::pair("aiding.gnss.sigma=1 m", "expected V1,V2,... UNIT"),
        std::pair("aiding.gnss.sigma=1,x m", "'x m' is no number"),
        std::pair("aiding.gnss.sigma=1,2 s", "expected a length")}) {
    EXPECT_THAT(Error({"montecarlo", "short_drive", "--out=bad",
                       std::string("--sweep=") + sweep}),
                HasSubstr(expected));
  }
}

}  // namespace
}  // namespace hindsight
