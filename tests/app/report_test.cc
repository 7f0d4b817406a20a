#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>

#include "app/recording.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

class ReportCommandTest : public ::testing::Test {
 protected:
  fs::path Out(const std::string& name) const {
    return recording_.root() / "out" / name;
  }
  Outcome Report(std::vector<std::string> words) const {
    words.insert(words.begin(), "report");
    return Hindsight(words, recording_.root());
  }
  std::vector<std::string> Listed() const {
    return nlohmann::json::parse(ReadFile(Out("manifest.json")))["files"];
  }
  void RunInto(const std::string& out,
               const std::vector<std::string>& more = {}) const {
    std::vector<std::string> flags = {"--out=" + out, "--methods=ekf,batch"};
    flags.insert(flags.end(), more.begin(), more.end());
    ASSERT_EQ(recording_.Run(flags).status, 0);
  }
  Recording recording_;
};

TEST_F(ReportCommandTest, RunAndCommandMakeTheSamePage) {
  RunInto("out", {"--report"});
  const std::string page = ReadFile(Out("report.html"));
  EXPECT_THAT(Listed(), Contains("report.html"));
  const Outcome outcome = Report({"out"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "report in out/report.html\n");
  EXPECT_TRUE(ReadFile(Out("report.html")) == page);
  // Nothing hinders a new run in its place.
  RunInto("out", {"--force"});
  EXPECT_THAT(Names(recording_.root() / "out"), Not(Contains("report.html")));
}

TEST_F(ReportCommandTest, ThePageHasEveryPanelAndNeedsNoOtherFile) {
  RunInto("out", {"--withhold=gnss:every=20s,length=5s"});
  ASSERT_EQ(Report({"out"}).status, 0);
  const std::string page = ReadFile(Out("report.html"));
  for (const char* panel :
       {"verdict", "timeline", "map", "accuracy", "separation", "residuals",
        "outages", "receiver", "biases", "motion", "differences", "truth",
        "modes", "constants", "config"}) {
    EXPECT_THAT(page, HasSubstr(std::string("<section id=\"") + panel + "\">"));
  }
  const std::regex reference("(src|href)=\"(?!#|data:)");
  EXPECT_FALSE(std::regex_search(page, reference));
  EXPECT_THAT(page, Not(HasSubstr("sourceMappingURL")));
  // No filter that separates ran, and no method with modes.
  EXPECT_THAT(page, HasSubstr("No method ran that separates"));
  EXPECT_THAT(page, HasSubstr("No method with modes ran"));
}

TEST_F(ReportCommandTest, NamesFromFilesAreText) {
  RunInto("out");
  const std::string hostile = "</script><b>";
  for (const char* file : {"residuals.csv", "summary.json"}) {
    std::string text = ReadFile(Out(file));
    text = std::regex_replace(text, std::regex(",gnss,|\"gnss\""),
                              std::string(file) == "residuals.csv"
                                  ? "," + hostile + ","
                                  : "\"" + hostile + "\"");
    WriteFile(Out(file), text);
  }
  ASSERT_EQ(Report({"out"}).status, 0);
  const std::string page = ReadFile(Out("report.html"));
  EXPECT_THAT(page, Not(HasSubstr(hostile)));
  EXPECT_THAT(page, HasSubstr("&lt;/script&gt;&lt;b&gt;"));
}

TEST_F(ReportCommandTest, SeveralFoldersStandSideBySide) {
  RunInto("out");
  RunInto("other", {"--to=40"});
  ASSERT_EQ(Report({"out", "other", "--out=both.html"}).status, 0);
  const std::string page = ReadFile(recording_.root() / "both.html");
  EXPECT_THAT(page, HasSubstr("Side by side, the first as reference"));
  EXPECT_THAT(page, HasSubstr("other: batch"));
  EXPECT_FALSE(fs::exists(Out("report.html")));
  // A file in the way stays.
  const Outcome again = Report({"out", "--out=both.html"});
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.err, HasSubstr("--force"));
  EXPECT_EQ(Report({"out", "--out=both.html", "--force"}).status, 0);
}

