#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "io/read/date_text.h"
#include "io/read/time_scale.h"
#include "io/sample_folder.h"

namespace hindsight {
namespace {

class SampleFormats : public SampleFolder {};

PositionFix Fix(const Dataset& data, std::size_t stream, std::size_t row) {
  return std::get<PositionFix>(data.streams[stream].measurements[row].model);
}

TEST_F(SampleFormats, EurocImuAndTruthInALocalFrame) {
  const Dataset data = LoadSample(
      "euroc", "  file: imu.csv\n  format: euroc\n  axes: [z, -y, x]\n",
      "truth:\n  file: truth.csv\n  format: euroc\n  frame: enu\n"
      "  origin: [47 deg, 8 deg, 400 m]\n  axes: [z, -y, x]\n");
  ASSERT_EQ(data.imu.samples.size(), 5u);
  EXPECT_EQ(data.imu.samples[3].gyro, Eigen::Vector3d(-0.03, -0.02, 0.03));
  EXPECT_EQ(data.imu.samples[3].accel, Eigen::Vector3d(-1.2, -0.1, 9.7));
  EXPECT_NEAR(data.imu.samples[2].t - data.imu.samples[1].t, 0.005000001,
              1e-12);
  // 1403636580 s of Unix time, 16 leap seconds behind GPS time.
  EXPECT_EQ(*data.epoch_gps_ns / 1'000'000'000,
            1403636580LL - 315964800LL + 16LL);
  ASSERT_EQ(data.truth.size(), 2u);
  const Eigen::Vector3d origin =
      EcefFromGeodetic({47 * kDegree, 8 * kDegree, 400});
  const Eigen::Vector3d ned =
      NedAxes(origin).transpose() * (*data.truth[0].p_e - origin);
  EXPECT_TRUE(ned.isApprox(Eigen::Vector3d(4, 3, -5), 1e-9));
  EXPECT_TRUE(data.truth[0].v_n->isApprox(Eigen::Vector3d(2, 1, 3), 1e-5));
  // Sensor x, y, z along east, north, up; body axes are its z, -y, x: body
  // forward is up, right is south, down is east.
  Eigen::Matrix3d C_nb;
  C_nb << 0, -1, 0, 0, 0, 1, -1, 0, 0;
  EXPECT_TRUE(data.truth[0].q_nb->toRotationMatrix().isApprox(C_nb, 1e-5));
}

TEST_F(SampleFormats, OxtsBecomesForwardRightDown) {
  const Dataset data =
      LoadSample("", "  file: oxts\n  format: oxts\n",
                 "aiding:\n  pos: {type: position, file: oxts, format: oxts, "
                 "accept_quality: [4]}\n"
                 "  vel: {type: velocity, file: oxts, format: oxts}\n"
                 "truth: {file: oxts, format: oxts}\n");
  ASSERT_EQ(data.imu.samples.size(), 3u);
  EXPECT_EQ(data.imu.samples[1].accel, Eigen::Vector3d(0.11, -0.12, -9.81));
  EXPECT_EQ(data.imu.samples[1].gyro, Eigen::Vector3d(0.31, -0.32, -0.33));
  EXPECT_NEAR(data.imu.samples[1].t - data.imu.samples[0].t, 0.1, 1e-9);
  EXPECT_EQ(*data.epoch_gps_ns,
            ParseDateTime("2011-09-26 13:02:25 UTC")->seconds * 1'000'000'000);
  ASSERT_EQ(data.streams[0].measurements.size(), 3u);
  const Geodetic g = GeodeticFromEcef(Fix(data, 0, 2).p_e);
  EXPECT_NEAR(g.latitude / kDegree, 49.015002, 1e-10);
  EXPECT_NEAR(g.height, 116.4, 1e-6);
  EXPECT_DOUBLE_EQ(Fix(data, 0, 2).R_n(2, 2), 0.05 * 0.05);
  EXPECT_EQ(Fix(data, 0, 2).quality, 4.0);
  EXPECT_EQ(Fix(data, 0, 2).satellites, 10.0);
  const auto v = std::get<VelocityFix>(data.streams[1].measurements[0].model);
  EXPECT_EQ(v.v_n, Eigen::Vector3d(3, 4, -0.7));
  EXPECT_DOUBLE_EQ(v.R_n(0, 0), 0.02 * 0.02);
  const Eigen::Vector3d euler = EulerFromQuaternion(*data.truth[0].q_nb);
  EXPECT_TRUE(
      euler.isApprox(Eigen::Vector3d(0.01, -0.02, 0.5 * kPi + 0.5), 1e-12));
}

TEST_F(SampleFormats, OxtsErrorsNameTheEpochsFile) {
  std::filesystem::copy(Sample("oxts"), Path("oxts"),
                        std::filesystem::copy_options::recursive);
  const std::string imu = "  file: oxts\n  format: oxts\n";
  Write("config.yaml",
        "imu:\n" + imu +
            "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n");
  Write("oxts/data/0000000001.txt", "1 2 3\n");
  EXPECT_EQ(LoadError(),
            "oxts/data/0000000001.txt:1: found 3 values, expected 30");
  std::filesystem::remove(Path("oxts/data/0000000001.txt"));
  EXPECT_EQ(LoadError(),
            "oxts/timestamps.txt:2: there is no file data/0000000001.txt for "
            "this stamp");
}

TEST_F(SampleFormats, OxtsFilesBeginWithZero) {
  std::filesystem::copy(Sample("oxts"), Path("oxts"),
                        std::filesystem::copy_options::recursive);
  Write("config.yaml",
        "imu:\n  file: oxts\n  format: oxts\n"
        "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n");
  const std::string stamps = Read("oxts/timestamps.txt");
  const std::string says =
      "oxts/timestamps.txt:1: there is no file data/0000000000.txt for this "
      "stamp";
  std::filesystem::remove(Path("oxts/data/0000000000.txt"));
  EXPECT_EQ(LoadError(), says);
  Write("oxts/timestamps.txt",
        stamps.substr(0, stamps.rfind('\n', stamps.size() - 2) + 1));
  EXPECT_EQ(LoadError(), says);
  Write("oxts/timestamps.txt",
        "\n" + stamps.substr(stamps.find('\n') + 1) + "\n\n");
  EXPECT_EQ(LoadError(), "");
  const Dataset data = Load();
  EXPECT_EQ(data.imu.samples.size(), 2u);
  EXPECT_EQ(data.imu.samples[0].accel, Eigen::Vector3d(0.11, -0.12, -9.81));
}

/// The peak of what `work` takes in a process of its own [MB], up to 255.
template <typename Work>
int GrowthOf(const Work& work) {
  const pid_t child = fork();
  if (child == 0) {
    struct rusage before = {};
    struct rusage after = {};
    getrusage(RUSAGE_SELF, &before);
    work();
    getrusage(RUSAGE_SELF, &after);
    const long grown = (after.ru_maxrss - before.ru_maxrss) / 1024;
    _exit(static_cast<int>(std::min(grown, 255L)));
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 255;
}

TEST_F(SampleFormats, EmptyLinesBetweenOxtsStampsTakeNoMemory) {
  std::filesystem::copy(Sample("oxts"), Path("oxts"),
                        std::filesystem::copy_options::recursive);
  Write("config.yaml",
        "imu:\n  file: oxts\n  format: oxts\n"
        "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n");
  WriteGzip("oxts/timestamps.txt", "2011-09-26 13:02:25.000000000\n" +
                                       std::string(8'000'000, '\n') +
                                       "2011-09-26 13:02:26.000000000\n");
  std::filesystem::remove(Path("oxts/data/0000000001.txt"));
  std::filesystem::remove(Path("oxts/data/0000000002.txt"));
  EXPECT_EQ(LoadError(),
            "oxts/timestamps.txt:8000002: there is no file "
            "data/0008000001.txt for this stamp");
  EXPECT_LT(GrowthOf([&] { LoadError(); }), 64);
}

TEST_F(SampleFormats, NcltMicrosecondsAndRadians) {
  const Dataset data = LoadSample(
      "nclt", "  file: ms25.csv\n  format: nclt\n",
      "aiding:\n"
      "  gps: {type: position, file: gps.csv, format: nclt, sigma: 2 m, "
      "accept_quality: [3]}\n"
      "  course: {type: speed_course, file: gps.csv, format: nclt, "
      "accept_quality: [3], sigma: 0.2 m/s, course_sigma: 2 deg}\n");
  EXPECT_EQ(data.imu.samples[2].gyro, Eigen::Vector3d(0.01, 0.02, 2.03));
  EXPECT_EQ(data.imu.samples[2].accel, Eigen::Vector3d(0.4, 0.5, -9.8));
  EXPECT_NEAR(data.imu.samples[2].t - data.imu.samples[0].t, 0.04, 1e-9);
  ASSERT_EQ(data.streams[0].measurements.size(), 2u);
  const Geodetic g = GeodeticFromEcef(Fix(data, 0, 0).p_e);
  EXPECT_NEAR(g.latitude, 0.738, 1e-12);
  EXPECT_NEAR(g.longitude, -1.46, 1e-12);
  const auto course =
      std::get<SpeedCourse>(data.streams[1].measurements[1].model);
  EXPECT_EQ(course.speed, 1.5);
  EXPECT_EQ(course.course, 0.6);
  // Without the mode, the row without a fix is an error.
  EXPECT_TRUE(SampleError("nclt", "  file: ms25.csv\n  format: nclt\n",
                          "aiding:\n  gps: {type: position, file: gps.csv, "
                          "format: nclt, sigma: 2 m}\n")
                  .find("gps.csv:1: column 4 (lat)") != std::string::npos);
}

TEST_F(SampleFormats, ControlPointsHaveOneSigma) {
  Write("imu.csv", kRestingImu);
  Write("points.txt", "# t lat lon h sigma\n0.01 59.5 5.25 -310.5 0.5\n");
  Write("config.yaml",
        "imu:\n  file: imu.csv\n"
        "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n"
        "aiding:\n  points: {type: position, file: points.txt, "
        "format: control_points}\n");
  const Dataset data = Load();
  EXPECT_TRUE(
      Fix(data, 0, 0).R_n.isApprox(0.25 * Eigen::Matrix3d::Identity(), 1e-15));
  EXPECT_NEAR(GeodeticFromEcef(Fix(data, 0, 0).p_e).height, -310.5, 1e-6);
}

}  // namespace
}  // namespace hindsight
