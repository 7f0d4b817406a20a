#include <fmt/core.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/units.h"
#include "earth/wgs84.h"
#include "io/config/init_config.h"
#include "io/recording_folder.h"

namespace hindsight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// How a file writes an IMU that stands with z up for five seconds and is then
/// rocked about x by up to 0.6 rad, at 100 Hz.
struct Spelling {
  const char* name;
  const char* before;  ///< what stands before the rows
  double accel;        ///< one m/s^2 in the file
  double gyro;         ///< one rad/s
  double time;         ///< one s
  const char* order;   ///< t, a, g; x: a word of text
  char delimiter = ',';
  const char* behind = "";
  char decimal = '.';
  const char* word = "imu_link";
  bool whole = false;  ///< numbers
};

void PrintTo(const Spelling& spelling, std::ostream* out) {
  *out << spelling.name;
}

constexpr double kRate = 100.0;
constexpr int kRows = 4000;

std::string Rows(const Spelling& spelling, double mirror = 1.0) {
  std::string text = spelling.before;
  const int digits = spelling.whole ? 0 : 6;
  for (int k = 0; k < kRows; ++k) {
    const double t = k / kRate;
    const double phase = std::max(0.0, t - 5.0);
    const double angle = 0.6 * std::sin(phase);
    const double rate = phase > 0.0 ? 0.6 * std::cos(phase) : 0.0;
    // Noise of a few least digits.
    const double noise = 1e-3 * ((k * 7919) % 13 - 6);
    const double f[3] = {noise, kStandardGravity * std::sin(angle) * mirror,
                         kStandardGravity * std::cos(angle) - noise};
    const double w[3] = {rate + 0.1 * noise, 0.1 * noise * mirror, 0.1 * noise};
    std::string row;
    const auto add = [&](const std::string& word) {
      if (!row.empty()) row += spelling.delimiter;
      row += word;
    };
    for (const char* c = spelling.order; *c != '\0'; ++c) {
      if (*c == 'x') add(spelling.word);
      if (*c == 't')
        add(fmt::format("{:.3f}",
                        261906e-3 * spelling.time + t * spelling.time));
      for (int i = 0; i < 3 && *c == 'a'; ++i) {
        add(fmt::format("{:.{}f}", f[i] * spelling.accel, digits));
      }
      for (int i = 0; i < 3 && *c == 'g'; ++i) {
        add(fmt::format("{:.{}f}", w[i] * spelling.gyro, digits));
      }
    }
    std::replace(row.begin(), row.end(), '.', spelling.decimal);
    text += row + "\n";
  }
  return text + spelling.behind;
}

class Spellings : public RecordingFolder,
                  public ::testing::WithParamInterface<Spelling> {};

TEST_P(Spellings, OfOneImuReadTheSame) {
  Write("log.txt", Rows(GetParam()));
  const auto drafts = DraftRecordings(folder_.string());
  ASSERT_EQ(drafts.size(), 1u);
  Write("config.yaml", DraftText(drafts[0]));
  ASSERT_EQ(LoadError(), "") << DraftText(drafts[0]);
  const ImuStream imu = Load().imu;
  ASSERT_NEAR(static_cast<double>(imu.samples.size()), kRows, 2.0);
  EXPECT_NEAR(imu.samples[100].accel.norm(), kStandardGravity, 0.02);
  EXPECT_NEAR(imu.nominal_dt, 1.0 / kRate, 1e-6);
  double fastest = 0.0;
  for (const ImuSample& sample : imu.samples) {
    fastest = std::max(fastest, sample.gyro.x());
  }
  EXPECT_NEAR(fastest, 0.6, 0.01);
}

constexpr double kG = 1.0 / kStandardGravity;