TEST_F(ReportCommandTest, AFolderWithoutResultsIsOneLineAndStatusTwo) {
  RunInto("out");
  fs::create_directory(recording_.root() / "empty");
  const auto expect_refused = [&](const std::vector<std::string>& words,
                                  const std::string& why) {
    const Outcome outcome = Report(words);
    EXPECT_EQ(outcome.status, 2);
    ASSERT_THAT(Lines(outcome.err), SizeIs(1));
    EXPECT_THAT(outcome.err, HasSubstr(why));
    EXPECT_EQ(outcome.out, "");
  };
  expect_refused({"empty"}, "no results of 'hindsight run'");
  expect_refused({"data"}, "no results of 'hindsight run'");
  expect_refused({"nowhere"}, "no such folder");
  expect_refused({"out", "empty"}, "empty: no results");
  expect_refused({}, "needs 1 argument");
  WriteFile(Out("report.html"), "mine");
  expect_refused({"out"}, "not listed in manifest.json");
  EXPECT_EQ(ReadFile(Out("report.html")), "mine");
  fs::remove(Out("report.html"));
  WriteFile(Out("summary.json"), "{\"methods\": 3}");
  expect_refused({"out"}, "summary.json");
  WriteFile(Out("summary.json"),
            R"({"methods": {"batch": {"withheld": 3}}, "best": "batch"})");
  expect_refused({"out"}, "summary.json");
}

TEST_F(ReportCommandTest, AttitudeAloneHasAPage) {
  ASSERT_EQ(recording_.Run({"--out=out", "--methods=ahrs", "--report"}).status,
            0);
  const std::string page = ReadFile(Out("report.html"));
  EXPECT_THAT(page, HasSubstr("attitude alone was estimated"));
}

TEST_F(ReportCommandTest, FixesSayWhatBecameOfThem) {
  RunInto("out", {"--withhold=gnss:every=20s,length=5s", "--to=45"});
  int used = 0;
  int withheld = 0;
  int unused = 0;
  for (const std::string& line : Lines(ReadFile(Out("fixes.csv")))) {
    used += line.ends_with(",used,1") ? 1 : 0;
    withheld += line.ends_with(",withheld,0") ? 1 : 0;
    unused += line.ends_with(",unused,0") ? 1 : 0;
  }
  EXPECT_EQ(used + withheld + unused, 51);
  EXPECT_EQ(withheld, 10);
  EXPECT_EQ(unused, 5);
}

TEST_F(ReportCommandTest, ErrorsAreThoseOfTheSummary) {
  RunInto("out");
  double sum = 0.0;
  int count = 0;
  for (const std::string& line : Lines(ReadFile(Out("batch.errors.csv")))) {
    if (line.empty() || line[0] == '#' || line[0] == 't') continue;
    double north = 0.0;
    double east = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%*f,%lf,%lf", &north, &east), 2);
    sum += north * north + east * east;
    ++count;
  }
  const nlohmann::json summary =
      nlohmann::json::parse(ReadFile(Out("summary.json")));
  EXPECT_NEAR(std::sqrt(sum / count),
              summary["methods"]["batch"]["error"]["horizontal_rms_m"], 1e-6);
}

TEST_F(ReportCommandTest, EvaluateWritesTheSamePage) {
  RunInto("out");
  const auto evaluate = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "evaluate");
    return Hindsight(words, recording_.root());
  };
  const Outcome outcome =
      evaluate({"out/batch.csv", "data/truth.csv", "--out=page.html"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("report in page.html\n"));
  const std::string page = ReadFile(recording_.root() / "page.html");
  EXPECT_THAT(page, HasSubstr("Normalised squared position error"));
  EXPECT_THAT(page, HasSubstr("gnss, north"));
  EXPECT_EQ(
      evaluate({"out/batch.csv", "data/truth.csv", "--out=page.html"}).status,
      2);
  // A file that is no result of `run` stands alone.
  fs::create_directory(recording_.root() / "else");
  fs::copy(Out("batch.csv"), recording_.root() / "else" / "mine.csv");
  ASSERT_EQ(evaluate({"else/mine.csv", "data/truth.csv", "--out=page.html",
                      "--force"})
                .status,
            0);
  const std::string alone = ReadFile(recording_.root() / "page.html");
  EXPECT_THAT(alone, HasSubstr("Normalised squared position error"));
  EXPECT_THAT(alone, HasSubstr("was compared with a truth"));
  EXPECT_THAT(alone, Not(HasSubstr("gnss, north")));
}

/// A column of a CSV result, empty fields as NaN.
std::vector<double> Column(const std::string& text, const std::string& title) {
  std::vector<double> values;
  std::size_t column = std::string::npos;
  for (const std::string& line : Lines(text)) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> fields(1);
    for (const char letter : line) {
      if (letter == ',') {
        fields.emplace_back();
      } else {
        fields.back() += letter;
      }
    }
    if (column == std::string::npos) {
      column = static_cast<std::size_t>(
          std::find(fields.begin(), fields.end(), title) - fields.begin());
      if (column == fields.size()) return {};
      continue;
    }
    values.push_back(fields[column].empty() ? std::nan("")
                                            : std::stod(fields[column]));
  }
  return values;
}

