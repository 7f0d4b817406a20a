#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <regex>

#include "base/units.h"
#include "earth/utm.h"
#include "earth/wgs84.h"
#include "io/config/init_config.h"
#include "io/recording_folder.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

constexpr double kLatitude = -48.1;  // deg
constexpr double kLongitude = -11.5;
constexpr double kHeight = 500.0;  // m
constexpr int kFixes = 39;

/// An IMU at rest for as long as the fixes last.
std::string RestingImu() {
  std::string imu = "time,gx,gy,gz,ax,ay,az\n";
  for (int k = 0; k <= 4000; ++k) {
    imu += fmt::format("{:.2f},0.00{},0,0,0,0.0{},-9.81\n", 0.01 * k, k % 7,
                       k % 5);
  }
  return imu;
}

/// How a receiver at rest but for a metre a second to the north is written down.
struct FixForm {
  const char* name;
  const char* titles;
  std::function<std::string(double t, const Geodetic& place)> row;
  const char* line;  ///< of the configuration
};

void PrintTo(const FixForm& form, std::ostream* out) { *out << form.name; }

Geodetic PlaceAt(int k) {
  return {(kLatitude + 1e-5 * k) * kDegree, kLongitude * kDegree, kHeight};
}

/// "4806.000000", of the angle's size.
std::string DegreesMinutes(double angle) {
  const double degrees = std::abs(angle) / kDegree;
  const double whole = std::floor(degrees);
  return fmt::format("{:.7f}", 100.0 * whole + 60.0 * (degrees - whole));
}

class FixForms : public RecordingFolder,
                 public ::testing::WithParamInterface<FixForm> {};