INSTANTIATE_TEST_SUITE_P(
    All, Spellings,
    ::testing::Values(
        Spelling{"SiTitles", "time,ax,ay,az,gx,gy,gz\n", 1.0, 1.0, 1.0, "tag"},
        Spelling{"Degrees", "time,ax,ay,az,gx,gy,gz\n", 1.0, 1.0 / kDegree, 1.0,
                 "tag"},
        Spelling{"UnitsInTitles",
                 "Time [s],ACC X [g],ACC Y [g],ACC Z [g],GYRO X [dps],GYRO Y "
                 "[dps],GYRO Z [dps]\n",
                 kG, 1.0 / kDegree, 1.0, "tag"},
        Spelling{"NoTitlesCutFirstLine", "0.007,1.01,0.03,3326\n", kG,
                 1.0 / kDegree, 1e3, "agt"},
        Spelling{"Excel", "sep=;\nPacket;Acc_X;Acc_Y;Acc_Z;Gyr_X;Gyr_Y;Gyr_Z\n",
                 1.0, 1.0, 1e6, "tag", ';',
                 "Average;9.81;;;;;\n\nmade by hand\n"},
        Spelling{"Counts", "t_ms,ax,ay,az,gx,gy,gz\n", 16384.0 * kG,
                 1.0 / kDegree, 1e3, "tag"},
        Spelling{"DecimalCommas",
                 "\"Time (s)\";\"Acc X (m/s^2)\";\"Acc Y (m/s^2)\";"
                 "\"Acc Z (m/s^2)\";\"Gyr X (rad/s)\";\"Gyr Y (rad/s)\";"
                 "\"Gyr Z (rad/s)\"\n",
                 1.0, 1.0, 1.0, "tag", ';', "", ','},
        Spelling{"UnitsBelowTitles",
                 "time,acc_x,acc_y,acc_z,gyr_x,gyr_y,gyr_z\n"
                 "ms,g,g,g,deg/s,deg/s,deg/s\n",
                 kG, 1.0 / kDegree, 1e3, "tag"},
        Spelling{"TextBesideNumbers",
                 "%time,field.header.frame_id,field.linear_acceleration.x,"
                 "field.linear_acceleration.y,field.linear_acceleration.z,"
                 "field.angular_velocity.x,field.angular_velocity.y,"
                 "field.angular_velocity.z\n",
                 1.0, 1.0, 1e9, "txag"},
        Spelling{"Quoted",
                 "\"\",\"epoch (ms)\",\"Accelerometer (x) [m/s^2]\","
                 "\"Accelerometer (y) [m/s^2]\",\"Accelerometer (z) [m/s^2]\","
                 "\"Gyroscope (x) [rad/s]\",\"Gyroscope (y) [rad/s]\","
                 "\"Gyroscope (z) [rad/s]\"\n",
                 1.0, 1.0, 1e3, "xtag", ',', "", '.', "\"drive, again\""},
        Spelling{"CountsOfBoth", "millis,ax,ay,az,gx,gy,gz\n", 16384.0 * kG,
                 131.072 / kDegree, 1e3, "tag", ',', "", '.', "", true},
        Spelling{"RollRates",
                 "time,Ax [g],Ay [g],Az [g],Roll rate [deg/s],"
                 "Pitch rate [deg/s],Yaw rate [deg/s]\n",
                 kG, 1.0 / kDegree, 1.0, "tag"},
        Spelling{"GForces",
                 "Record,GForceX,GForceY,GForceZ,GyroX,GyroY,GyroZ\n", kG,
                 1.0 / kDegree, 1e3, "tag"},
        Spelling{"Blanks", "", 1.0, 1.0, 1e3, "tga", ' '},
        Spelling{"CutLastLine", "time,ax,ay,az,gx,gy,gz\n", 1.0, 1.0, 1.0,
                 "tag", ',', "302.9,0.01,0.2"}),
    [](const auto& info) { return std::string(info.param.name); });

class RecogniseColumns : public RecordingFolder {};

constexpr Spelling kPlain = {"",   "time,ax,ay,az,gx,gy,gz\n", 1.0, 1.0, 1.0,
                             "tag"};

TEST_F(RecogniseColumns, AMirroredAxisIsTold) {
  Write("log.csv", Rows(kPlain, -1.0));
  const auto drafts = DraftRecordings(folder_.string());
  EXPECT_THAT(drafts.at(0).assumptions,
              ElementsAre(HasSubstr("an axis is mirrored in both")));
  Write("log.csv", Rows(kPlain));
  EXPECT_THAT(DraftRecordings(folder_.string()).at(0).assumptions,
              ::testing::IsEmpty());
}

