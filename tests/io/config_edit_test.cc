#include "io/config/config_edit.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace hindsight {
namespace {

constexpr char kText[] = R"yaml(# a car
imu:
  noise:                 # of its data sheet
    gyro: 0.1 deg/s/sqrt(Hz)   # white
    accel: "5 mg/sqrt(Hz)"
aiding:
  gnss: {type: position, sigma: [0.5 m, 0.5 m, 1 m], every: 1 s}
  # of both wheels
  wheel:
    type: odometer
    noise: {model: gauss_markov, sigma: 2 m, tau: 60 s}
)yaml";

TEST(ConfigEdit, ExchangesValuesAndLeavesAllElse) {
  ConfigEdit edit(kText, "config.yaml");
  EXPECT_EQ(edit.Value({"imu", "noise", "gyro"}), "0.1 deg/s/sqrt(Hz)");
  EXPECT_EQ(edit.Value({"imu", "noise", "accel"}), "5 mg/sqrt(Hz)");
  EXPECT_EQ(edit.Value({"aiding", "gnss", "sigma"}), "[0.5 m, 0.5 m, 1 m]");
  EXPECT_FALSE(edit.Value({"aiding", "gnss"}));
  EXPECT_FALSE(edit.Value({"aiding", "dvl", "sigma"}));
  for (int k = 0; k < 2; ++k) {  // The second time in place of the first.
    EXPECT_TRUE(edit.Set({"imu", "noise", "gyro"}, "0.2 deg/s/sqrt(Hz)",
                         "check", "twice"));
    EXPECT_TRUE(
        edit.Set({"imu", "noise", "accel"}, "7 mg/sqrt(Hz)", "check", "more"));
    EXPECT_TRUE(edit.Set({"aiding", "gnss", "sigma"}, "[1 m, 1 m, 2 m]",
                         "check", "twice"));
    EXPECT_TRUE(
        edit.Set({"aiding", "wheel", "noise", "tau"}, "30 s", "check", "half"));
  }
  EXPECT_TRUE(
      edit.Set({"aiding", "wheel", "sigma_scale"}, "1.5", "check", "new"));
  EXPECT_TRUE(
      edit.Set({"aiding", "gnss", "sigma_scale"}, "1.5", "check", "new"));
  const std::string expected = R"yaml(# a car
imu:
  noise:                 # of its data sheet
    # check: gyro twice
    gyro: 0.2 deg/s/sqrt(Hz)   # white
    # check: accel more
    accel: "7 mg/sqrt(Hz)"
aiding:
  # check: sigma twice
  # check: sigma_scale new
  gnss: {sigma_scale: 1.5, type: position, sigma: [1 m, 1 m, 2 m], every: 1 s}
  # of both wheels
  wheel:
    # check: sigma_scale new
    sigma_scale: 1.5
    type: odometer
    # check: tau half
    noise: {model: gauss_markov, sigma: 2 m, tau: 30 s}
)yaml";
  EXPECT_EQ(edit.text(), expected);
}

TEST(ConfigEdit, LeavesWhatItCannotExchange) {
  ConfigEdit edit(kText, "config.yaml");
  EXPECT_FALSE(edit.Set({"aiding", "gnss"}, "1 m", "check", ""));
  EXPECT_FALSE(edit.Set({"aiding", "dvl", "sigma"}, "1 m", "check", ""));
  EXPECT_FALSE(edit.Set({"imu", "noise", "gyro", "x"}, "1", "check", ""));
  EXPECT_EQ(edit.text(), kText);
  EXPECT_THROW(ConfigEdit("a: {b: 1", "config.yaml"), InputError);
}

TEST(ConfigEdit, ScalesNumbersAndNoUnits) {
  EXPECT_EQ(ScaledNumbers("[0.5 m, 0.5 m, 1 m]", 1.3),
            "[0.65 m, 0.65 m, 1.3 m]");
  EXPECT_EQ(ScaledNumbers("5e-3 m/s^2/sqrt(Hz)", 2.0), "0.01 m/s^2/sqrt(Hz)");
  EXPECT_EQ(ScaledNumbers("1.7", 0.5), "0.85");
}

}  // namespace
}  // namespace hindsight