TEST_F(ReportCommandTest, TwoFilterTellsItsSeparationByComponents) {
  ASSERT_EQ(recording_.Run({"--out=out", "--methods=ekf,two_filter"}).status,
            0);
  const std::string csv = ReadFile(Out("two_filter.csv"));
  for (const char* name :
       {"n[m]", "e[m]", "d[m]", "v_n[m/s]", "v_e[m/s]", "v_d[m/s]", "roll[deg]",
        "pitch[deg]", "heading[deg]"}) {
    const auto difference = Column(csv, std::string("separation_") + name);
    const auto sigma = Column(csv, std::string("sd_separation_") + name);
    ASSERT_FALSE(difference.empty()) << name;
    // Nothing is known after the end.
    EXPECT_TRUE(std::isnan(difference.back())) << name;
    std::size_t known = 0;
    std::size_t beyond = 0;
    for (std::size_t k = 0; k < difference.size(); ++k) {
      ASSERT_EQ(std::isnan(difference[k]), std::isnan(sigma[k])) << name;
      if (std::isnan(difference[k])) continue;
      ++known;
      if (std::abs(difference[k]) > 4.0 * sigma[k]) ++beyond;
    }
    EXPECT_GT(known, difference.size() / 2) << name;
    EXPECT_EQ(beyond, 0u) << name;
  }
}

TEST_F(ReportCommandTest, BodyMotionIsWithoutBiases) {
  RunInto("out");
  const std::string csv = ReadFile(Out("batch.motion.csv"));
  const auto t = Column(csv, "t[s]");
  const auto f = Column(csv, "f_z[m/s^2]");
  const auto w = Column(csv, "w_z[deg/s]");
  EXPECT_EQ(t, Column(ReadFile(Out("batch.csv")), "t[s]"));
  // At rest, then around a curve of 20 deg/s.
  EXPECT_NEAR(f[2], -9.807, 0.02);
  EXPECT_NEAR(*std::max_element(w.begin(), w.end()), 20.0, 1.0);
}

TEST_F(ReportCommandTest, TheSummaryTellsOneInputFromAnother) {
  RunInto("out");
  const auto inputs = [&](const std::string& folder) {
    return nlohmann::json::parse(
        ReadFile(recording_.root() / folder / "summary.json"))["inputs"];
  };
  const auto first = inputs("out");
  ASSERT_GE(first.size(), 4u);
  for (const auto& input : first) {
    EXPECT_EQ(input["sha256"].get<std::string>().size(), 64u);
    EXPECT_EQ(
        input["bytes"].get<std::uintmax_t>(),
        fs::file_size(recording_.root() / input["path"].get<std::string>()));
  }
  recording_.Edit("gnss.csv", [](std::vector<std::string>* lines) {
    lines->back() += " ";
  });
  RunInto("other", {"--without=speed"});
  const auto second = inputs("other");
  EXPECT_EQ(second.size(), first.size() - 1);
  EXPECT_EQ(second[0], first[0]);
  EXPECT_NE(second[2]["sha256"], first[2]["sha256"]);
}

TEST_F(ReportCommandTest, TheTerminalIsAsWideAsItIsSaidToBe) {
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run", "data/config.yaml", "--out=out",
                                      "--methods=ekf,batch", "--force"};
    words.insert(words.end(), more.begin(), more.end());
    return Hindsight(words, recording_.root(),
                     [] { setenv("COLUMNS", "60", 1); });
  };
  const Outcome outcome = run({});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  bool table = false;
  for (const std::string& line : Lines(outcome.out)) {
    if (line.starts_with("method ")) table = true;
    if (table && line.find("  ") != std::string::npos) {
      EXPECT_LE(line.size(), 60u) << line;
    }
    if (line.starts_with("residuals")) table = true;
    if (line.empty()) table = false;
  }
  EXPECT_THAT(outcome.out, HasSubstr("\nover sigma, rms  "));
  EXPECT_THAT(outcome.out, Not(HasSubstr("\033[")));
  const Outcome quiet = run({"--quiet"});
  EXPECT_EQ(quiet.status, 0);
  EXPECT_EQ(quiet.out, "");
  EXPECT_EQ(quiet.err, "");
}

}  // namespace
}  // namespace hindsight
