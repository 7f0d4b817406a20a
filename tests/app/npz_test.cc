#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "app/recording.h"
#include "io/read/result_columns.h"

namespace hindsight {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class NpzExportTest : public ::testing::Test {
 protected:
  void RunInto(const std::string& out, const std::string& exports,
               const std::vector<std::string>& more = {}) const {
    std::vector<std::string> flags = {
        "--out=" + out, "--methods=ekf,two_filter", "--export=" + exports};
    flags.insert(flags.end(), more.begin(), more.end());
    const Outcome outcome = recording_.Run(flags);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  std::string Path(const std::string& name) const {
    return (recording_.root() / name).string();
  }
  Recording recording_;
};

TEST_F(NpzExportTest, HoldsWhatTheTextHolds) {
  RunInto("out", "csv,npz", {"--rate=100"});
  for (const std::string stem :
       {"ekf", "ekf.motion", "two_filter", "two_filter.motion"}) {
    const NumberColumns text = ReadNumberColumns(Path("out/" + stem + ".csv"));
    const NumberColumns arrays =
        ReadNumberColumns(Path("out/" + stem + ".npz"));
    ASSERT_EQ(text.size(), arrays.size());
    for (const auto& [title, values] : text) {
      ASSERT_TRUE(arrays.contains(title)) << title;
      const std::vector<double>& exact = arrays.at(title);
      ASSERT_EQ(exact.size(), values.size());
      // Half of the last of six or nine digits, or of six decimals.
      const double digits = title == "separation[1]" ? 5.1e-6 : 5.1e-9;
      for (std::size_t k = 0; k < values.size(); ++k) {
        ASSERT_EQ(std::isnan(values[k]), std::isnan(exact[k])) << title;
        if (std::isnan(values[k])) continue;
        ASSERT_NEAR(values[k], exact[k], 5.1e-7 + digits * std::abs(exact[k]))
            << title;
      }
    }
    EXPECT_EQ(text.at("t[s]"), arrays.at("t[s]"));
  }
}

TEST_F(NpzExportTest, TakesThePlaceOfTheTextForAllThatReadsResults) {
  RunInto("text", "csv");
  RunInto("arrays", "npz");
  const std::vector<std::string> names = Names(recording_.root() / "arrays");
  EXPECT_THAT(names, Contains("ekf.npz"));
  EXPECT_THAT(names, Contains("ekf.motion.npz"));
  EXPECT_THAT(names, Contains("ekf.truth.csv"));
  EXPECT_THAT(names, Not(Contains("ekf.csv")));
  EXPECT_THAT(names, Not(Contains("ekf.motion.csv")));
  EXPECT_EQ(names.size(), Names(recording_.root() / "text").size());
  // The rows at the truth's times are in a file of their own; without it the
  // solution itself is compared.
  for (const bool sampled : {true, false}) {
    SCOPED_TRACE(sampled ? "METHOD.truth.csv" : "METHOD.npz");
    const auto errors = [&](const std::string& solution) {
      const Outcome outcome =
          Hindsight({"evaluate", solution, "data/truth.csv", "--json"},
                    recording_.root());
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      return nlohmann::json::parse(outcome.out)["errors"];
    };
    const nlohmann::json text = errors("text/ekf.csv");
    const nlohmann::json arrays = errors("arrays/ekf.npz");
    ASSERT_EQ(text.size(), arrays.size());
    for (const auto& [key, figures] : text.items()) {
      EXPECT_NEAR(figures["rms"].get<double>(),
                  arrays[key]["rms"].get<double>(), 1e-7)
          << key;
    }
    std::filesystem::remove(Path("text/ekf.truth.csv"));
    std::filesystem::remove(Path("arrays/ekf.truth.csv"));
  }
  const auto page = [&](const std::string& folder) {
    const Outcome outcome = Hindsight(
        {"report", folder, "--out=" + folder + ".html"}, recording_.root());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return ReadFile(Path(folder + ".html"));
  };
  for (const std::string& text : {page("text"), page("arrays")}) {
    EXPECT_THAT(text, HasSubstr("Specific force"));
    EXPECT_THAT(text, HasSubstr("Forward against backward"));
  }
}

TEST_F(NpzExportTest, LoadsInNumPy) {
  // The system's interpreter is the one that Debian's NumPy belongs to.
  const std::string python = "/usr/bin/python3";
  if (std::system((python + " -c 'import numpy' 2>/dev/null").c_str()) != 0) {
    GTEST_SKIP() << "no NumPy (./setup.sh tests)";
  }
  RunInto("out", "csv,npz");
  WriteFile(Path("load.py"), R"(import sys
import numpy
arrays = numpy.load(sys.argv[1] + ".npz")
with open(sys.argv[1] + ".csv") as file:
    lines = [line for line in file if not line.startswith("#")]
titles = [title.split("[")[0] for title in lines[0].split(",")]
assert arrays.files == titles, arrays.files
text = numpy.genfromtxt(lines[1:], delimiter=",")
for i, name in enumerate(titles):
    assert arrays[name].dtype == numpy.float64, name
    digits = 5.1e-6 if name == "separation" else 5.1e-9
    numpy.testing.assert_allclose(arrays[name], text[:, i], digits, 5.1e-7)
)");
  for (const std::string stem : {"ekf", "two_filter", "ekf.motion"}) {
    const std::string command =
        python + " " + Path("load.py") + " " + Path("out/" + stem);
    EXPECT_EQ(std::system(command.c_str()), 0) << stem;
  }
}

}  // namespace
}  // namespace hindsight