/// Fixes that go north and east, beside the IMU.
std::string Fixes(const std::string& titles, const std::string& behind) {
  std::string text = titles;
  for (int k = 0; k < 40; ++k) {
    text +=
        fmt::format("{}.5,{:.7f},{:.7f},{:.2f}{}\n", 262 + k, 48.0 + 1e-5 * k,
                    11.0 + 2e-5 * k, 500.0 + 0.1 * (k % 3), behind);
  }
  return text;
}

TEST_F(RecogniseColumns, AccuraciesBecomeTheSigmasOfAnAxis) {
  struct Case {
    const char* titles;
    const char* sigma_n;
    const char* sigma_d;
  };
  for (const Case& one :
       {Case{"time,lat,lon,alt,hAcc,vAcc\n",
             "sigma_n: {column: \"5\", unit: \"m\", scale: 0.66}",
             "sigma_d: \"6 [m]\""},
        Case{"time,lat,lon,alt,Horizontal Accuracy (m),Vertical Accuracy (m)\n",
             "sigma_e: {column: \"5\", unit: \"m\", scale: 0.66}",
             "sigma_d: \"6 [m]\""},
        Case{"time,lat,lon,alt,accuracy,satellites\n",
             "sigma_n: {column: \"5\", unit: \"m\", scale: 0.66}",
             "sigma_d: \"5 [m]\""},
        Case{"time,lat,lon,alt,sigma,satellites\n", "sigma_n: \"5 [m]\"",
             "sigma_d: \"5 [m]\""}}) {
    Write("log.csv", Rows(kPlain));
    Write("gps.csv", Fixes(one.titles, ",1.5,3"));
    const std::string text = DraftText(DraftRecordings(folder_.string()).at(0));
    EXPECT_THAT(text, HasSubstr(one.sigma_n));
    EXPECT_THAT(text, HasSubstr(one.sigma_d));
  }
  // A receiver that does not know writes zero: no sigma to be used.
  Write("gps.csv", Fixes("time,lat,lon,alt,accuracy,satellites\n", ",0,3"));
  EXPECT_THAT(DraftText(DraftRecordings(folder_.string()).at(0)),
              Not(HasSubstr("sigma_n")));
}

TEST_F(RecogniseColumns, PlacesInWholeNumbersAreOfReceivers) {
  std::string text = "timestamp,lat,lon,alt,fix_type\n";
  for (int k = 0; k < 40; ++k) {
    text +=
        fmt::format("{},{},{},{},3\n", 262500 + 1000 * k, 480000000 + 100 * k,
                    110000000 + 200 * k, 500000 + 100 * (k % 3));
  }
  Write("log.csv", Rows(kPlain));
  Write("gps.csv", text);
  const std::string config = DraftText(DraftRecordings(folder_.string()).at(0));
  Write("config.yaml", config);
  ASSERT_EQ(LoadError(), "") << config;
  const Dataset dataset = Load();
  ASSERT_EQ(dataset.streams.size(), 1u) << config;
  const auto fix =
      std::get<PositionFix>(dataset.streams[0].measurements[1].model);
  const Geodetic place = GeodeticFromEcef(fix.p_e);
  EXPECT_NEAR(place.latitude / kDegree, 48.00001, 1e-9);
  EXPECT_NEAR(place.longitude / kDegree, 11.00002, 1e-9);
  EXPECT_NEAR(place.height, 500.1, 1e-6);
}

TEST_F(RecogniseColumns, ZerosBeforeTheFirstFixAreNoPlaces) {
  Write("log.csv", Rows(kPlain));
  std::string rows = "time,latitude,longitude,altitude\n";
  for (int k = 0; k < 5; ++k) rows += fmt::format("{}.5,0,0,0\n", 257 + k);
  Write("gps.csv", Fixes(rows, ""));
  Write("config.yaml", DraftText(DraftRecordings(folder_.string()).at(0)));
  ASSERT_EQ(LoadError(), "");
  const Dataset dataset = Load();
  EXPECT_EQ(dataset.streams.at(0).measurements.size(), 40u);
  EXPECT_NEAR(
      GeodeticFromEcef(
          std::get<PositionFix>(dataset.streams[0].measurements[0].model).p_e)
              .latitude /
          kDegree,
      48.0, 1e-9);
}

