#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/units.h"
#include "io/write/kml.h"
#include "io/write/nav.h"
#include "io/write/tum.h"
#include "support/temporary_folder.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// From the equator at 90 deg east, heading east with 20 deg of pitch, to a
/// point 100 m up.
SolutionTable TwoEpochs() {
  SolutionTable table;
  for (const double h : {50.0, 150.0}) {
    const State x =
        MakeState(0.5 + (h - 50.0) / 100.0, {0.0, 0.5 * kPi, h},
                  {1.0, -2.0, 3.0}, {0.0, 20.0 * kDegree, 90.0 * kDegree});
    table.t.push_back(x.t);
    table.p_e.push_back(x.p_e);
    table.v_e.push_back(x.v_e);
    table.q_eb.push_back(x.q_eb);
  }
  return table;
}

std::vector<std::string> Lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Tum, IsEastNorthUpWithForwardLeftUpBodyAxes) {
  const TemporaryFolder folder;
  WriteTum(folder.Path("a.tum"), TwoEpochs());
  // Heading east, x of forward-left-up is x of east-north-up; nose up 20 deg
  // is a turn about left by -20 deg: qy = -sin 10 deg, qw = cos 10 deg.
  EXPECT_EQ(folder.Read("a.tum"),
            "0.500000000 0.000000 0.000000 0.000000 0.000000000000 "
            "-0.173648177667 0.000000000000 0.984807753012\n"
            "1.500000000 0.000000 0.000000 100.000000 0.000000000000 "
            "-0.173648177667 0.000000000000 0.984807753012\n");
}

TEST(Tum, HasAPositiveScalarPartAndNeverAMinusZero) {
  const TemporaryFolder folder;
  SolutionTable table = TwoEpochs();
  for (Eigen::Quaterniond& q : table.q_eb) q.coeffs() = -q.coeffs();
  WriteTum(folder.Path("a.tum"), table);
  EXPECT_THAT(folder.Read("a.tum"), HasSubstr(" 0.984807753012\n"));
  EXPECT_THAT(folder.Read("a.tum"), Not(HasSubstr("-0.000000 ")));
}

TEST(Tum, PutsARemarkIntoACommentLine) {
  const TemporaryFolder folder;
  WriteTum(folder.Path("a.tum"), TwoEpochs(), "not as recorded");
  const std::vector<std::string> lines = Lines(folder.Read("a.tum"));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], "# not as recorded");
  EXPECT_THAT(lines[1], ::testing::StartsWith("0.500000000 "));
}

TEST(Nav, MatchesHandComputedLine) {
  const TemporaryFolder folder;
  SolutionTable table = TwoEpochs();
  table.q_eb[1] = Eigen::Quaterniond(table.C_en(1)) *
                  QuaternionFromEuler(0.0, 0.0, -30.0 * kDegree);
  // Week 2000 begins 2000 * 604800 s after the GPS epoch; 1 s before it.
  const std::int64_t epoch = (2000LL * 604800LL - 1LL) * 1'000'000'000LL;
  WriteNav(folder.Path("a.nav"), table, epoch);
  EXPECT_EQ(folder.Read("a.nav"),
            "1999 604799.500000000 0.000000000000 90.000000000000 50.000000 "
            "1.000000 -2.000000 3.000000 0.00000000 20.00000000 90.00000000\n"
            "2000 0.500000000 0.000000000000 90.000000000000 150.000000 "
            "1.000000 -2.000000 3.000000 0.00000000 0.00000000 "
            "330.00000000\n");
}

TEST(Nav, WithoutADateCountsFromTheDataSetsOwnEpoch) {
  const TemporaryFolder folder;
  WriteNav(folder.Path("a.nav"), TwoEpochs(), std::nullopt);
  EXPECT_THAT(folder.Read("a.nav"), ::testing::StartsWith("0 0.500000000 "));
}

