#include "io/sample_folder.h"

namespace hindsight {
namespace {

/// The first YAML block of a page with this text in it.
std::string BlockWith(const std::string& page, const std::string& text) {
  std::ifstream in(std::string(HINDSIGHT_SOURCE_DIR) + "/" + page);
  const std::string all(std::istreambuf_iterator<char>(in), {});
  const std::string open = "```yaml\n";
  for (std::size_t at = all.find(open); at != std::string::npos;
       at = all.find(open, at + 1)) {
    const std::size_t begin = at + open.size();
    const std::string block = all.substr(begin, all.find("```", begin) - begin);
    if (block.find(text) != std::string::npos) return block;
  }
  ADD_FAILURE() << page << " has no block with " << text;
  return "";
}

constexpr const char* kSomeImu =
    "imu:\n  file: imu.csv\n"
    "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n";

class Documentation : public SampleFolder {};

TEST_F(Documentation, TheConfigurationOfTheReadmeLoads) {
  std::filesystem::create_directory(Path("recording"));
  Write("recording/imu.csv", kRestingImu);
  Write("recording/gnss.pos",
        "%  GPST  latitude(deg) longitude(deg) height(m)   Q  ns   sdn(m)   "
        "sde(m)   sdu(m)  sdne(m)  sdeu(m)  sdun(m) age(s)  ratio\n"
        "2025/07/08 19:34:00.010 40 -105 1600 1 9 0.03 0.04 0.05 0 0 0 0 0\n");
  Write("config.yaml", BlockWith("README.md", "rtklib_pos"));
  EXPECT_EQ(LoadError(), "");
  const Dataset data = Load();
  ASSERT_EQ(data.streams.size(), 1u);
  EXPECT_DOUBLE_EQ(data.streams[0].measurements[0].t, 0.01);
  EXPECT_EQ(data.streams[0].sensor.lever_arm_b, Eigen::Vector3d(0.3, 0, -1.2));
  EXPECT_EQ(data.withholdings.size(), 1u);
}

TEST_F(Documentation, TheWheelsOfAVehicleLoad) {
  Write("imu.csv", kRestingImu);
  Write("config.yaml", kSomeImu + ("aiding:\n" + BlockWith("docs/sensors.md",
                                                           "non_holonomic")));
  EXPECT_EQ(LoadError(), "");
}

TEST_F(Documentation, EachNoiseOfAPositionLoads) {
  Write("imu.csv", kRestingImu);
  Write("fix.csv",
        "t[s],lat[deg],lon[deg],h[m],sigma_n[m],sigma_e[m],sigma_d[m]\n"
        "0.01,35,129,0,1,1,1\n");
  std::istringstream lines(BlockWith("docs/methods.md", "gauss_markov"));
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    Write("config.yaml",
          kSomeImu +
              ("aiding:\n  gnss:\n    type: position\n    file: fix.csv\n" +
               line + "\n"));
    EXPECT_EQ(LoadError(), "") << line;
  }
  EXPECT_EQ(count, 2);
}

TEST_F(Documentation, EveryKeyOfTheUnderWaterSensorsLoads) {
  Write("imu.csv", kRestingImu);
  Write("log.csv", "t[s],v_x[m/s],v_y[m/s],v_z[m/s],water[1]\n0.01,1,2,3,1\n");
  Write("janus.csv",
        "t[s],beam_1[m/s],beam_2[m/s],beam_3[m/s],beam_4[m/s],valid_1[1]\n"
        "0.01,1,2,,nan,0\n");
  Write("depth.csv", "t[s],depth[m],sigma_depth[m]\n0.01,5,0.1\n");
  Write("beacon.csv",
        "t[s],range[m],azimuth[deg],depression[deg]\n0.01,99,10,20\n");
  Write("fix.csv",
        "t[s],lat[deg],lon[deg],h[m],sigma_n[m],sigma_e[m],sigma_d[m]\n"
        "0.01,35,129,0,1,1,1\n");
  Write("config.yaml",
        kSomeImu + BlockWith("docs/sensors.md", "type: acoustic"));
  EXPECT_EQ(LoadError(), "");
  const Dataset data = Load();
  ASSERT_EQ(data.streams.size(), 5u);
  const auto rows = [&](std::size_t i) {
    return Rows(data.streams[i].measurements[0]);
  };
  EXPECT_EQ(rows(0), 3);
  EXPECT_TRUE(std::get<Dvl>(data.streams[0].measurements[0].model).water);
  EXPECT_EQ(rows(1), 1);
  EXPECT_EQ(rows(3), 3);
  EXPECT_EQ(data.streams[2].sensor.offset_sigma, 0.3);
}

}  // namespace
}  // namespace hindsight
