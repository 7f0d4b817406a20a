#include "io/sample_folder.h"

namespace hindsight {
namespace {

/// The first YAML block of README.md with this text in it.
std::string BlockWith(const std::string& readme, const std::string& text) {
  const std::string open = "```yaml\n";
  for (std::size_t at = readme.find(open); at != std::string::npos;
       at = readme.find(open, at + 1)) {
    const std::size_t begin = at + open.size();
    const std::string block =
        readme.substr(begin, readme.find("```", begin) - begin);
    if (block.find(text) != std::string::npos) return block;
  }
  return "";
}

class Readme : public SampleFolder {
 protected:
  static std::string Text() {
    std::ifstream in(std::string(HINDSIGHT_SOURCE_DIR) + "/README.md");
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(Readme, EveryKeyOfTheUnderWaterSensorsLoads) {
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
        "imu:\n  file: imu.csv\n"
        "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n" +
            BlockWith(Text(), "type: acoustic"));
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
