#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command_line.h"
#include "support/recordings.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

/// A recording as it came, and a configuration that somebody wrote for it.
struct AsItCame {
  const char* configuration;  ///< of data/
  const char* folder;
  /// Without a truth: measurements kept back, which judge.
  const char* withhold = "";
  /// What the data do not show, where the folder alone does not do: words of the
  /// log.
  const char* fact = "";
  /// Judged without HINDSIGHT_ALL_RECORDINGS in the environment.
  bool quick = false;
};

void PrintTo(const AsItCame& recording, std::ostream* out) {
  *out << recording.configuration;
}

class FromFolder : public ::testing::TestWithParam<AsItCame> {
 protected:
  std::string Root() const { return testing::RecordingsFolder().string(); }
  std::string Configuration() const {
    return std::string(HINDSIGHT_SOURCE_DIR) + "/data/" +
           GetParam().configuration + ".yaml";
  }
  bool Judged() const { return *GetParam().withhold != '\0'; }

  Outcome Run(const std::string& what, const std::string& out,
              std::vector<std::string> flags = {}) const {
    flags.insert(flags.begin(), {"run", what, "--out=" + out, "--methods=rts"});
    if (Judged()) {
      flags.push_back(std::string("--withhold=") + GetParam().withhold);
    }
    return Hindsight(flags, folder_.path());
  }

  /// The root mean square of the positions in the outages, or against the truth
  /// of the configuration by hand [m].
  double Error(const std::string& out) const {
    if (Judged()) {
      const auto summary = nlohmann::json::parse(
          ReadFile(folder_.path() / out / "summary.json"));
      return summary["methods"]["rts"]["withheld"]["total_rms_m"];
    }
    const Outcome outcome =
        Hindsight({"evaluate", out + "/rts.csv", Configuration(), "--json",
                   "--data-root=" + Root()},
                  folder_.path());
    return nlohmann::json::parse(
        outcome.out)["errors"]["position_total"]["rms"];
  }
  std::string LastLine(const Outcome& outcome) const {
    const std::vector<std::string> lines = Lines(outcome.out + outcome.err);
    return lines.empty() ? "" : lines.back();
  }
  TemporaryFolder folder_;
};

/// What a folder alone gives is within 1.5 times the error of a configuration by
/// hand, or it says that something is wrong, whoever confirms its assumptions.
TEST_P(FromFolder, IsAsGoodAsByHandOrSaysSo) {
  const std::filesystem::path data = Root() + "/" + GetParam().folder;
  if (!GetParam().quick && std::getenv("HINDSIGHT_ALL_RECORDINGS") == nullptr) {
    GTEST_SKIP() << "set HINDSIGHT_ALL_RECORDINGS=1 to judge it, in minutes";
  }
  if (!std::filesystem::exists(data)) {
    GTEST_SKIP() << "the recording " << GetParam().folder << " is not here";
  }
  ASSERT_EQ(Hindsight({"init", data.string(), "--out=own.yaml"}, folder_.path())
                .status,
            0);
  const Outcome confirmed = Run("own.yaml", "own", {"--yes"});
  ASSERT_NE(confirmed.status, 2) << confirmed.err;
  const Outcome by_hand =
      Run(Configuration(), "hand", {"--data-root=" + Root()});
  ASSERT_NE(by_hand.status, 2) << by_hand.err;
  const double hand = Error("hand");
  const double own = std::filesystem::exists(folder_.path() / "own/rts.csv")
                         ? Error("own")
                         : -1.0;
  std::cout << fmt::format("{}: by hand {:.3g}, from the folder {:.3g}: {}\n",
                           GetParam().configuration, hand, own,
                           LastLine(confirmed));
  if (confirmed.status == 0) {
    EXPECT_EQ(confirmed.out.find("not credible against the truth"),
              std::string::npos)
        << confirmed.out;
  }
  constexpr double kAsGood = 1.5;
  if (own >= 0.0 && own <= kAsGood * hand) return;
  EXPECT_NE(confirmed.status, 0) << LastLine(confirmed);
  ASSERT_STRNE(GetParam().fact, "") << "expected as good as by hand";
  EXPECT_THAT(ReadFile(folder_.path() / "own.yaml") + confirmed.out,
              HasSubstr(GetParam().fact));
}

constexpr char kMirrored[] = "its y axis is mirrored";

INSTANTIATE_TEST_SUITE_P(
    All, FromFolder,
    ::testing::Values(
        AsItCame{"car_odometer", "car_odometer"},
        AsItCame{"car_ublox_1", "car_ublox/urban-long-turn-loop-nominal-001"},
        AsItCame{"car_ublox_2",
                 "car_ublox/urban-stop-go-tight-turns-nominal-001"},
        AsItCame{"auv_dvl_2", "auv_dvl/2", "", kMirrored},
        AsItCame{"auv_dvl_4", "auv_dvl/4", "", kMirrored},
        AsItCame{"auv_dvl_5", "auv_dvl/5", "", kMirrored},
        AsItCame{"auv_dvl_12", "auv_dvl/12", "", kMirrored},
        AsItCame{"foot_zupt", "foot_zupt", "",
                 "no stream tells the position or the heading"},
        AsItCame{"car_rtk", "car_rtk",
                 "position:every=60s,length=15s,from=90s"},
        AsItCame{"walk_rtk", "walk_rtk",
                 "position:every=20s,length=5s,from=10s", "", true}),
    [](const auto& info) { return std::string(info.param.configuration); });

}  // namespace
}  // namespace hindsight
