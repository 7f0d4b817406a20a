#include "io/read/untitled_imu.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <string>

#include "base/units.h"
#include "io/config/init_config.h"
#include "io/recording_folder.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A vehicle on level ground that stands for five seconds and then turns to and
/// fro, as an IMU with a magnetometer writes it without titles. In gauss the length of
/// a vertical accelerometer and two axes of the field is that of gravity.
class LevelTurns : public RecordingFolder {
 protected:
  /// `order`: t, g(yros), a(ccelerometers), m(agnetometer), q(uaternion),
  /// s(low numbers within the ranges of places and heights).
  std::string Rows(const std::string& order) {
    std::string text;
    double heading = 0.3;
    for (int k = 0; k < 6000; ++k) {
      const double t = 0.01 * k;
      const double phase = std::max(0.0, t - 5.0);
      const double rate = 0.25 * std::sin(0.4 * phase);
      heading += 0.01 * rate;
      const double north = 0.2;
      std::string row;
      const auto add = [&](int digits, auto... values) {
        for (const double value : {static_cast<double>(values)...}) {
          row +=
              fmt::format("{}{:.{}f}", row.empty() ? "" : ",", value, digits);
        }
      };
      for (const char what : order) {
        if (what == 't') add(3, t);
        if (what == 'g') add(7, N(4e-4), N(4e-4), rate + N(4e-4));
        if (what == 'a') {
          add(6, 0.3 * std::sin(phase) + N(0.01), 2.0 * rate + N(0.01),
              kStandardGravity + N(0.01));
        }
        if (what == 'm') {
          add(6, north * std::cos(heading) + N(0.002),
              -north * std::sin(heading) + N(0.002), -0.42 + N(0.002));
        }
        if (what == 'q') {
          add(6, 0.0, 0.0, std::sin(0.5 * heading), std::cos(0.5 * heading));
        }
        if (what == 's') {
          add(6, 0.42 + 1e-5 * k, 0.9 - 1e-5 * k, 3.0 + 0.1 * std::sin(phase));
        }
      }
      text += row + "\n";
    }
    return text;
  }

  std::string Config() const {
    return DraftText(DraftRecordings(folder_.string()).at(0));
  }

  static std::string Fixes(const std::string& titles) {
    std::string text = titles;
    for (int k = 0; k < 60; ++k) {
      text += fmt::format(
          "{}.0,{:.7f},{:.7f},{:.2f}\n", k, 48.0 + 1e-4 * std::sin(0.1 * k),
          11.0 + 1e-4 * std::cos(0.1 * k), 500.0 + 0.1 * (k % 3));
    }
    return text;
  }

 private:
  double N(double sigma) {
    return sigma * std::normal_distribution<double>()(random_);
  }

  std::mt19937 random_{1};
};

TEST_F(LevelTurns, AMagnetometerInGaussIsNoAccelerometer) {
  struct Case {
    const char* order;
    int gyro;
    int accel;
    int mag;
  };
  for (const Case& one :
       {Case{"tgam", 2, 5, 8}, Case{"tagm", 5, 2, 8}, Case{"tmag", 8, 5, 2},
        Case{"tamg", 8, 2, 5}, Case{"tqgam", 6, 9, 12}}) {
    Write("imu.csv", Rows(one.order));
    const std::string config = Config();
    for (const auto& [name, first] : {std::pair("gyro", one.gyro),
                                      {"accel", one.accel},
                                      {"mag", one.mag}}) {
      for (int i = 0; i < 3; ++i) {
        EXPECT_THAT(config, HasSubstr(fmt::format("{}_{}: \"{} [", name,
                                                  "xyz"[i], first + i)))
            << one.order;
      }
    }
  }
}

TEST_F(LevelTurns, OtherColumnsOfTheImuAreNoSecondPosition) {
  Write("imu.csv", Rows("tgaqs"));
  Write("gps.csv", Fixes("time,lat,lon,alt\n"));
  const std::string config = Config();
  EXPECT_THAT(config, HasSubstr("lat: \"2 [deg]\""));
  EXPECT_THAT(config, Not(HasSubstr("position2:")));
  EXPECT_THAT(
      config,
      HasSubstr("# Not used: imu.csv: its numbers are within the ranges "
                "of places, but not where gps.csv was recorded"));
}

TEST_F(LevelTurns, NumbersThatNoTitleNamesAreNoPlacesFarFromAnothers) {
  // Without titles either file may be the one; the IMU's own is not.
  Write("imu.csv", Rows("tgas"));
  Write("gps.csv", Fixes(""));
  const std::string config = Config();
  EXPECT_THAT(config, HasSubstr("aiding:\n  position:\n    type: position\n"
                                "    file: gps.csv\n"));
  EXPECT_THAT(config, Not(HasSubstr("position2:")));
}

TEST_F(LevelTurns, PlacesBesideTheImuThatAgreeWithAnothersStay) {
  std::string with_places;
  int k = 0;
  for (const char c : Rows("tga")) {
    if (c != '\n') {
      with_places += c;
      continue;
    }
    with_places += fmt::format(",{:.7f},{:.7f},{:.2f}\n", 48.0 + 1e-7 * k,
                               11.0 + 2e-7 * k, 500.0 + 0.1 * (k % 3));
    ++k;
  }
  Write("imu.csv", with_places);
  Write("gps.csv", Fixes("time,lat,lon,alt\n"));
  EXPECT_THAT(Config(), HasSubstr("position2:"));
}

}  // namespace
}  // namespace hindsight
