#include "io/init_config.h"

#include "io/recording_folder.h"

namespace hindsight {
namespace {

class InitConfigTest : public RecordingFolder {};

TEST_F(InitConfigTest, WhatItWritesLoads) {
  std::string imu =
      "t[s],dtheta_x[rad],dtheta_y[rad],dtheta_z[rad],dvel_x[m/s],dvel_y[m/s],"
      "dvel_z[m/s]\n";
  for (int i = 0; i < 100; ++i) {
    imu += std::to_string(0.01 * i) + ",0,0,0,0,0,-0.098\n";
  }
  WriteGzip("a.csv.gz", imu);
  Write("b.csv",
        "t[s],lat[deg],lon[deg],h[m],sigma_n[m],sigma_e[m],sigma_d[m]\n"
        "0,50,8,100,1,1,1\n1,50,8,100,1,1,1\n");
  Write("c.txt",
        "0.0 50 8 100 1 1 1\n0.5 50 8 100 1 1 1\n0.9 50 8 100 1 1 1\n");
  Write("d.csv", "t[s],roll[deg],pitch[deg],heading[deg]\n0,1,2,3\n1,1,2,3\n");
  Write("notes.md", "Nothing to read here.\n");
  const std::string config = InitConfig(folder_.string());
  EXPECT_NE(config.find("#   notes.md"), std::string::npos) << config;
  Write("config.yaml", config);
  EXPECT_EQ(LoadError(), "");
  const Dataset data = Load();
  EXPECT_EQ(data.imu.samples.size(), 100u);
  ASSERT_EQ(data.streams.size(), 2u);
  EXPECT_EQ(data.streams[0].measurements.size(), 2u);
  EXPECT_EQ(data.streams[1].measurements.size(), 3u);
  EXPECT_EQ(data.truth.size(), 2u);
}

TEST_F(InitConfigTest, MissingOrEmptyFolderIsAnError) {
  EXPECT_THROW(InitConfig(folder_.string()), InputError);
  EXPECT_THROW(InitConfig(Path("nowhere")), InputError);
}

}  // namespace
}  // namespace hindsight