/// Beside another estimate, a place to return to and other heights.
TEST_F(RecogniseColumns, OfSeveralPlacesTheReceiversOwnIsTaken) {
  Write("log.csv", Rows(kPlain));
  std::string text =
      "time,home_lat,home_lon,baro_alt,ekf_lat,ekf_lon,ekf_alt,gps_lat,"
      "gps_lon,gps_alt_msl,gps_alt_ellipsoid\n";
  for (int k = 0; k < 40; ++k) {
    text += fmt::format(
        "{}.5,47,10,{:.2f},{:.7f},{:.7f},9,{:.7f},{:.7f},{:.2f},{:.2f}\n",
        262 + k, 3.0 + 0.1 * (k % 3), 48.1 + 1e-5 * k, 11.1 + 2e-5 * k,
        48.0 + 1e-5 * k, 11.0 + 2e-5 * k, 455.0 + 0.1 * (k % 3),
        500.0 + 0.1 * (k % 3));
  }
  Write("gps.csv", text);
  const std::string config = DraftText(DraftRecordings(folder_.string()).at(0));
  EXPECT_THAT(config, HasSubstr("lat: \"8 [deg]\""));
  EXPECT_THAT(config, HasSubstr("lon: \"9 [deg]\""));
  EXPECT_THAT(config, HasSubstr("h: \"11 [m]\""));
}

TEST_F(RecogniseColumns, AnAltitudeOfADvlIsNoHeight) {
  Write("log.csv", Rows(kPlain));
  std::string text = "time,vx_mm_s,vy_mm_s,vz_mm_s,altitude_m\n";
  for (int k = 0; k < 40; ++k) {
    text += fmt::format("{}.5,{},0,0,{:.2f}\n", 262 + k, 1000 + k,
                        20.0 + 0.1 * (k % 3));
  }
  Write("dvl.csv", text);
  EXPECT_THAT(DraftText(DraftRecordings(folder_.string()).at(0)),
              Not(HasSubstr("type: height")));
}

TEST_F(RecogniseColumns, HeightsAboveTheSeaAreTold) {
  Write("log.csv", Rows(kPlain));
  const auto assumptions = [&](const char* titles) {
    Write("gps.csv", Fixes(titles, ",46"));
    return DraftRecordings(folder_.string()).at(0).assumptions;
  };
  const auto told =
      ::testing::Contains(HasSubstr("heights seem to count from the sea"));
  EXPECT_THAT(assumptions("time,latitude,longitude,hMSL,x\n"), told);
  EXPECT_THAT(assumptions("time,latitude,longitude,alt,undulation\n"), told);
  EXPECT_THAT(assumptions("time,latitude,longitude,alt,x\n"), Not(told));
  EXPECT_THAT(assumptions("time,latitude,longitude,h_ellipsoid,geoid\n"),
              Not(told));
}

TEST_F(RecogniseColumns, PlacesWithoutHeightsAreKnownToAKilometreUpwards) {
  Write("log.csv", Rows(kPlain));
  std::string text = "time,latitude,longitude,null_now_and_then\n";
  for (int k = 0; k < 36; ++k) {
    text += fmt::format("{}.5,{:.7f},{:.7f},{}\n", 262 + k, 48.0 + 1e-5 * k,
                        11.0 + 2e-5 * k, k % 3 == 0 ? "null" : "N/A");
  }
  Write("gps.csv", text);
  const std::string config = DraftText(DraftRecordings(folder_.string()).at(0));
  EXPECT_THAT(config, HasSubstr("h: {constant: 0 m}"));
  // 1 km over the square root of 36.
  EXPECT_THAT(config, HasSubstr("sigma: [3, 3, 6000 m]"));
  Write("config.yaml", config);
  EXPECT_EQ(LoadError(), "") << config;
}

