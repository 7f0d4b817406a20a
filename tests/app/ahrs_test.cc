#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/recording.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(AhrsCommand, WritesQuaternionsAndNoPlace) {
  Recording recording;
  const Outcome outcome =
      recording.Run({"--out=out", "--methods=ahrs,ahrs_smoother"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string csv = ReadFile(recording.root() / "out" / "ahrs.csv");
  EXPECT_THAT(csv, HasSubstr("q_w[1],q_x[1],q_y[1],q_z[1],accel_sigma[m/s^2],"
                             "magnetic[1]\n"));
  EXPECT_THAT(csv, Not(HasSubstr("lat[deg]")));
}

TEST(AhrsCommand, RefusesAMixtureOfMethods) {
  Recording recording;
  const Outcome outcome = recording.Run({"--out=out", "--methods=ahrs,batch"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("attitude alone"));
}

TEST(AhrsCommand, NamesTheRulesItKnows) {
  Recording recording;
  const Outcome outcome =
      recording.Run({"--out=out", "--methods=ahrs", "--ahrs-rule=trust"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("fixed, gate, held_gate, adaptive, smnc"));
}

}  // namespace
}  // namespace hindsight
