#include <fmt/core.h>
#include <gmock/gmock.h>

#include "base/units.h"
#include "earth/wgs84.h"
#include "io/config/init_config.h"
#include "io/recording_folder.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

/// A track beside an IMU at rest, both of 2025-06-30 12:00:00 UTC.
class Gpx : public RecordingFolder {
 protected:
  Gpx() {
    std::string imu =
        "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],"
        "accel_x[m/s^2],accel_y[m/s^2],accel_z[m/s^2]\n";
    for (int k = 0; k <= 400; ++k) {
      imu += fmt::format("{:.2f},0.00{},0,0,0,0.0{},-9.81\n", 0.01 * k, k % 7,
                         k % 5);
    }
    Write("imu.csv", imu);
    Write("config.yaml",
          "epoch: 2025-06-30 12:00:00 UTC\nimu:\n  file: imu.csv\n  noise: "
          "{gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\naiding:\n  track:\n "
          "   type: position\n    file: track.gpx\n    format: gpx\n    sigma: "
          "[3, 3, 10 m]\n");
  }

  static std::string Point(int k, const std::string& inner) {
    return fmt::format("<trkpt lat=\"{:.7f}\" lon=\"-11.5\">{}</trkpt>\n",
                       -48.1 - 1e-5 * k, inner);
  }
  static std::string Time(int k) {
    return fmt::format("<time>2025-06-30T12:00:0{}.500Z</time>", k);
  }
  void WriteTrack(const std::string& points) const {
    Write("track.gpx",
          "<?xml version=\"1.0\"?>\n<gpx version=\"1.1\"><trk><trkseg>\n" +
              points + "</trkseg></trk></gpx>\n");
  }
};

TEST_F(Gpx, PointsAreFixesOfUtc) {
  WriteTrack(Point(0, "<ele>500.5</ele>" + Time(0)) +
             Point(1, "<ele>501</ele><extensions/>" + Time(1)) +
             Point(2, "<ele>502</ele>") + "</trkseg><trkseg>" +
             Point(3, "<ele>503</ele>" + Time(3)));
  ASSERT_EQ(LoadError(), "");
  const Dataset data = Load();
  const MeasurementSeries& z = data.streams[0].measurements;
  ASSERT_EQ(z.size(), 3u);
  const Measurement last = z[2];
  EXPECT_DOUBLE_EQ(last.t, 3.5);
  const Geodetic place =
      GeodeticFromEcef(std::get<PositionFix>(last.model).p_e);
  EXPECT_NEAR(place.latitude / kDegree, -48.10003, 1e-9);
  EXPECT_NEAR(place.longitude / kDegree, -11.5, 1e-9);
  EXPECT_NEAR(place.height, 503.0, 1e-6);
}

TEST_F(Gpx, IsFoundByItsName) {
  WriteTrack(Point(0, "<ele>500.5</ele>" + Time(0)) +
             Point(1, "<ele>501</ele>" + Time(1)));
  const auto drafts = DraftRecordings(folder_.string());
  ASSERT_EQ(drafts.size(), 1u);
  const std::string with_heights = DraftText(drafts[0]);
  EXPECT_THAT(with_heights, HasSubstr("format: gpx"));
  EXPECT_THAT(with_heights, HasSubstr("heights seem to count from the sea"));
  WriteTrack(Point(0, Time(0)) + Point(1, Time(1)));
  const std::string flat = DraftText(DraftRecordings(folder_.string())[0]);
  EXPECT_THAT(flat, HasSubstr("sigma: [3, 3, 1414 m]"));
}

TEST_F(Gpx, WithoutAnyHeightStandsAtZero) {
  WriteTrack(Point(0, Time(0)) + Point(1, Time(1)));
  ASSERT_EQ(LoadError(), "");
  const Dataset data = Load();
  const Measurement z = data.streams[0].measurements[0];
  EXPECT_NEAR(GeodeticFromEcef(std::get<PositionFix>(z.model).p_e).height, 0.0,
              1e-6);
}

TEST_F(Gpx, FaultsAreNamedByTheirLine) {
  const std::string good = Point(0, "<ele>1</ele>" + Time(0));
  const auto message = [&](const std::string& second) {
    WriteTrack(good + second);
    return LoadError();
  };
  EXPECT_THAT(message("<trkpt lat=\"48\" lon=\"11\""),
              HasSubstr("track.gpx:4: is not valid XML"));
  EXPECT_THAT(message("<trkpt lat=\"north\" lon=\"11\">" + Time(1) +
                      "<ele>1</ele></trkpt>"),
              HasSubstr("track.gpx:4: lat 'north' of a trkpt is not a number"));
  EXPECT_THAT(message("<trkpt lat=\"91\" lon=\"11\">" + Time(1) +
                      "<ele>1</ele></trkpt>"),
              HasSubstr("not a number up to 90"));
  EXPECT_THAT(message(Point(1, "<ele>1</ele><time>noon</time>")),
              HasSubstr("track.gpx:4: time 'noon' of a trkpt is none"));
  EXPECT_THAT(message(Point(1, Time(1))), HasSubstr("track.gpx"));
  Write("track.gpx", "<kml/>");
  EXPECT_THAT(LoadError(), HasSubstr("holds no <gpx>"));
  WriteTrack(Point(0, ""));
  EXPECT_THAT(LoadError(), HasSubstr("holds no trkpt with a time"));
}

}  // namespace
}  // namespace hindsight