TEST_F(RecogniseColumns, ColumnsOfAxesAloneAreNoPlaces) {
  std::string text = "time,seconds_elapsed,z,y,x\n";
  for (int k = 0; k < 400; ++k) {
    text +=
        fmt::format("{},{:.3f},{:.6f},{:.6f},{:.6f}\n", 100000 + 10 * k,
                    0.01 * k, 0.3 + 1e-4 * k, 0.1 + 2e-4 * k, 0.2 + 1e-4 * k);
  }
  Write("Gyroscope.csv", text);
  Write("log.csv", Rows(kPlain));
  EXPECT_THAT(DraftText(DraftRecordings(folder_.string()).at(0)),
              Not(HasSubstr("type: position")));
}

/// One file of an IMU whose rows now and then hold a fix as well.
class FixesInSomeRows : public RecordingFolder,
                        public ::testing::WithParamInterface<char> {};

TEST_P(FixesInSomeRows, AreFoundBesideTheImu) {
  std::string text;
  int row = -1;
  std::istringstream lines(Rows(kPlain));
  for (std::string line; std::getline(lines, line); ++row) {
    const bool fix = row >= 0 && row % 100 == 0;
    text += line +
            (row < 0 ? ",Latitude,Longitude,Altitude"
             : fix   ? fmt::format(",{:.7f},{:.7f},{:.2f}", 48.0 + 1e-7 * row,
                                   11.0 + 2e-7 * row, 500.0 + 0.1 * (row % 3))
                     : ",,,") +
            "\n";
  }
  std::replace(text.begin(), text.end(), ',', GetParam());
  Write("log.csv", text);
  const std::string config = DraftText(DraftRecordings(folder_.string()).at(0));
  Write("config.yaml", config);
  ASSERT_EQ(LoadError(), "") << config;
  const Dataset dataset = Load();
  EXPECT_NEAR(static_cast<double>(dataset.imu.samples.size()), kRows, 2.0);
  ASSERT_EQ(dataset.streams.size(), 1u) << config;
  EXPECT_EQ(dataset.streams[0].measurements.size(), 40u);
}

INSTANTIATE_TEST_SUITE_P(Delimiters, FixesInSomeRows,
                         ::testing::Values(',', ';', '\t'));

/// What changes from row to row is the rows' time, not what counts them or
/// stands still between fixes.
TEST_F(RecogniseColumns, OfSeveralTimesTheRowsOwnIsTaken) {
  std::string text =
      "loggingSample(N),locationTimestamp(s),accelTimestamp_sinceReboot(s),"
      "accelX(G),accelY(G),accelZ(G),gyroX(rad/s),gyroY(rad/s),gyroZ(rad/s)\n";
  int row = -1;
  std::istringstream lines(Rows(kPlain));
  for (std::string line; std::getline(lines, line); ++row) {
    if (row < 0) continue;
    text += fmt::format("{},{},{}\n", row, 262 + row / 100, line);
  }
  Write("log.csv", text);
  const std::string config = DraftText(DraftRecordings(folder_.string()).at(0));
  EXPECT_THAT(config, HasSubstr("t: \"3 [s]\""));
}

TEST_F(RecogniseColumns, NorthAndEastOfAVelocityAreToldByItsNameOrUnit) {
  const std::string rows = [] {
    std::string text;
    for (int k = 0; k < 40; ++k) {
      text += fmt::format("{}.5;{};{};{}\n", 262 + k, 0.1 * (k % 2), 3 + k % 3,
                          4.0);
    }
    return text;
  }();
  Write("log.csv", Rows(kPlain));
  for (const auto& [name, titles] :
       {std::pair("v.csv.gz", "when;down;east;north\n"),
        {"gnss.csv.gz", "when;down[km/h];east[km/h];north[km/h]\n"}}) {
    WriteGzip(name, titles + rows);
    const std::string text = DraftText(DraftRecordings(folder_.string()).at(0));
    EXPECT_THAT(text, HasSubstr("type: velocity"));
    EXPECT_THAT(text, HasSubstr("v_n: \"4 ["));
    EXPECT_THAT(text, HasSubstr("v_d: \"2 ["));
    std::filesystem::remove(Path(name));
  }
}

TEST_F(RecogniseColumns, HeightsAloneAreABarometers) {
  Write("log.csv", Rows(kPlain));
  std::string text = "time,baro_altitude\n";
  for (int k = 0; k < 40; ++k) text += fmt::format("{}.5,{}\n", 262 + k, 500.2);
  Write("baro.csv", text);
  const auto drafts = DraftRecordings(folder_.string());
  EXPECT_THAT(drafts.at(0).unknown, ::testing::IsEmpty());
  EXPECT_THAT(DraftText(drafts.at(0)), HasSubstr("type: height"));
}