TEST_P(FixForms, AreOnePlace) {
  std::string imu = "time,ax,ay,az,gx,gy,gz\n";
  for (int k = 0; k < 4000; ++k) {
    const double t = 0.01 * k;
    const double phase = std::max(0.0, t - 5.0);
    const double angle = 0.6 * std::sin(phase);
    const double noise = 1e-3 * ((k * 7919) % 13 - 6);
    imu += fmt::format(
        "{:.2f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", t, noise,
        kStandardGravity * std::sin(angle), kStandardGravity * std::cos(angle),
        phase > 0.0 ? 0.6 * std::cos(phase) : 0.0, 0.1 * noise, -0.1 * noise);
  }
  Write("imu.csv", imu);
  std::string fixes = std::string(GetParam().titles) + "\n";
  for (int k = 0; k < kFixes; ++k) {
    fixes += GetParam().row(k, PlaceAt(k)) + "\n";
  }
  Write("gps.csv", fixes);
  const auto drafts = DraftRecordings(folder_.string());
  ASSERT_EQ(drafts.size(), 1u);
  const std::string text = DraftText(drafts[0]);
  EXPECT_THAT(text, HasSubstr(GetParam().line));
  Write("config.yaml", text);
  ASSERT_EQ(LoadError(), "") << text;
  const Dataset data = Load();
  ASSERT_EQ(data.streams.size(), 1u) << text;
  const MeasurementSeries& z = data.streams[0].measurements;
  ASSERT_EQ(z.size(), static_cast<std::size_t>(kFixes));
  for (const int k : {0, kFixes - 1}) {
    const Measurement measured = z[static_cast<std::size_t>(k)];
    const auto& fix = std::get<PositionFix>(measured.model);
    EXPECT_LT((fix.p_e - EcefFromGeodetic(PlaceAt(k))).norm(), 0.02) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, FixForms,
    ::testing::Values(
        FixForm{"MinutesAndLetters", "time,lat,NS,lon,EW,alt",
                [](double t, const Geodetic& p) {
                  return fmt::format("{:.1f},{},S,{},W,{:.2f}", t,
                                     DegreesMinutes(p.latitude),
                                     DegreesMinutes(p.longitude), p.height);
                },
                "lat: \"-2 [ddmm]\""},
        FixForm{"LettersBehind", "time,latitude,longitude,altitude",
                [](double t, const Geodetic& p) {
                  return fmt::format("{:.1f},{:.8f}S,{:.8f}W,{:.2f}", t,
                                     -p.latitude / kDegree,
                                     -p.longitude / kDegree, p.height);
                },
                "lat: \"2 [deg]\""},
        FixForm{"FromTheEarthsCentre", "time,X,Y,Z",
                [](double t, const Geodetic& p) {
                  const Eigen::Vector3d e = EcefFromGeodetic(p);
                  return fmt::format("{:.1f},{:.3f},{:.3f},{:.3f}", t, e.x(),
                                     e.y(), e.z());
                },
                "frame: ecef"},
        FixForm{"UbxMillimetres", "iTOW,lon,lat,height,hAcc,vAcc,gSpeed,velD",
                [](double t, const Geodetic& p) {
                  return fmt::format(
                      "{:.0f},{:.0f},{:.0f},{:.0f},700,1000,1112,3", 1e3 * t,
                      1e7 * p.longitude / kDegree, 1e7 * p.latitude / kDegree,
                      1e3 * p.height);
                },
                "h: \"4 [mm]\""},
        FixForm{"FitSemicircles", "timestamp,position_lat,position_long,h",
                [](double t, const Geodetic& p) {
                  constexpr double kSemicircle = kPi / 2147483648.0;
                  return fmt::format("{:.1f},{:.0f},{:.0f},{:.3f}", t,
                                     p.latitude / kSemicircle,
                                     p.longitude / kSemicircle, p.height);
                },
                "semicircles"},
        FixForm{"FeetAboveTheSea", "time,lat,lon,Alt [ft MSL]",
                [](double t, const Geodetic& p) {
                  return fmt::format("{:.1f},{:.9f},{:.9f},{:.4f}", t,
                                     p.latitude / kDegree,
                                     p.longitude / kDegree, p.height / 0.3048);
                },
                "h: \"4 [ft]\""},
        FixForm{"BesideALaser", "time,lat,lon,altitude_agl,altitude",
                [](double t, const Geodetic& p) {
                  return fmt::format("{:.1f},{:.9f},{:.9f},{:.1f},{:.3f}", t,
                                     p.latitude / kDegree,
                                     p.longitude / kDegree, 20.0 + t, p.height);
                },
                "h: \"5 [m]\""}),
    [](const auto& info) { return std::string(info.param.name); });

/// Days as MATLAB's datenum and spreadsheets count them: one instant.
TEST_F(RecordingFolder, DaysAreCountedFromTheirOwnBeginning) {
  for (const auto& [unit, first] :
       {std::pair("datenum", 739798.5), {"excel", 45838.5}}) {
    std::string imu;
    for (int k = 0; k < 500; ++k) {
      imu += fmt::format("{:.10f} 0 0 0 0 0 -9.81\n", first + k / 8640000.0);
    }
    Write("imu.txt", imu);
    Write(
        "config.yaml",
        std::string("name: x\nimu:\n  file: imu.txt\n  format: columns\n  "
                    "columns: {t: \"1 [") +
            unit +
            "]\", gyro_x: \"2 [rad/s]\", gyro_y: \"3 [rad/s]\", gyro_z: \"4 "
            "[rad/s]\", accel_x: \"5 [m/s^2]\", accel_y: \"6 [m/s^2]\", "
            "accel_z: \"7 [m/s^2]\"}\n  noise: {gyro: 0.1 deg/sqrt(h), accel: "
            "0.1 m/s/sqrt(h)}\n");
    ASSERT_EQ(LoadError(), "") << unit;
    const Dataset data = Load();
    // 2025-06-30 12:00 UTC, 18 leap seconds behind GPS time.
    constexpr std::int64_t kNoonGps = 1751284800 - 315964800 + 18;
    ASSERT_TRUE(data.epoch_gps_ns) << unit;
    const double first_row =
        static_cast<double>(*data.epoch_gps_ns) * 1e-9 + data.imu.samples[0].t;
    EXPECT_NEAR(first_row, static_cast<double>(kNoonGps), 1e-4) << unit;
    EXPECT_NEAR(data.imu.nominal_dt, 0.01, 1e-4) << unit;
  }
}

/// SampleTimeFine counts tenths of a millisecond or microseconds.
TEST_F(RecordingFolder, FineTicksAreThoseOfTheLikelyRate) {
  for (const auto& [step, unit] :
       {std::pair(100, "[0.1 ms]"), {10000, "[us]"}}) {
    std::string text =
        "PacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z,Gyr_X,"
        "Gyr_Y,Gyr_Z\n";
    for (int k = 0; k < 500; ++k) {
      text += fmt::format("{},{},0.0{},0.1,9.8{},0,0,0.00{}\n", k, step * k,
                          k % 7, k % 9, k % 5);
    }
    Write("MT.csv", text);
    const auto drafts = DraftRecordings(folder_.string());
    ASSERT_EQ(drafts.size(), 1u) << unit;
    EXPECT_THAT(DraftText(drafts[0]), HasSubstr(std::string("t: \"2 ") + unit));
  }
}

/// In a file of a DVL's name velocities along axes are those of its own.
TEST_F(RecordingFolder, VelocitiesOfADvlNeedNotNameIt) {
  Write("imu.csv", RestingImu());
  for (const auto& [titles, line] :
       {std::pair("time,velX,velY,velZ", "v_x: \"2 [m/s]\""),
        {"time,Vx [mm/s],Vy [mm/s],Vz [mm/s]", "v_y: \"3 [mm/s]\""},
        {"time,vx,vy,vz", "v_z: \"4 [m/s]\""},
        {"time,vel_forward,vel_starboard,vel_down", "v_z: \"4 [m/s]\""}}) {
    std::string dvl = std::string(titles) + "\n";
    for (int k = 0; k < kFixes; ++k) {
      dvl += fmt::format("{}.0,1.{},0.{},0.0{}\n", k, k % 7, k % 3, k % 5);
    }
    Write("dvl_log.csv", dvl);
    const std::string config = DraftText(DraftRecordings(folder_.string())[0]);
    EXPECT_THAT(config, HasSubstr("type: dvl")) << titles;
    EXPECT_THAT(config, HasSubstr(line)) << titles;
  }
}

/// What a device writes where it has no reading is told by how it is written, how
/// often it stands and how far it is from all others; a reading that is far is none.
TEST_F(RecordingFolder, NumbersThatStandForNoReadingAreAbsent) {
  std::string dvl;
  for (int k = 0; k < kFixes; ++k) {
    const bool bad = k % 10 == 3;
    dvl += bad ? fmt::format("{}.0,-32.768,-32.768,-32.768\n", k)
               : fmt::format("{}.0,1.{},0.{},{}\n", k, k % 7, k % 3,
                             k % 12 == 5 ? 40.5 : 0.01 * (k % 5));
  }
  Write("imu.csv", RestingImu());
  Write("dvl.csv", "time,vx,vy,vz\n" + dvl);
  const std::string config = DraftText(DraftRecordings(folder_.string())[0]);
  EXPECT_THAT(config, HasSubstr("bad_values: [-32.768]"));
  Write("config.yaml", config);
  ASSERT_EQ(LoadError(), "") << config;
  const Dataset data = Load();
  ASSERT_EQ(data.streams.size(), 1u);
  EXPECT_EQ(data.streams[0].measurements.size(), 35u);
}

/// The zone is the file's; of which half of the Earth nothing tells.
TEST_F(RecordingFolder, EastingAndNorthingAreThoseOfUtm) {
  std::string fixes = "time,utm_zone,Easting,Northing,Ellip. Height\n";
  for (int k = 0; k < kFixes; ++k) {
    const Eigen::Vector3d p = UtmFromGeodetic(PlaceAt(k), {29, false});
    fixes +=
        fmt::format("{}.0,29,{:.4f},{:.4f},{:.4f}\n", k, p.x(), p.y(), p.z());
  }
  Write("imu.csv", RestingImu());
  Write("points.csv", fixes);
  std::string config = DraftText(DraftRecordings(folder_.string())[0]);
  EXPECT_THAT(config, HasSubstr("frame: utm"));
  EXPECT_THAT(config, HasSubstr("zone: 29"));
  EXPECT_THAT(config, HasSubstr("taken for the northern hemisphere's"));
  const std::string north = "hemisphere: north";
  const std::size_t at = config.find(north);
  ASSERT_NE(at, config.npos) << config;
  config.replace(at, north.size(), "hemisphere: south");
  Write("config.yaml", config);
  ASSERT_EQ(LoadError(), "") << config;
  const Dataset data = Load();
  const Measurement measured = data.streams[0].measurements[kFixes - 1];
  EXPECT_LT((std::get<PositionFix>(measured.model).p_e -
             EcefFromGeodetic(PlaceAt(kFixes - 1)))
                .norm(),
            0.001);
  Write("config.yaml",
        std::regex_replace(config, std::regex("zone: 29"), "zone: 61"));
  EXPECT_THAT(LoadError(), HasSubstr("expected a whole number from 1 to 60"));
  fixes += "39.0,29,686482.0,12000000.0,500\n";
  Write("points.csv", fixes);
  Write("config.yaml", config);
  EXPECT_THAT(LoadError(), HasSubstr("are in no zone of UTM"));
}

/// Rows of an IMU in which a reading is missing are left out.
TEST_F(RecordingFolder, RowsOfAnImuWithoutAReadingAreLeftOut) {
  std::string imu = RestingImu();
  const std::size_t row = imu.find("\n10.00,") + 1;
  imu.replace(row, imu.find('\n', row) - row, "10.00,0.001,--,0,0,0.01,-9.81");
  Write("imu.csv", imu);
  const std::string config = DraftText(DraftRecordings(folder_.string())[0]);
  EXPECT_THAT(config, HasSubstr("on_text: drop"));
  Write("config.yaml", config);
  ASSERT_EQ(LoadError(), "") << config;
  EXPECT_EQ(Load().imu.samples.size(), 4000u);
}

}  // namespace
}  // namespace hindsight
