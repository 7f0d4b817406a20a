#include "io/config/config.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "io/recording_folder.h"

namespace hindsight {
namespace {

constexpr const char* kImu =
    "t[s],gyro_x[deg/s],gyro_y[deg/s],gyro_z[deg/s],accel_x[g],accel_y[g],"
    "accel_z[g]\n"
    "10.0,1,2,3,0.1,0.2,1\n"
    "10.1,1,2,3,0.1,0.2,1\n"
    "10.2,1,2,3,0.1,0.2,1\n"
    "10.3,4,5,6,0.1,0.2,1\n";
constexpr const char* kGnss =
    "t[s],lat[deg],lon[deg],h[m],sigma_n[m],sigma_e[m],sigma_d[m]\n"
    "10.0,50,8,100,0.1,0.1,0.2\n"
    "10.2,50,8,100,0.1,0.1,0.2\n";
constexpr const char* kConfig =
    "imu:\n"                             // 1
    "  file: imu.csv\n"                  // 2
    "  axes: [x, -y, -z]\n"              // 3
    "  noise:\n"                         // 4
    "    gyro: 0.2 deg/sqrt(h)\n"        // 5
    "    accel: 70 ug/sqrt(Hz)\n"        // 6
    "aiding:\n"                          // 7
    "  gnss:\n"                          // 8
    "    type: position\n"               // 9
    "    file: gnss.csv\n"               // 10
    "    lever_arm: [0, 0.5, -1.1 m]\n"  // 11
    "    gate: 99.9 %\n";                // 12

class ConfigTest : public RecordingFolder {
 protected:
  ConfigTest() {
    Write("imu.csv", kImu);
    Write("gnss.csv", kGnss);
    Write("config.yaml", kConfig);
  }
};

TEST_F(ConfigTest, LoadsWhatItSays) {
  const Dataset data = Load();
  EXPECT_EQ(data.name, "config");
  EXPECT_FALSE(data.epoch_gps_ns);
  ASSERT_EQ(data.imu.samples.size(), 4u);
  EXPECT_EQ(data.imu.kind, ImuStream::Kind::kRates);
  EXPECT_DOUBLE_EQ(data.imu.t_begin(), 10.0);
  const ImuSample& last = data.imu.samples.back();
  EXPECT_TRUE(last.gyro.isApprox(Eigen::Vector3d(4, -5, -6) * kDegree, 1e-14));
  EXPECT_TRUE(last.accel.isApprox(
      Eigen::Vector3d(0.1, -0.2, -1) * kStandardGravity, 1e-14));
  EXPECT_NEAR(data.imu.noise.gyro_noise_density, 0.2 * kDegreePerSqrtHour,
              1e-18);
  ASSERT_EQ(data.streams.size(), 1u);
  const AidingStream& gnss = data.streams[0];
  EXPECT_EQ(gnss.sensor.name, "gnss");
  EXPECT_EQ(gnss.sensor.lever_arm_b, Eigen::Vector3d(0, 0.5, -1.1));
  EXPECT_DOUBLE_EQ(gnss.sensor.gate_probability.value(), 0.999);
  ASSERT_EQ(gnss.measurements.size(), 2u);
  const auto fix = std::get<PositionFix>(gnss.measurements[1].model);
  const Geodetic g = GeodeticFromEcef(fix.p_e);
  EXPECT_NEAR(g.latitude / kDegree, 50.0, 1e-10);
  EXPECT_NEAR(g.height, 100.0, 1e-6);
  EXPECT_DOUBLE_EQ(fix.R_n(2, 2), 0.2 * 0.2);
}

TEST_F(ConfigTest, OnAndOffAreBooleansOfYaml11) {
  for (const auto& [word, enabled] : {std::pair("off", false),
                                      {"false", false},
                                      {"no", false},
                                      {"on", true},
                                      {"true", true},
                                      {"yes", true}}) {
    Write("config.yaml", std::string(kConfig) + "stationary: " + word + "\n");
    EXPECT_EQ(Load().stationary.enabled, enabled) << word;
  }
  Write("config.yaml", std::string(kConfig) + "stationary: maybe\n");
  EXPECT_NE(LoadError().find("'maybe' is not known; expected one of off, on"),
            std::string::npos);
}

TEST_F(ConfigTest, ASecondDocumentIsRefused) {
  Write("config.yaml", std::string(kConfig) + "---\nname: other\n");
  EXPECT_NE(LoadError().find("config.yaml:13: a second YAML document begins"),
            std::string::npos)
      << LoadError();
  Write("config.yaml", "---\n" + std::string(kConfig));
  EXPECT_EQ(LoadError(), "");
}

TEST_F(ConfigTest, ATokenThatBeginsNothingEndsTheReading) {
  Write("config.yaml", ",+\n\n3");
  EXPECT_NE(LoadError().find("expected keys and values at the top level"),
            std::string::npos)
      << LoadError();
}

TEST_F(ConfigTest, CellsInQuotationMarksAreThoseWithin) {
  const auto quoted = [](const char* last) {
    return std::string("t[s],lat[deg],lon[deg],h[m]\n") +
           "10.0,\"50\",\"8\",\"100\"\n10.2,\"50\",\"8\"," + last + "\n";
  };
  std::string config = kConfig;
  config += "    sigma: 1 m\n";
  Write("config.yaml", config);
  Write("gnss.csv", quoted("\"100\""));
  EXPECT_EQ(Load().streams[0].measurements.size(), 2u);
  Write("gnss.csv", quoted("\"100"));
  EXPECT_NE(LoadError().find("gnss.csv:3: column 4 (h): '\"100' is not a "
                             "finite number"),
            std::string::npos)
      << LoadError();
}

TEST_F(ConfigTest, DecimalCommasAreReadAsPoints) {
  std::string semicolons = kGnss;
  std::replace(semicolons.begin(), semicolons.end(), ',', ';');
  std::replace(semicolons.begin(), semicolons.end(), '.', ',');
  const Dataset points = Load();
  Write("gnss.csv", semicolons);
  const Dataset commas = Load();
  ASSERT_EQ(commas.streams[0].measurements.size(), 2u);
  EXPECT_EQ(std::get<PositionFix>(commas.streams[0].measurements[1].model).R_n,
            std::get<PositionFix>(points.streams[0].measurements[1].model).R_n);
  EXPECT_EQ(commas.streams[0].measurements[1].t,
            points.streams[0].measurements[1].t);
  // The first row decides.
  Write("gnss.csv",
        "t[s];lat[deg];lon[deg];h[m];sigma_n[m];sigma_e[m];sigma_d[m]\n"
        "10;50;8;100;1;1;1\n"
        "11;50;8;100,5;1;1;1\n");
  EXPECT_NE(LoadError().find("'100,5' is not a finite number; decimal commas "
                             "are read with `decimal: comma`"),
            std::string::npos)
      << LoadError();
  std::string config = kConfig;
  config.replace(config.find("    file: gnss.csv\n"), 0,
                 "    decimal: comma\n");
  Write("config.yaml", config);
  EXPECT_EQ(LoadError(), "");
}

TEST_F(ConfigTest, FoldersAreSoughtBelowADataRootOnlyIfThereIsOne) {
  std::filesystem::create_directories(Path("root/drive"));
  for (const char* file : {"imu.csv", "gnss.csv"}) {
    std::filesystem::rename(Path(file),
                            Path("root/drive/" + std::string(file)));
  }
  Write("config.yaml", "folder: drive\n" + std::string(kConfig));
  EXPECT_EQ(LoadError(),
            "config.yaml:1: folder: there is no folder drive; "
            "--data-root=DIR looks for it in DIR too");
  EXPECT_EQ(LoadDataset(Path("config.yaml"), {.data_root = Path("root")})
                .streams.size(),
            1u);
}

TEST_F(ConfigTest, NoiseIsLikeThatOfAKnownDeviceWhereNothingElseIsSaid) {
  Write("config.yaml", ReplacedOnce(kConfig, "    gyro: 0.2 deg/sqrt(h)\n",
                                    "    like: MTi-300\n"));
  const ImuNoise noise = Load().imu.noise;
  EXPECT_NEAR(noise.gyro_noise_density, 0.01 * kDegree, 1e-12);
  EXPECT_NEAR(noise.accel_noise_density, 70.0 * kMicroG, 1e-12);
  EXPECT_NEAR(noise.gyro_bias_walk, 2e-5 * kDegree, 1e-12);
}

TEST_F(ConfigTest, MountingTurnsAfterAxes) {
  Write("config.yaml", ReplacedOnce(kConfig, "  noise:",
                                    "  mounting: [0, 0, 90 deg]\n  noise:"));
  // Heading 90 deg: body x' = -y, y' = x of the axes' result.
  EXPECT_TRUE(Load().imu.samples[0].gyro.isApprox(
      Eigen::Vector3d(2, 1, -3) * kDegree, 1e-12));
}

TEST_F(ConfigTest, ResolvedCopyLoadsTheSameDataSet) {
  ResolvedConfig first;
  const Dataset a = Load(&first);
  WriteResolvedConfig(first, Path("config.yaml"));
  ResolvedConfig second;
  const Dataset b = Load(&second);
  ASSERT_EQ(a.imu.samples.size(), b.imu.samples.size());
  for (std::size_t i = 0; i < a.imu.samples.size(); ++i) {
    EXPECT_EQ(a.imu.samples[i].gyro, b.imu.samples[i].gyro);
  }
  EXPECT_EQ(a.imu.noise.accel_noise_density, b.imu.noise.accel_noise_density);
  EXPECT_EQ(a.streams[0].sensor.gate_probability,
            b.streams[0].sensor.gate_probability);
  EXPECT_EQ(first.yaml, second.yaml);
  EXPECT_NE(first.yaml.find("max_spacing: 1 s"), std::string::npos);
}

TEST_F(ConfigTest, ByteOrderMarkAndCarriageReturnsAreRead) {
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : std::string(kImu)) {
    if (c == '\n') windows += '\r';
    windows += c;
  }
  Write("imu.csv", windows);
  EXPECT_EQ(Load().imu.samples.size(), 4u);
}

TEST_F(ConfigTest, LastLineWithoutLineFeedIsRead) {
  std::string text = kImu;
  text.pop_back();
  Write("imu.csv", text);
  EXPECT_EQ(Load().imu.samples.size(), 4u);
}

TEST_F(ConfigTest, LastValueCutShortIsRefused) {
  const std::string rows =
      "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],accel_x[m/s^2],"
      "accel_y[m/s^2],accel_z[m/s^2]\n"
      "10.0,1,2,3,4,5,-9.81\n10.1,1,2,3,4,5,-9.80\n10.2,1,2,3,4,5,";
  for (const std::string whole : {"-9.81", "-9.8\n", "-19.8125"}) {
    Write("imu.csv", rows + whole);
    EXPECT_EQ(Load().imu.samples.size(), 3u) << whole;
  }
  for (const std::string cut : {"-9.8", "-9", "-9.\r"}) {
    Write("imu.csv", rows + cut);
    const std::string error = LoadError();
    EXPECT_TRUE(error.starts_with("imu.csv:4: ")) << error;
    EXPECT_NE(error.find("truncated"), std::string::npos) << error;
    EXPECT_NE(error.find("accel_z"), std::string::npos) << error;
  }
  Write("config.yaml", ReplacedOnce(kConfig, "  noise:",
                                    "  allow_truncated_tail: true\n  noise:"));
  EXPECT_EQ(Load().imu.samples.size(), 2u);
}

TEST_F(ConfigTest, PoliciesAreCounted) {
  Write("imu.csv", ReplacedOnce(kImu, "10.2,", "10.1,") + "10.4,1,2");
  Write("config.yaml", ReplacedOnce(kConfig, "  noise:",
                                    "  on_duplicate: drop_first\n"
                                    "  allow_truncated_tail: true\n  noise:"));
  const Dataset data = Load();
  EXPECT_EQ(data.imu.samples.size(), 3u);
  ASSERT_EQ(data.policies.size(), 2u);
  EXPECT_EQ(data.policies[0].action, "first of duplicate stamps dropped");
  EXPECT_EQ(data.policies[0].count, 1);
  EXPECT_EQ(data.policies[1].action, "truncated last line dropped");
}

TEST_F(ConfigTest, DeclaredGapIsBridged) {
  Write("imu.csv", ReplacedOnce(kImu, "10.3,", "11.3,"));
  Write("config.yaml",
        ReplacedOnce(kConfig, "  noise:", "  max_gap: 2 s\n  noise:"));
  const Dataset data = Load();
  ASSERT_EQ(data.policies.size(), 1u);
  EXPECT_EQ(data.policies[0].action, "gap bridged");
  EXPECT_EQ(data.imu.max_gap, 2.0);
}

struct BadConfig {
  const char* from;
  const char* to;
  const char* place;
  const char* says;
};

TEST_F(ConfigTest, BadConfigurationNamesLineAndReason) {
  const BadConfig cases[] = {
      {"gate:", "gat:", "config.yaml:12: ", "perhaps 'gate'"},
      {"    gate: 99.9 %", "    type: height", "config.yaml:12: ", "twice"},
      {"0.2 deg/sqrt(h)", "0.2", "config.yaml:5: imu.noise.gyro: ", "no unit"},
      {"    gyro: 0.2 deg/sqrt(h)\n", "", "config.yaml:4: imu.noise.gyro: ",
       "is missing; expected it, or `like` one of ADIS16448,"},
      {"    gyro:", "    like: MTi\n    gyro:",
       "config.yaml:5: imu.noise.like: ", "'MTi' is not known; expected"},
      {"0.2 deg/sqrt(h)", "0.2 deg/h", "config.yaml:5: ", "deg/sqrt(h)"},
      {"0.2 deg/sqrt(h)", "0 deg/sqrt(h)", "config.yaml:5: ", "greater"},
      {"0.2 deg/sqrt(h)", "-1 deg/sqrt(h)", "config.yaml:5: ", "greater"},
      {"[x, -y, -z]", "[x, y, -z]", "config.yaml:3: ", "right-handed"},
      {"imu.csv", "lost.csv", "config.yaml:2: imu.file: ", "lost.csv"},
      {"99.9 %", "2", "config.yaml:12: ", "between 0 and 1"},
      {"position", "positon", "config.yaml:9: ", "velocity"},
      {"-1.1 m]", "m]", "config.yaml:11: ", "number"},
      {"gate: 99.9 %", "sigma: 0 m", "config.yaml:12: ", "greater"},
      {"aiding:", "folder: nowhere\naiding:", "config.yaml:7: ", "--data-root"},
      {"aiding:", "withhold: [{sensor: dvl, every: 9 s, length: 1 s}]\naiding:",
       "config.yaml:7: ", "'dvl'"},
      {"gate: 99.9 %", "gate: [", "config.yaml:13: ", "YAML"},
      {"aiding:", "initial: {time: 9 s}\naiding:",
       "config.yaml:7: initial.time: ", "10.000 to 10.300 s"},
      {"aiding:", "initial: {time: 11 s}\naiding:",
       "config.yaml:7: initial.time: ", "10.000 to 10.300 s"},
      {"aiding:", "initial: {attitude: [0, 0, 500 deg]}\naiding:",
       "config.yaml:7: initial.attitude: ", "-360 to 360 deg"},
      {"aiding:", "initial: {attitude: [0, 0, 5 m]}\naiding:",
       "config.yaml:7: initial.attitude: ", "not one of an angle"},
      {"gnss:", "\"gnss,b\":", "config.yaml:8: aiding.gnss,b: ", "letters"},
      {"gnss:", "\"gn\\nss\":", "config.yaml:8: aiding.gn?ss: ", "letters"},
      {"gnss:", "\"gn/ss\":", "config.yaml:8: aiding.gn/ss: ", "letters"},
      {"gnss:", "\"\":", "config.yaml:8: aiding.: ", "letters"},
  };
  for (const BadConfig& c : cases) {
    SCOPED_TRACE(c.to);
    Write("config.yaml", ReplacedOnce(kConfig, c.from, c.to));
    std::string error = LoadError();
    EXPECT_TRUE(error.starts_with(c.place)) << error;
    EXPECT_NE(error.find(c.says), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

TEST_F(ConfigTest, StartAndClockComeFromTheTruth) {
  // Turns to the right by 0.2 rad a second from t = 20 s on for 5 s, and back.
  std::string imu =
      "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],"
      "accel_x[g],accel_y[g],accel_z[g]\n";
  const auto rate = [](double t) {
    return t < 20.0 || t > 30.0 ? 0.0 : t < 25.0 ? 0.2 : -0.2;
  };
  const auto heading = [](double t) {
    return 0.2 * (t < 25.0 ? std::max(t - 20.0, 0.0) : std::max(30.0 - t, 0.0));
  };
  for (double t = 10.005; t < 40.0; t += 0.01) {
    imu += std::to_string(t) + ",0,0," + std::to_string(rate(t)) + ",0,0,-1\n";
  }
  std::string truth =
      "t[s],lat[deg],lon[deg],h[m],v_n[m/s],v_e[m/s],v_d[m/s],roll[rad],"
      "pitch[rad],heading[rad]\n";
  for (int k = 10; k < 40; ++k) {
    truth += std::to_string(k) + ",50,8,100,1,2,3,0,0," +
             std::to_string(heading(k + 0.4)) + "\n";
  }
  Write("imu.csv", imu);
  Write("truth.csv", truth);
  std::string config = ReplacedOnce(kConfig, "  axes: [x, -y, -z]\n", "") +
                       "    time_offset: truth\n"
                       "initial: {from: truth}\n"
                       "truth: {file: truth.csv, time_offset: unknown}\n";
  Write("config.yaml", config);
  ResolvedConfig resolved;
  const Dataset data = Load(&resolved);
  EXPECT_NEAR(data.streams[0].sensor.time_offset, 0.4, 0.01);
  EXPECT_NEAR(data.truth.front().t, 10.4, 0.01);
  EXPECT_EQ(data.initial.t, data.truth.front().t);
  EXPECT_EQ(*data.initial.v_n, Eigen::Vector3d(1.0, 2.0, 3.0));
  Write("config.yaml", resolved.yaml);
  EXPECT_EQ(Load().streams[0].sensor.time_offset,
            data.streams[0].sensor.time_offset);
  EXPECT_EQ(Load().initial.t, data.initial.t);

  // Nothing turns.
  config.replace(config.find("truth.csv"), 9, "still.csv");
  Write("still.csv", "t[s],lat[deg],lon[deg],h[m]\n10,50,8,100\n11,50,8,100\n");
  Write("config.yaml", config);
  EXPECT_NE(LoadError().find("truth.time_offset: is not found"),
            std::string::npos)
      << LoadError();
  Write("config.yaml", std::string(kConfig) + "initial: {from: truth}\n");
  EXPECT_NE(LoadError().find("initial.from: there is no truth"),
            std::string::npos)
      << LoadError();
  Write("config.yaml", std::string(kConfig) + "    time_offset: truth\n");
  EXPECT_NE(LoadError().find("gnss.time_offset: there is no truth"),
            std::string::npos)
      << LoadError();
}

struct BadFile {
  const char* from;
  const char* to;
  const char* place;
  const char* says;
};

TEST_F(ConfigTest, BadImuFileNamesLineAndReason) {
  const BadFile cases[] = {
      {"10.2,1", "10.2,nan", "imu.csv:4: ", "gyro_x"},
      {"10.2,1", "10.2,inf", "imu.csv:4: ", "finite"},
      {"10.2,1", "10.2,abc", "imu.csv:4: ", "'abc'"},
      {"10.2,1", "10.2,", "imu.csv:4: ", "finite"},
      {"10.2,1,2", "10.2,1", "imu.csv:4: ", "found 6 columns, expected 7"},
      {"10.2,1,2", "10.2,1,2,2", "imu.csv:4: ", "found 8 columns"},
      {"10.2,", "9.9,", "imu.csv:4: ", "backwards"},
      {"10.2,", "10.1,", "imu.csv:4: ", "on_duplicate"},
      {"10.3,", "14.3,", "imu.csv:5: ", "gap of 4.100 s"},
      {"10.3,4,5,6,0.1,0.2,1\n", "10.3,4,5", "imu.csv:5: ", "truncated"},
      {"10.2,", "x,", "imu.csv:4: ", "not a time"},
      {"accel_z[g]", "accel_z", "imu.csv:1: ", "no unit"},
      {"accel_z[g]", "accel_z[deg]", "imu.csv:1: ", "m/s^2"},
      {"accel_z[g]", "accel_x[g]", "imu.csv:1: ", "twice"},
      {"accel_z[g]", "acc_z[g]", "imu.csv: ", "accel_z"},
      {"t[s]", "time", "imu.csv:1: ", "no column t"},
  };
  for (const BadFile& c : cases) {
    SCOPED_TRACE(c.to);
    Write("imu.csv", ReplacedOnce(kImu, c.from, c.to));
    const std::string error = LoadError();
    EXPECT_TRUE(error.starts_with(c.place)) << error;
    EXPECT_NE(error.find(c.says), std::string::npos) << error;
  }
}

TEST_F(ConfigTest, BadAidingFileNamesLineAndReason) {
  const BadFile cases[] = {
      {"10.2,50,8,100,0.1", "10.2,50,8,100,0", "gnss.csv:3: ", "sigma_n"},
      {"10.2,50,8,100,0.1", "10.2,50,8,100,-1", "gnss.csv:3: ", "positive"},
      {"10.2,50", "10.2,95", "gnss.csv:3: ", "latitude"},
      {"sigma_d[m]", "sd[m]", "config.yaml:10: ", "sigma_d"},
  };
  for (const BadFile& c : cases) {
    SCOPED_TRACE(c.to);
    Write("gnss.csv", ReplacedOnce(kGnss, c.from, c.to));
    const std::string error = LoadError();
    EXPECT_TRUE(error.starts_with(c.place)) << error;
    EXPECT_NE(error.find(c.says), std::string::npos) << error;
  }
}

TEST_F(ConfigTest, StreamsThatDoNotOverlapSayBothSpans) {
  Write("gnss.csv",
        ReplacedOnce(ReplacedOnce(kGnss, "10.0,", "20.0,"), "10.2,", "20.2,"));
  const std::string error = LoadError();
  EXPECT_TRUE(error.starts_with("config.yaml:10: aiding.gnss")) << error;
  EXPECT_NE(error.find("20.000 to 20.200 s"), std::string::npos) << error;
  EXPECT_NE(error.find("10.000 to 10.300 s"), std::string::npos) << error;
}

TEST_F(ConfigTest, EmptyFilesAreNamed) {
  Write("imu.csv", "");
  EXPECT_EQ(LoadError(), "imu.csv: the file is empty");
  Write("imu.csv", "t[s],gyro_x[deg/s]\n");
  EXPECT_EQ(LoadError(), "imu.csv: the file holds no rows of data");
}

TEST_F(ConfigTest, GzipIsReadAndDamageIsNamed) {
  std::string text =
      "t[s],gyro_x[deg/s],gyro_y[deg/s],gyro_z[deg/s],"
      "accel_x[g],accel_y[g],accel_z[g]\n";
  for (int i = 0; i < 3000; ++i) {
    text += std::to_string(10.0 + 0.01 * i) + "," +
            std::to_string(std::sin(i * 1.7)) + ",2,3,0.1,0.2,1\n";
  }
  WriteGzip("imu.csv", text);
  EXPECT_EQ(Load().imu.samples.size(), 3000u);
  const std::string good = Read("imu.csv");
  Write("imu.csv", good.substr(0, good.size() / 2));
  EXPECT_NE(LoadError().find("imu.csv: is cut off"), std::string::npos);
  std::string damaged = good;
  damaged[good.size() / 2] = static_cast<char>(damaged[good.size() / 2] ^ 0x55);
  Write("imu.csv", damaged);
  EXPECT_FALSE(LoadError().empty());
}

}  // namespace
}  // namespace hindsight
