#include "evaluation/refusals.h"

#include <gtest/gtest.h>

#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// Two receivers and an odometer, a measurement of each at every second.
std::vector<Sensor> ThreeSensors() {
  std::vector<Sensor> sensors(3);
  sensors[0].name = "gnss";
  sensors[1].name = "other";
  sensors[2].name = "odometer";
  sensors[2].kind = &OdometerKind();
  return sensors;
}

class Refusals : public ::testing::Test {
 protected:
  void Add(double t, int sensor, bool accepted, double nis,
           double weight = 1.0) {
    ResidualRecord record;
    record.t = t;
    record.sensor = sensor;
    record.accepted = accepted;
    record.nis = nis;
    record.weight = accepted ? weight : 0.0;
    solution_.residuals.push_back(record);
  }

  /// 100 s at 1 Hz, of which the gate refuses [begin, end); the first accepted
  /// after it has the normalised square `back`.
  void AddRun(int sensor, int begin, int end, double back) {
    for (int t = 0; t < 100; ++t) {
      const bool refused = t >= begin && t < end;
      Add(t, sensor, !refused, refused ? 30.0 : t == end ? back : 3.0);
    }
  }

  std::string Find() const {
    const auto found = FindRefusal(ThreeSensors(), solution_);
    return found ? found->what : "";
  }

  Solution solution_;
};

TEST_F(Refusals, MoreThanHalf) {
  for (int t = 0; t < 100; ++t) Add(t, 0, t % 2 == 0, t % 2 == 0 ? 3.0 : 30.0);
  EXPECT_EQ(Find(), "");
  Add(100.0, 0, false, 30.0);
  EXPECT_EQ(Find(), "the gate refused 51 of 101 measurements of gnss");
}

TEST_F(Refusals, WithheldMeasurementsDoNotCount) {
  for (int t = 0; t < 100; ++t) {
    Add(t, 0, true, 3.0);
    if (t > 30) solution_.residuals.back().withheld = true;
  }
  EXPECT_EQ(Find(), "");
}

TEST_F(Refusals, LongRunUntilTheFilterGaveUpItsSigma) {
  AddRun(0, 40, 70, 16.0);
  EXPECT_EQ(Find(),
            "the gate refused 30 measurements of gnss in a row, from 40.0 s to "
            "69.0 s");
}

TEST_F(Refusals, LongRunToTheEnd) {
  AddRun(0, 60, 100, 0.0);
  EXPECT_NE(Find().find("40 measurements of gnss in a row"), std::string::npos);
}

TEST_F(Refusals, RunIsTheSensorsWhereTheContradictionVanishes) {
  AddRun(0, 40, 70, 5.0);
  EXPECT_EQ(Find(), "");
}

TEST_F(Refusals, ShortRunSaysNothing) {
  AddRun(0, 40, 50, 16.0);
  EXPECT_EQ(Find(), "");
  solution_.residuals.clear();
  // Many, but within a tenth of a second.
  for (int i = 0; i < 50; ++i) Add(0.002 * i, 2, false, 30.0);
  for (int i = 0; i < 60; ++i) Add(1.0 + i, 2, true, 15.0);
  EXPECT_EQ(Find(), "");
}

TEST_F(Refusals, AnotherPositionVouches) {
  for (int t = 0; t < 100; ++t) {
    const bool refused = t >= 40 && t < 80;
    Add(t, 2, !refused, refused ? 30.0 : 16.0);
    Add(t, 0, true, 3.0);
  }
  EXPECT_EQ(Find(), "");
  // An odometer does not vouch for the position.
  solution_.residuals.clear();
  for (int t = 0; t < 100; ++t) {
    const bool refused = t >= 40 && t < 80;
    Add(t, 0, !refused, refused ? 30.0 : 16.0);
    Add(t, 2, true, 3.0);
  }
  EXPECT_NE(Find().find("of gnss in a row"), std::string::npos);
}

TEST_F(Refusals, LossThatLeavesNothing) {
  for (int t = 0; t < 100; ++t) Add(t, 1, true, 900.0, t < 51 ? 0.0025 : 1.0);
  EXPECT_EQ(Find(),
            "the loss left 51 of 100 measurements of other less than a tenth "
            "of their weight");
  solution_.modes = ModePart{{"good", "poor"}, {}};
  EXPECT_EQ(Find(), "");
}

TEST_F(Refusals, LossThatLeavesNothingToALongRun) {
  const auto add = [this](double back) {
    solution_.residuals.clear();
    for (int t = 0; t < 100; ++t) {
      const bool poor = t >= 40 && t < 70;
      Add(t, 0, true, poor ? 900.0 : t == 70 ? back : 3.0, poor ? 0.01 : 1.0);
    }
  };
  add(300.0);
  EXPECT_EQ(Find(),
            "the loss left 30 measurements of gnss in a row less than a tenth "
            "of their weight, from 40.0 s to 69.0 s");
  add(3.0);
  EXPECT_EQ(Find(), "");
}

}  // namespace
}  // namespace hindsight
