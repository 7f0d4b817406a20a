#include "attitude/rest_detector.h"

#include <gtest/gtest.h>

namespace hindsight {
namespace {

const Eigen::Vector3d kUp(0.0, 0.0, -9.8);

void Feed(double seconds, const Eigen::Vector3d& w, const Eigen::Vector3d& f,
          RestDetector* detector) {
  constexpr double kDt = 0.005;
  for (int k = 0; k < static_cast<int>(seconds / kDt); ++k) {
    detector->Add(kDt, w, f);
  }
}

TEST(RestDetector, FindsRestAfterASecondAndAHalf) {
  RestDetector detector;
  const Eigen::Vector3d bias(0.01, -0.005, 0.0);
  Feed(1.4, bias, kUp, &detector);
  EXPECT_FALSE(detector.rests());
  Feed(0.2, bias, kUp, &detector);
  EXPECT_TRUE(detector.rests());
  EXPECT_LT((detector.rate() - bias).norm(), 1e-12);
}

TEST(RestDetector, SeesTurnsAndAccelerationsAtOnce) {
  for (const bool turns : {true, false}) {
    RestDetector detector;
    Feed(3.0, Eigen::Vector3d::Zero(), kUp, &detector);
    ASSERT_TRUE(detector.rests());
    detector.Add(
        0.005, turns ? Eigen::Vector3d(0.0, 0.0, 0.1) : Eigen::Vector3d::Zero(),
        turns ? kUp : Eigen::Vector3d(1.0, 0.0, -9.8));
    EXPECT_FALSE(detector.rests());
  }
}

}  // namespace
}  // namespace hindsight
