#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "app/command_line.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

/// Which scenarios heed a flag, and a value that none accepts.
struct Use {
  std::set<std::string> scenarios;
  std::string bad;
};

const std::map<std::string, Use>& Uses() {
  static const std::set<std::string> observers = {"in_flight_alignment"};
  static const std::set<std::string> scenarios = {
      "tunnel_survey",       "calibration",
      "in_flight_alignment", "velocity_alignment",
      "gps_jumps",           "uuv_survey",
      "uuv_calibration",     "scenarios that are no comparison"};
  static const std::map<std::string, Use> uses = {
      {"set", {scenarios, "=nothing"}},
      {"sweep", {scenarios, "=nothing"}},
      {"methods",
       {{"scenarios that are no comparison", "grades", "in_flight_alignment"},
        "=none"}},
      {"error", {observers, "=small"}},
      {"gamma", {observers, "=wide"}},
      {"alpha", {observers, "=-1"}},
      {"alpha-blocks", {observers, "=some"}},
      {"delta", {observers, "=1e300"}},
      {"bounded", {observers, "=height"}},
      {"back-off", {observers, ""}},
      {"faults", {{"grades"}, "="}}};
  return uses;
}

const std::set<std::string> kOfAll = {"out",      "force",   "clean", "runs",
                                      "seed",     "threads", "log",   "help",
                                      "progress", "quiet",   "shard", "report"};

class MonteCarloFlags : public ::testing::Test {
 protected:
  Outcome Run(const std::vector<std::string>& words) {
    std::vector<std::string> all = {"montecarlo"};
    all.insert(all.end(), words.begin(), words.end());
    return Hindsight(all, folder_.path());
  }

  /// Ends with 2, one line and no results.
  std::string Refusal(const std::vector<std::string>& words) {
    const Outcome outcome = Run(words);
    EXPECT_EQ(outcome.status, 2) << ::testing::PrintToString(words);
    EXPECT_THAT(Lines(outcome.err), SizeIs(1)) << outcome.err;
    EXPECT_THAT(outcome.out, IsEmpty());
    EXPECT_THAT(Names(folder_.path()), IsEmpty());
    return outcome.err;
  }

  /// As the program itself lists them.
  std::vector<std::string> Scenarios() {
    std::string text = Lines(Run({"none", "--out=mc"}).err).at(0);
    text.erase(0, text.find("there is ") + 9);
    std::vector<std::string> names;
    for (std::size_t end = 0; end != std::string::npos;) {
      end = text.find(", ");
      names.push_back(text.substr(0, end));
      text.erase(0, end == std::string::npos ? end : end + 2);
    }
    return names;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(MonteCarloFlags, EveryFlagIsInTheTableOfThisTest) {
  std::size_t found = 0;
  for (const std::string& line : Lines(Run({"--help"}).out)) {
    if (!line.starts_with("  --")) continue;
    const std::string name = line.substr(4, line.find_first_of(" =", 4) - 4);
    EXPECT_TRUE(Uses().contains(name) || kOfAll.contains(name)) << name;
    ++found;
  }
  EXPECT_EQ(found, Uses().size() + kOfAll.size());
}

TEST_F(MonteCarloFlags,
       ThatMeanNothingToAScenarioAreRefusedWhateverTheirValue) {
  const std::vector<std::string> scenarios = Scenarios();
  ASSERT_THAT(scenarios, SizeIs(11));
  for (const std::string& scenario : scenarios) {
    for (const auto& [flag, use] : Uses()) {
      const bool heeded = use.scenarios.contains(scenario);
      // A switch that is heeded has no bad value.
      if (heeded && use.bad.empty()) continue;
      const std::string error =
          Refusal({scenario, "--out=mc", "--" + flag + use.bad});
      EXPECT_THAT(error, HasSubstr("--" + flag));
      const std::string nothing =
          "--" + flag + " means nothing to " + scenario + "; it goes with ";
      if (heeded) {
        EXPECT_THAT(error, Not(HasSubstr("means nothing")));
        continue;
      }
      EXPECT_THAT(error, HasSubstr(nothing));
      for (const std::string& other : use.scenarios) {
        EXPECT_THAT(error, HasSubstr(other));
      }
    }
  }
}

TEST_F(MonteCarloFlags, HelpNamesTheScenariosOfEveryFlag) {
  const std::string page = Run({"--help"}).out;
  for (const auto& [flag, use] : Uses()) {
    const std::size_t begin =
        page.find("\n  --" + flag + (use.bad.empty() ? " " : "="));
    ASSERT_NE(begin, std::string::npos) << flag;
    const std::string entry =
        page.substr(begin, page.find("\n  --", begin + 1) - begin);
    for (const std::string& scenario : use.scenarios) {
      EXPECT_THAT(entry, HasSubstr(scenario)) << flag;
    }
  }
}

TEST_F(MonteCarloFlags, SillyValuesAreRefused) {
  const std::vector<std::vector<std::string>> cases = {
      {"velocity_alignment", "--set=aiding.velocity.rate=1 Hz|1 Hz",
       "stands there twice"},
      {"velocity_alignment", "--set=aiding.velocity.rate=1e400 Hz", "1e400"},
      {"velocity_alignment", "--set=aiding.velocity.rate=1 Hz||10 Hz",
       "a value is missing"},
      {"velocity_alignment",
       "--set=aiding.velocity.rate=", "a value is missing"},
      {"velocity_alignment", "--set=aiding.velocity.rat=1 Hz", "rat"},
      {"velocity_alignment", "--seed=18446744073709551615",
       "the last of 100 seeds"},
      {"velocity_alignment", "--seed=18446744073709551616", "out of range"},
      {"in_flight_alignment", "--seed=18446744073709551500",
       "the last of 300 seeds"},
      {"in_flight_alignment", "--set=start_errors.tilt=200 deg",
       "at most 180 deg"},
      {"in_flight_alignment", "--methods=ekf,ekf", "twice"},
      {"in_flight_alignment", "--methods=", "expected some of ekf"},
      {"in_flight_alignment", "--error=quaternion,quaternion", "twice"},
      {"in_flight_alignment", "--gamma=5,5", "twice"},
      {"in_flight_alignment", "--gamma=1e400", "out of range"},
      {"in_flight_alignment", "--gamma=1e-200", "1e-06 to 1e+09 sqrt(s)"},
      {"in_flight_alignment", "--delta=-1e308", "-1e+12 to 1e+12 1/s"},
      {"in_flight_alignment", "--delta=1e400", "out of range"},
      {"in_flight_alignment", "--alpha=1e6", "0 to 100 1/s"},
      {"in_flight_alignment", "--bounded=attitude=1e-300rad", "1e-09"},
      {"in_flight_alignment", "--bounded=attitude,attitude=2rad", "once"},
      {"gps_jumps", "--set=errors=steps|steps", "twice"},
      {"gps_jumps", "--set=errors=many",
       "expected one of pulses, none, spikes, steps, ramp, multipath"},
      {"gps_jumps", "--set=aiding.gnss.sigma=0 m", "must be greater than zero"},
      {"gps_jumps", "--set=aiding.gnss.sigma=1 Hz", "expected a length"}};
  for (const std::vector<std::string>& row : cases) {
    EXPECT_THAT(Refusal({row[0], "--out=mc", row[1]}), HasSubstr(row[2]));
  }
}

}  // namespace
}  // namespace hindsight