TEST_F(RecogniseColumns, ColumnsOfAnUntitledImuAreNoPlaces) {
  // Slow turns: accelerometers in g change as little from row to row as a place.
  std::string text;
  for (int k = 0; k < 4000; ++k) {
    const double t = 0.01 * k;
    const double angle = 0.3 * std::sin(0.5 * t);
    text += fmt::format("{:.3f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f}\n", t,
                        0.05 + 0.001 * std::sin(3.0 * t), std::sin(angle),
                        std::cos(angle), 0.15 * std::cos(0.5 * t), 1e-4, 1e-4);
  }
  Write("imu", text);
  const auto drafts = DraftRecordings(folder_.string());
  EXPECT_THAT(drafts.at(0).aiding, ::testing::IsEmpty());
}

TEST_F(RecogniseColumns, LatitudeAndLongitudeOfATruthAreDegreesByTheirSize) {
  Write("log.csv", Rows(kPlain));
  Write("truth.csv", Fixes("time,lat,lon,alt\n", ""));
  EXPECT_THAT(DraftText(DraftRecordings(folder_.string()).at(0)),
              HasSubstr("lat: \"2 [deg]\""));
}

TEST_F(RecogniseColumns, AFolderOfSeveralRecordingsGivesOneEach) {
  for (const char* name : {"a", "b"}) {
    std::filesystem::create_directories(folder_ / name);
    Write(std::string(name) + "/imu.csv", Rows(kPlain));
    Write(std::string(name) + "/notes.md", "nothing\n");
  }
  const auto drafts = DraftRecordings(folder_.string());
  ASSERT_EQ(drafts.size(), 2u);
  EXPECT_EQ(drafts[0].name, "a");
  EXPECT_EQ(drafts[1].name, "b");
  EXPECT_THAT(drafts[0].unknown, ElementsAre("notes.md"));
}

/// Fixes of a car that goes north at 10 m/s, each written 25 times, whose stamps
/// count ten times too fast.
TEST_F(RecogniseColumns,
       FixesWrittenTooOftenAndStampedWronglyAreReadAtTheirRate) {
  Write("imu.csv", Rows(kPlain));
  std::string fixes = "Timestamp,Lat_GNSS,Long_GNSS,Height_GNSS\n";
  for (int k = 0; k < kRows; ++k) {
    const int same = k / 25;
    const double t = same * 25 / kRate;
    fixes += fmt::format("{:.1f},{:.7f},35.1234567,{:.2f}\n", 0.1 * k,
                         48.0 + 10.0 * t / 111200.0, 100.0 + 0.01 * t);
  }
  Write("GNSS.csv", fixes);
  const auto drafts = DraftRecordings(folder_.string());
  Write("config.yaml", DraftText(drafts.at(0)));
  ASSERT_EQ(LoadError(), "") << DraftText(drafts[0]);
  const Dataset data = Load();
  ASSERT_EQ(data.streams.size(), 1u);
  // One a second of the four that are new.
  EXPECT_EQ(data.streams[0].measurements.size(), 40u);
  EXPECT_NEAR(data.streams[0].measurements.back().t, 39.0, 0.1);
}

TEST_F(RecogniseColumns, StampsDrawnEvenlyAreCountedInstead) {
  Write("imu.csv", Rows(kPlain));
  std::string dvl = "Time [s],DVL X [m/s],DVL Y [m/s],DVL Z [m/s]\n";
  for (int k = 0; k < 400; ++k) {
    dvl += fmt::format("{:.15f},2,0.{},0\n", 400.0 / 399.0 * k, k % 10);
  }
  Write("dvl.csv", dvl);
  const auto drafts = DraftRecordings(folder_.string());
  const std::string text = DraftText(drafts.at(0));
  EXPECT_THAT(text, HasSubstr("time: {rate: 1 Hz"));
  EXPECT_THAT(text, HasSubstr("type: dvl"));
}

}  // namespace
}  // namespace hindsight
