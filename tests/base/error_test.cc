#include "base/error.h"

#include <gtest/gtest.h>

#include <string>

namespace hindsight {
namespace {

TEST(InputError, SaysFileLineAndMessage) {
  EXPECT_STREQ(InputError("imu.csv", 12, "time runs backwards").what(),
               "imu.csv:12: time runs backwards");
  EXPECT_STREQ(InputError("imu.csv", 0, "is empty").what(),
               "imu.csv: is empty");
}

TEST(InputError, IsNotAnEstimationError) {
  // The command turns each into its own exit status.
  EXPECT_THROW(throw InputError("x"), InputError);
  bool caught_as_estimation_error = false;
  try {
    throw InputError("x");
  } catch (const EstimationError&) {
    caught_as_estimation_error = true;
  } catch (const std::runtime_error&) {
  }
  EXPECT_FALSE(caught_as_estimation_error);
}

}  // namespace
}  // namespace hindsight