TEST(Kml, HoldsPathAndTimedTrack) {
  const TemporaryFolder folder;
  // 2017-07-01 00:00:18 GPS is midnight UTC.
  const std::int64_t epoch = (1'182'902'400LL + 18LL) * 1'000'000'000LL;
  WriteKml(folder.Path("a.kml"), TwoEpochs(), epoch, "drive <1> & back");
  const std::string text = folder.Read("a.kml");
  EXPECT_THAT(text, HasSubstr("<coordinates>\n"
                              "90.000000000,0.000000000,50.000\n"
                              "90.000000000,0.000000000,150.000\n"
                              "</coordinates>"));
  EXPECT_THAT(text, HasSubstr("<when>2017-07-01T00:00:00.500Z</when>\n"
                              "<when>2017-07-01T00:00:01.500Z</when>\n"
                              "<gx:coord>90.000000000 0.000000000 50.000"));
  EXPECT_THAT(text, HasSubstr("<gx:angles>90.00 0 0</gx:angles>"));
  EXPECT_THAT(text, HasSubstr("drive &lt;1> &amp; back"));
}

TEST(Kml, ShowsADescription) {
  const TemporaryFolder folder;
  WriteKml(folder.Path("a.kml"), TwoEpochs(), 0, "x", "1 < 2 & so on");
  EXPECT_THAT(folder.Read("a.kml"),
              HasSubstr("<description>1 &lt; 2 &amp; so on</description>"));
  WriteKml(folder.Path("b.kml"), TwoEpochs(), 0, "x");
  EXPECT_THAT(folder.Read("b.kml"), Not(HasSubstr("description")));
}

TEST(Kml, WithoutADateHasNoTrack) {
  const TemporaryFolder folder;
  WriteKml(folder.Path("a.kml"), TwoEpochs(), std::nullopt, "x");
  EXPECT_THAT(folder.Read("a.kml"), Not(HasSubstr("gx:Track")));
}

TEST(Kml, PartsThePathAtTheDateLine) {
  const TemporaryFolder folder;
  SolutionTable table;
  for (const double longitude : {179.0, 180.0, -179.0, -178.0}) {
    table.t.push_back(static_cast<double>(table.t.size()));
    table.p_e.push_back(EcefFromGeodetic({0.0, longitude * kDegree, 0.0}));
  }
  WriteKml(folder.Path("a.kml"), table, 0, "x");
  const std::string text = folder.Read("a.kml");
  EXPECT_THAT(text, HasSubstr("180.000000000,0.000000000,0.000\n"
                              "</coordinates></LineString></Placemark>\n"
                              "<Placemark><name>path</name><LineString>"
                              "<altitudeMode>absolute</altitudeMode>"
                              "<coordinates>\n"
                              "-179.000000000,0.000000000,0.000\n"));
  const std::vector<std::string> lines = Lines(text);
  EXPECT_EQ(std::count_if(lines.begin(), lines.end(),
                          [](const std::string& line) {
                            return line.find("</gx:Track>") != line.npos;
                          }),
            2);
}

TEST(Kml, ThinsLongPathsAndKeepsTheirEnds) {
  const TemporaryFolder folder;
  SolutionTable table;
  constexpr int kRows = 20001;
  for (int k = 0; k < kRows; ++k) {
    table.t.push_back(k);
    table.p_e.push_back(EcefFromGeodetic({0.0, 0.0, static_cast<double>(k)}));
  }
  WriteKml(folder.Path("a.kml"), table, std::nullopt, "x");
  const std::vector<std::string> lines = Lines(folder.Read("a.kml"));
  const auto is_point = [](const std::string& line) {
    return line.starts_with("0.000000000,0.000000000,");
  };
  EXPECT_EQ(std::count_if(lines.begin(), lines.end(), is_point),
            static_cast<std::ptrdiff_t>(kMaxKmlPoints));
  EXPECT_THAT(lines, ::testing::Contains("0.000000000,0.000000000,0.000"));
  EXPECT_THAT(lines, ::testing::Contains("0.000000000,0.000000000,20000.000"));
}

TEST(Exports, SayWhatTheSolutionLacks) {
  const TemporaryFolder folder;
  SolutionTable table;
  table.t = {0.0};
  table.q_eb = {Eigen::Quaterniond::Identity()};
  EXPECT_THROW(WriteTum(folder.Path("a"), table), EstimationError);
  EXPECT_THROW(WriteNav(folder.Path("a"), table, std::nullopt),
               EstimationError);
  EXPECT_THROW(WriteKml(folder.Path("a"), table, std::nullopt, "x"),
               EstimationError);
  EXPECT_TRUE(folder.Entries().empty());
}

}  // namespace
}  // namespace hindsight
