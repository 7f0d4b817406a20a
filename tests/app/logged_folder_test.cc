#include <gmock/gmock.h>

#include "app/disguised_folder.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

TEST_F(LoggedFolder, OfMessagesWithNamesOfFrames) {
  std::string imu =
      "%time,field.header.seq,field.header.stamp,field.header.frame_id,"
      "field.angular_velocity.x,field.angular_velocity.y,"
      "field.angular_velocity.z,field.angular_velocity_covariance0,"
      "field.linear_acceleration.x,field.linear_acceleration.y,"
      "field.linear_acceleration.z\n";
  const auto head = [](double t, std::size_t k, double late) {
    return fmt::format("{:.0f},{},{:.0f},link", 1e9 * (t + late), k, 1e9 * t);
  };
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    const Sample& s = samples_[k];
    imu += fmt::format("{},{:.9f},0.0,{:.9f}\n", head(s.t, k, 0.003),
                       fmt::join(s.gyro, ","), fmt::join(s.accel, ","));
  }
  WriteFile(file("imu.csv"), imu);
  std::string fixes =
      "%time,field.header.seq,field.header.stamp,field.header.frame_id,"
      "field.status.status,field.latitude,field.longitude,field.altitude\n";
  for (std::size_t k = 0; k < fixes_.size(); ++k) {
    const Fix& x = fixes_[k];
    fixes += fmt::format("{},0,{:.9f},{:.9f},{:.4f}\n", head(x.t, k, 0.2),
                         x.lat, x.lon, x.h);
  }
  WriteFile(file("fix.csv"), fixes);
  ExpectRight();
}

TEST_F(LoggedFolder, OfASpreadsheetWithDecimalCommas) {
  const auto write = [&](const char* name, const char* titles, auto values) {
    std::string text = titles;
    for (const Sample& s : samples_) {
      std::string row =
          fmt::format("{:.6f};{:.8f}\n", s.t, fmt::join(values(s), ";"));
      std::replace(row.begin(), row.end(), '.', ',');
      text += row;
    }
    WriteFile(file(name), text);
  };
  write("Accelerometer.csv",
        "\"Time (s)\";\"X (m/s^2)\";\"Y (m/s^2)\";\"Z (m/s^2)\"\n",
        [](const Sample& s) { return s.accel; });
  write("Gyroscope.csv",
        "\"Time (s)\";\"X (rad/s)\";\"Y (rad/s)\";\"Z (rad/s)\"\n",
        [](const Sample& s) { return s.gyro; });
  std::string fixes =
      "\"Time (s)\";\"Latitude (deg)\";\"Longitude (deg)\";\"Height (m)\"\n";
  for (const Fix& x : fixes_) {
    std::string row =
        fmt::format("{:.1f};{:.9f};{:.9f};{:.4f}\n", x.t, x.lat, x.lon, x.h);
    std::replace(row.begin(), row.end(), '.', ',');
    fixes += row;
  }
  WriteFile(file("Location.csv"), fixes);
  ExpectRight();
}

/// One file between tabs: a fix in some rows, in whole numbers, beside another
/// estimate's and other heights.
TEST_F(LoggedFolder, OfAnAutopilot) {
  std::string text =
      "time_ms\tmode\tGForceX\tGForceY\tGForceZ\tRoll rate\tPitch "
      "rate\tYaw rate\tbaro_alt\tekf_lat\tekf_lon\tgps_lat\tgps_lon\t"
      "gps_alt_msl\tgps_alt_ellipsoid\n";
  std::size_t next = 0;
  for (const Sample& s : samples_) {
    text += fmt::format("{:.0f}\tAUTO", 1e3 * s.t);
    for (const double f : s.accel) {
      text += fmt::format("\t{:.6f}", f / 9.80665);
    }
    for (const double w : s.gyro) {
      text += fmt::format("\t{:.5f}", w * 57.29577951308232);
    }
    text += "\t-1.5";
    // A stamp of its own is within half a row.
    if (next < fixes_.size() && fixes_[next].t <= s.t) {
      const Fix& x = fixes_[next++];
      text += fmt::format("\t{:.7f}\t{:.7f}\t{:.0f}\t{:.0f}\t{:.0f}\t{:.0f}",
                          x.lat + 1e-3, x.lon + 1e-3, 1e7 * x.lat, 1e7 * x.lon,
                          1e3 * (x.h - 46.0), 1e3 * x.h);
    } else {
      text += "\tNA\tNA\t\t\t\t";
    }
    text += "\n";
  }
  WriteFile(file("flight.txt"), text);
  ExpectRight();
}

