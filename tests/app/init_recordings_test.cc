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
  const char* folder;         ///< or file
  /// Without a truth: measurements kept back, which judge.
  const char* withhold = "";
  /// What the data do not show, where the folder alone does not do: words of the
  /// log.
  const char* fact = "";
  /// Judged without HINDSIGHT_ALL_RECORDINGS in the environment.
  bool quick = false;
  /// Without positions: judged by the rotation to the truth's attitudes.
  bool held = false;
};

AsItCame Held(const char* configuration, const char* file) {
  return {configuration, file, "", "", false, true};
}

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
  std::string Method() const {
    return GetParam().held ? "ahrs_smoother" : "rts";
  }
  std::string ResultOf(const std::string& out) const {
    return out + "/" + Method() + ".csv";
  }

  /// The recording by itself, where a folder holds many.
  std::filesystem::path Alone() const {
    const std::filesystem::path data = Root() + "/" + GetParam().folder;
    if (std::filesystem::is_directory(data)) return data;
    const std::filesystem::path alone = folder_.path() / "alone";
    std::filesystem::create_directory(alone);
    std::filesystem::create_symlink(data, alone / data.filename());
    return alone;
  }

  Outcome Run(const std::string& what, const std::string& out,
              std::vector<std::string> flags = {}) const {
    flags.insert(flags.begin(),
                 {"run", what, "--out=" + out, "--methods=" + Method()});
    if (Judged()) {
      flags.push_back(std::string("--withhold=") + GetParam().withhold);
    }
    return Hindsight(flags, folder_.path());
  }

  /// The root mean square of the positions in the outages, or against the truth
  /// of the configuration by hand [m], or of the rotation to its attitudes [deg].
  double Error(const std::string& out) const {
    if (Judged()) {
      const auto summary = nlohmann::json::parse(
          ReadFile(folder_.path() / out / "summary.json"));
      return summary["methods"]["rts"]["withheld"]["total_rms_m"];
    }
    const Outcome outcome =
        Hindsight({"evaluate", ResultOf(out), Configuration(), "--json",
                   "--data-root=" + Root()},
                  folder_.path());
    return nlohmann::json::parse(outcome.out)["errors"][figure()]["rms"];
  }
  /// The configuration by hand; of a sensor in the hand with the clock that its own
  /// recording tells, without what only a reference does.
  std::string ByHand() const {
    if (!GetParam().held) return Configuration();
    std::string text = ReadFile(Configuration());
    for (const auto& [calibrated, told] :
         {std::pair("time_offset: -3.9 ms", "time_offset: -1.75 ms"),
          std::pair("time_offset: -14.9 ms", "time_offset: -12.75 ms")}) {
      const std::size_t at = text.find(calibrated);
      EXPECT_NE(at, std::string::npos) << calibrated;
      if (at != std::string::npos) {
        text.replace(at, std::string(calibrated).size(), told);
      }
    }
    WriteFile(folder_.path() / "by_hand.yaml", text);
    return (folder_.path() / "by_hand.yaml").string();
  }
  const char* figure() const {
    return GetParam().held ? "rotation" : "position_total";
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
  ASSERT_EQ(
      Hindsight({"init", Alone().string(), "--out=own.yaml"}, folder_.path())
          .status,
      0);
  const Outcome confirmed = Run("own.yaml", "own", {"--yes"});
  ASSERT_NE(confirmed.status, 2) << confirmed.err;
  const Outcome by_hand = Run(ByHand(), "hand", {"--data-root=" + Root()});
  ASSERT_NE(by_hand.status, 2) << by_hand.err;
  const double hand = Error("hand");
  const double own = std::filesystem::exists(folder_.path() / ResultOf("own"))
                         ? Error("own")
                         : -1.0;
  std::cout << fmt::format(
      "| {} | {:.3g} {} | {:.3g} | {} |\n", GetParam().configuration, hand,
      GetParam().held ? "deg" : "m", own, LastLine(confirmed));
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

/// Positions in local axes beside attitudes, in a file that is called the truth, are
/// taken for nothing else: attitude is left, of which a flight without a compass does
/// not show the heading.
TEST(FromFolderOfAttitudes, AreDoubtful) {
  const std::string data =
      (testing::RecordingsFolder() / "drone_paths/path_5").string();
  if (!std::filesystem::exists(data)) {
    GTEST_SKIP() << "the recording drone_paths is not here";
  }
  const TemporaryFolder folder;
  const Outcome outcome =
      Hindsight({"run", data, "--out=own", "--yes"}, folder.path());
  EXPECT_EQ(outcome.status, 3) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("apart in attitude"));
  EXPECT_THAT(ReadFile(folder.path() / "own.yaml"),
              HasSubstr("time_offset: unknown"));
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
                 "position:every=20s,length=5s,from=10s", "", true},
        AsItCame{"car_wheel_imu", "car_wheel_imu",
                 "position:every=40s,length=10s,from=20s"},
        AsItCame{"drone_quad", "drone_quad",
                 "position:every=60s,length=10s,from=30s"},
        Held("broad_01", "ahrs_broad/01_undisturbed_slow_rotation_A.mat"),
        Held("broad_02", "ahrs_broad/02_undisturbed_slow_rotation_B.mat"),
        Held("broad_07", "ahrs_broad/07_undisturbed_fast_rotation_B.mat"),
        Held("broad_08",
             "ahrs_broad/08_undisturbed_fast_rotation_with_breaks_A.mat"),
        Held("broad_12", "ahrs_broad/12_undisturbed_slow_translation_C.mat"),
        Held("broad_16", "ahrs_broad/16_undisturbed_fast_translation_B.mat"),
        Held("broad_24", "ahrs_broad/24_disturbed_tapping_A.mat"),
        Held("broad_26", "ahrs_broad/26_disturbed_phone_vibration_A.mat"),
        Held("broad_28", "ahrs_broad/28_disturbed_stationary_magnet_A.mat"),
        Held("broad_30", "ahrs_broad/30_disturbed_stationary_magnet_C.mat"),
        Held("broad_33", "ahrs_broad/33_disturbed_attached_magnet_2cm.mat"),
        Held("broad_35", "ahrs_broad/35_disturbed_attached_magnet_4cm.mat")),
    [](const auto& info) { return std::string(info.param.configuration); });

}  // namespace
}  // namespace hindsight
