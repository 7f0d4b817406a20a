#include <fmt/core.h>

#include "base/units.h"
#include "io/read/time_scale.h"
#include "io/sample_folder.h"

namespace hindsight {
namespace {

constexpr const char* kNmeaConfig =
    "epoch: 2016-12-31 23:59:58 UTC\n"
    "imu:\n  file: imu.csv\n  max_gap: 10 s\n"
    "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n"
    "aiding:\n"
    "  gnss: {type: position, file: drive.nmea, format: nmea}\n"
    "  course: {type: speed_course, file: drive.nmea, format: nmea, "
    "sigma: 0.1 m/s, course_sigma: 1 deg}\n";

std::string Sentence(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return fmt::format("${}*{:02X}\r\n", body, sum);
}

class Nmea : public SampleFolder {
 protected:
  Nmea() {
    Write("imu.csv", std::string(kRestingImu) + "9.9,0,0,0,0,0,-9.8\n");
    std::filesystem::copy(Sample("nmea/drive.nmea"), Path("drive.nmea"));
    Write("config.yaml", kNmeaConfig);
  }
};

TEST_F(Nmea, FixesAreAboveTheEllipsoidWithTheirStandardDeviations) {
  const Dataset data = Load();
  ASSERT_EQ(data.streams[0].measurements.size(), 2u);
  const auto first =
      std::get<PositionFix>(data.streams[0].measurements[0].model);
  Geodetic g = GeodeticFromEcef(first.p_e);
  EXPECT_NEAR(g.latitude / kDegree, 48.0 + 7.038 / 60.0, 1e-10);
  EXPECT_NEAR(g.longitude / kDegree, -(11.0 + 31.0 / 60.0), 1e-10);
  EXPECT_NEAR(g.height, 545.4 + 46.9, 1e-6);
  EXPECT_DOUBLE_EQ(first.R_n(0, 0), 0.03 * 0.03);
  EXPECT_DOUBLE_EQ(first.R_n(2, 2), 0.05 * 0.05);
  EXPECT_EQ(first.quality, 4.0);
  EXPECT_EQ(first.satellites, 8.0);
  // Here GST stands before GGA.
  const auto second =
      std::get<PositionFix>(data.streams[0].measurements[1].model);
  g = GeodeticFromEcef(second.p_e);
  EXPECT_NEAR(g.latitude / kDegree, -(48.0 + 7.039 / 60.0), 1e-10);
  EXPECT_NEAR(g.height, -15.5, 1e-6);
  EXPECT_DOUBLE_EQ(second.R_n(1, 1), 0.07 * 0.07);
}

TEST_F(Nmea, TimeRunsOverMidnightAndTheLeapSecond) {
  const Dataset data = Load();
  EXPECT_NEAR(data.streams[0].measurements[0].t, 0.0, 1e-9);
  EXPECT_NEAR(data.streams[0].measurements[1].t, 3.0, 1e-9);
}

TEST_F(Nmea, SpeedIsInKnotsAndCourseMayBeAbsent) {
  const Dataset data = Load();
  ASSERT_EQ(data.streams[1].measurements.size(), 2u);
  const auto moving =
      std::get<SpeedCourse>(data.streams[1].measurements[0].model);
  EXPECT_NEAR(moving.speed, 10.0 * 1852.0 / 3600.0, 1e-12);
  EXPECT_NEAR(moving.course, 0.5 * kPi, 1e-12);
  EXPECT_TRUE(moving.has_course);
  EXPECT_FALSE(
      std::get<SpeedCourse>(data.streams[1].measurements[1].model).has_course);
}

TEST_F(Nmea, EpochsWithoutAFixAreCounted) {
  const Dataset data = Load();
  ASSERT_EQ(data.policies.size(), 3u);
  EXPECT_EQ(data.policies[1].action, "no fix");
  EXPECT_EQ(data.policies[1].count, 1);
}

TEST_F(Nmea, WithoutADateStampsAreSecondsOfTheFirstDay) {
  Write("drive.nmea",
        Sentence("GPGGA,235958.00,4807,N,01131,E,4,08,0.9,545,M,46,M,,") +
            Sentence("GPGGA,000001.50,4807,N,01131,E,4,08,0.9,545,M,46,M,,"));
  const std::string config = kNmeaConfig;
  const std::size_t course = config.find("  course:");
  Write("config.yaml",
        ReplacedOnce(ReplacedOnce(config.substr(0, course),
                                  "epoch: 2016-12-31 23:59:58 UTC\n", ""),
                     "format: nmea}",
                     "format: nmea, sigma: 1 m, time: {start: 1 s}}"));
  const Dataset data = Load();
  ASSERT_EQ(data.streams[0].measurements.size(), 2u);
  EXPECT_NEAR(data.streams[0].measurements[0].t, 1.0, 1e-9);
  EXPECT_NEAR(data.streams[0].measurements[1].t, 4.5, 1e-9);
}

TEST_F(Nmea, TheGeoidSeparationIsNeeded) {
  Write("drive.nmea",
        Sentence("GPGGA,000001.50,4807,N,01131,E,4,08,0.9,545,M,,M,,"));
  EXPECT_TRUE(LoadError().starts_with("drive.nmea:1: GGA has no geoid"))
      << LoadError();
}

TEST_F(Nmea, DamageNamesTheLine) {
  const std::string good = Read("drive.nmea");
  struct Case {
    const char* from;
    const char* to;
    const char* place;
    const char* says;
  };
  const Case cases[] = {
      {"4807.038000,N,01131.000000,W", "4808.038000,N,01131.000000,W",
       "drive.nmea:1: ", "checksum"},
      {"$GPGSV", "GPGSV", "drive.nmea:4: ", "NMEA"},
      {",46*", ",46", "drive.nmea:4: ", "checksum"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.to);
    Write("drive.nmea", ReplacedOnce(good, c.from, c.to));
    EXPECT_TRUE(LoadError().starts_with(c.place)) << LoadError();
    EXPECT_NE(LoadError().find(c.says), std::string::npos) << LoadError();
  }
  Write("drive.nmea", good.substr(0, good.size() - 8));
  EXPECT_TRUE(LoadError().starts_with("drive.nmea:9: ")) << LoadError();
}

}  // namespace
}  // namespace hindsight