/// One file whose rows are of several sensors, titled in comments, as apps for indoor
/// positioning write it.
TEST_F(LoggedFolder, OfRowsOfSeveralSensors) {
  std::string text =
      "% ACCE;AppTimestamp(s);Acc_X(m/s^2);Acc_Y(m/s^2);Acc_Z(m/s^2);Accuracy\n"
      "% GYRO;AppTimestamp(s);Gyr_X(rad/s);Gyr_Y(rad/s);Gyr_Z(rad/s);Accuracy\n"
      "% GNSS;AppTimestamp(s);Latit(deg);Long(deg);Altitude(m)\n";
  for (int k = 0; k < 5; ++k) text += fmt::format("WIFI;{};-60;7;5180\n", k);
  std::size_t next = 0;
  for (const Sample& s : samples_) {
    text += fmt::format("ACCE;{:.3f};{:.6f};3\nGYRO;{:.3f};{:.8f};3\n", s.t,
                        fmt::join(s.accel, ";"), s.t, fmt::join(s.gyro, ";"));
    if (next < fixes_.size() && fixes_[next].t <= s.t) {
      const Fix& x = fixes_[next++];
      text += fmt::format("GNSS;{:.3f};{:.9f};{:.9f};{:.3f}\n", x.t, x.lat,
                          x.lon, x.h);
    }
  }
  WriteFile(file("logfile.txt"), text);
  ExpectRight();
  EXPECT_THAT(Config(), HasSubstr("rows: {column: 1, word: \"GNSS\"}"));
  EXPECT_THAT(Config(), HasSubstr("#   logfile.txt, rows of WIFI\n"));
}

/// Times of whole seconds, as an American writes them.
TEST_F(LoggedFolder, OfWholeSecondsAfterNoon) {
  const auto stamp = [](double t) {
    const int s = static_cast<int>(t) + 51;
    return fmt::format("06/29/2025 {}:{:02}:{:02} PM", 7, 34 + s / 60, s % 60);
  };
  WriteImu("Timestamp", stamp);
  WriteFixes("Timestamp", [&](double t) { return stamp(t + 1e-3); });
  ExpectRight();
  EXPECT_THAT(Config(), HasSubstr("dates: month_first"));
  EXPECT_THAT(Config(),
              HasSubstr("rate: 100 Hz, start: 2025-06-29 19:35:09.0"));
}

/// Seconds of a GPS week that ends meanwhile, and a speed in km/h whose sign is
/// turned.
TEST_F(LoggedFolder, OfTheEndOfAWeekWithAWheel) {
  const auto stamp = [](double t) {
    const double second = 604700.0 + t;
    return second < 604800.0 ? fmt::format("2374,{:.3f}", second)
                             : fmt::format("2375,{:.3f}", second - 604800.0);
  };
  WriteImu("week,sow", stamp);
  WriteFixes("week,tow", stamp);
  std::string wheel = "week,sow,speed\n";
  const Table speeds = ReadTable(folder_.path() / "odometer.csv");
  for (std::size_t k = 1; k < speeds.size(); ++k) {
    wheel += fmt::format("{},{:.4f}\n", stamp(std::stod(speeds[k][0])),
                         -3.6 * std::stod(speeds[k][1]));
  }
  WriteFile(file("wheel.csv"), wheel);
  ExpectRight();
  EXPECT_THAT(Config(), HasSubstr("time: {week: 2374}"));
  EXPECT_THAT(Config(), HasSubstr("speed: \"-3 [km/h]\""));
}

