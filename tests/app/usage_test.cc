#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/command_line.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

const std::vector<std::string> kCommands = {
    "check", "run", "evaluate", "simulate", "init", "report", "combine"};

class Usage : public ::testing::Test {
 protected:
  Outcome Run(const std::vector<std::string>& words) {
    return Hindsight(words, folder_.path());
  }
  TemporaryFolder folder_;
};

TEST_F(Usage, GeneralHelpListsEveryCommandAndExitsZero) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{}, {"--help"}, {"-h"}, {"help"}}) {
    const Outcome outcome = Run(words);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.err, IsEmpty());
    for (const std::string& command : kCommands) {
      EXPECT_THAT(outcome.out, HasSubstr("\n  " + command + " "));
    }
  }
}

TEST_F(Usage, EveryCommandHasAPageOfHelp) {
  for (const std::string& command : kCommands) {
    const Outcome outcome = Run({command, "--help"});
    EXPECT_EQ(outcome.status, 0) << command;
    EXPECT_THAT(outcome.err, IsEmpty());
    EXPECT_THAT(outcome.out, StartsWith("Usage: hindsight " + command + " "));
    EXPECT_EQ(Run({"help", command}).out, outcome.out);
  }
}

TEST_F(Usage, HelpNamesEveryFlagOfRun) {
  const std::string page = Run({"run", "--help"}).out;
  for (const std::string flag :
       {"methods", "out", "force", "from", "to", "rate", "at", "point",
        "withhold", "without", "constants", "export", "report", "progress",
        "data-root", "log", "help"}) {
    EXPECT_THAT(page, HasSubstr("\n  --" + flag)) << flag;
  }
}

TEST_F(Usage, VersionIsOneLine) {
  const Outcome outcome = Run({"--version"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(Lines(outcome.out), SizeIs(1));
  EXPECT_THAT(outcome.out, StartsWith("hindsight "));
}

struct BadUsage {
  std::string name;
  std::vector<std::string> words;
  std::vector<std::string> expected;  ///< parts of the one line on stderr
};

void PrintTo(const BadUsage& row, std::ostream* out) { *out << row.name; }

class WrongUsage : public ::testing::TestWithParam<BadUsage> {};

TEST_P(WrongUsage, EndsWithTwoAndOneLineThatSaysWhy) {
  const TemporaryFolder folder;
  const Outcome outcome = Hindsight(GetParam().words, folder.path());
  EXPECT_EQ(outcome.status, 2);
  ASSERT_THAT(Lines(outcome.err), SizeIs(1)) << outcome.err;
  EXPECT_THAT(outcome.err, StartsWith("hindsight: error: "));
  for (const std::string& part : GetParam().expected) {
    EXPECT_THAT(outcome.err, HasSubstr(part));
  }
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(Names(folder.path()), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    Table, WrongUsage,
    ::testing::Values(
        BadUsage{"UnknownCommand", {"rum"}, {"'rum'", "did you mean run?"}},
        BadUsage{"UnknownFlag",
                 {"run", "c.yaml", "--metods=ekf"},
                 {"--metods", "'run'", "did you mean --methods?"}},
        BadUsage{"FlagOfAnotherCommand",
                 {"check", "c.yaml", "--methods=ekf"},
                 {"--methods", "'check'"}},
        BadUsage{"NoValue", {"run", "c.yaml", "--out"}, {"--out", "value"}},
        BadUsage{"NotANumber",
                 {"run", "c.yaml", "--out=o", "--rate=fast"},
                 {"--rate=fast", "number"}},
        BadUsage{"ZeroRate",
                 {"run", "c.yaml", "--out=o", "--rate=0"},
                 {"--rate", "positive"}},
        BadUsage{"NegativeSeed",
                 {"simulate", "short_drive", "--out=o", "--seed=-1"},
                 {"--seed=-1", "0 or more"}},
        BadUsage{"NoConfiguration", {"run", "--out=o"}, {"run", "CONFIG"}},
        BadUsage{"TooManyArguments",
                 {"check", "a.yaml", "b.yaml"},
                 {"'b.yaml'", "CONFIG"}},
        BadUsage{"NoOutputFolder", {"run", "c.yaml"}, {"--out"}},
        BadUsage{"UnknownMethod",
                 {"run", "c.yaml", "--out=o", "--methods=ekf,magic"},
                 {"--methods", "magic", "batch"}},
        BadUsage{"UnknownExport",
                 {"run", "c.yaml", "--out=o", "--export=gpx2"},
                 {"--export", "gpx2", "kml"}},
        BadUsage{"UnknownProgress",
                 {"run", "c.yaml", "--out=o", "--progress=loud"},
                 {"--progress", "loud", "json"}},
        BadUsage{"UnknownLogLevel",
                 {"check", "c.yaml", "--log=all"},
                 {"--log", "all", "warning"}},
        BadUsage{"FromAfterTo",
                 {"run", "c.yaml", "--out=o", "--from=9", "--to=3"},
                 {"--from", "--to"}},
        BadUsage{"PointOfTwo",
                 {"run", "c.yaml", "--out=o", "--point=1,2"},
                 {"--point", "x,y,z"}},
        BadUsage{"WithholdNoSensor",
                 {"run", "c.yaml", "--out=o", "--withhold=every=9s"},
                 {"--withhold", "sensor"}},
        BadUsage{"WithholdNoUnit",
                 {"run", "c.yaml", "--out=o",
                  "--withhold=position:every=120,length=30s"},
                 {"--withhold", "'every=120'", "unit"}},
        BadUsage{"WithholdUnknownKey",
                 {"run", "c.yaml", "--out=o",
                  "--withhold=position:each=120s,length=30s"},
                 {"--withhold", "'each'"}},
        BadUsage{"WithholdNoLength",
                 {"run", "c.yaml", "--out=o", "--withhold=position:every=120s"},
                 {"--withhold", "length"}}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace hindsight