/// Without titles: mg and mdps, and the longitude in rad before the latitude.
TEST_F(LoggedFolder, OfNumbersAlone) {
  constexpr double kMdps = 57295.77951308232;
  std::string imu;
  for (const Sample& s : samples_) {
    imu += fmt::format("{:.3f}", s.t);
    for (const double f : s.accel)
      imu += fmt::format(" {:.3f}", f / 9.80665e-3);
    for (const double w : s.gyro) imu += fmt::format(" {:.2f}", w * kMdps);
    imu += "\n";
  }
  WriteFile(file("imu.txt"), imu);
  std::string fixes;
  for (const Fix& x : fixes_) {
    fixes +=
        fmt::format("{:.3f} {:.12f} {:.12f} {:.3f}\n", x.t,
                    x.lon / 57.29577951308232, x.lat / 57.29577951308232, x.h);
  }
  WriteFile(file("gps.txt"), fixes);
  ExpectRight();
  EXPECT_THAT(Config(), HasSubstr("gyro_x: \"5 [mdeg/s]\""));
  EXPECT_THAT(Config(), HasSubstr("lat: \"3 [rad]\""));
}

/// Accelerometers that read -1 g along the axis that points up.
TEST_F(LoggedFolder, OfAPhoneThatCountsGravityDownwards) {
  std::string imu =
      "time,accelerometerAccelerationX(G),accelerometerAccelerationY(G),"
      "accelerometerAccelerationZ(G),gyroRotationX(rad/s),gyroRotationY(rad/s),"
      "gyroRotationZ(rad/s)\n";
  for (const Sample& s : samples_) {
    imu += fmt::format("{:.3f}", s.t);
    for (const double f : s.accel) imu += fmt::format(",{:.6f}", -f / 9.80665);
    imu += fmt::format(",{:.8f}\n", fmt::join(s.gyro, ","));
  }
  WriteFile(file("imu.csv"), imu);
  WriteFixes("time", [](double t) { return fmt::format("{:.3f}", t); });
  ExpectRight();
  EXPECT_THAT(Config(), HasSubstr("-1 g along the axis that points up"));
}

/// What nothing uses is said where it is run, and what takes its time.
TEST_F(LoggedFolder, WithMoreThanIsUsed) {
  std::string imu = "time,ax,ay,az,gx,gy,gz,temp\n";
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    imu += fmt::format("{:.3f},{:.6f},{:.8f},{}\n", samples_[k].t,
                       fmt::join(samples_[k].accel, ","),
                       fmt::join(samples_[k].gyro, ","), 20 + k % 5);
  }
  WriteFile(file("imu.csv"), imu);
  WriteFile(file("notes.md"), "by hand\n");
  WriteFixes("time", [](double t) { return fmt::format("{:.3f}", t); });
  const Outcome run = Hindsight(
      {"run", "data", "--yes", "--methods=rts", "--out=out", "--progress=json"},
      folder_.path());
  EXPECT_EQ(run.status, 0) << run.out << run.err;
  EXPECT_THAT(run.out, HasSubstr("\nnot recognised: notes.md\n"
                                 "not recognised: imu.csv, column temp\n"));
  EXPECT_THAT(run.err, HasSubstr("\"looking at data: clocks\""));
  EXPECT_THAT(Config(), HasSubstr("#   imu.csv, column temp\n"));
  const Outcome check = Hindsight({"check", "data"}, folder_.path());
  EXPECT_EQ(check.status, 2);
  EXPECT_THAT(check.err,
              HasSubstr("data: is a folder; expected a configuration: "
                        "'hindsight init data --out=CONFIG' drafts one"));
}

}  // namespace
}  // namespace hindsight
