#include "imu/sample_facts.h"

#include <gtest/gtest.h>

#include "imu/imu_stream.h"

namespace hindsight {
namespace {

constexpr double kExactStep = 0.25;  // of which all multiples are exact [s]

ImuStream Climbing(std::size_t count) {
  ImuStream imu;
  imu.nominal_dt = kExactStep;
  for (std::size_t k = 0; k < count; ++k) {
    const auto n = static_cast<double>(k);
    imu.samples.push_back(
        {n * kExactStep, {1.0 + n, 2.0 + n, -n}, {n, 2.0 * n, -9.0 - n}});
  }
  return imu;
}

TEST(SampleFacts, KnowDropOutsAndHowOftenEachIntervalComes) {
  ImuStream imu = Climbing(100'000);
  for (std::size_t k = 70'000; k < imu.samples.size(); ++k) {
    imu.samples[k].t += 4.0 * kExactStep;
  }
  const auto facts = FactsOf(imu);
  ASSERT_EQ(facts->drop_outs, std::vector<std::size_t>{70'000});
  ASSERT_TRUE(facts->intervals);
  ASSERT_EQ(facts->intervals->size(), 2u);
  EXPECT_EQ(facts->intervals->front().interval, kExactStep);
  EXPECT_EQ(facts->intervals->front().count, 99'998);
  EXPECT_EQ(facts->intervals->back().interval, 5.0 * kExactStep);
  EXPECT_EQ(facts->intervals->back().count, 1);
}

TEST(SampleFacts, LeaveTheBeginOfIncrementsOutOfTheIntervalsOfRows) {
  ImuStream imu = Climbing(100);
  imu.kind = ImuStream::Kind::kIncrements;
  imu.samples[0].t = -kExactStep / 2.0;
  ASSERT_EQ(FactsOf(imu)->intervals->size(), 1u);
  EXPECT_EQ(FactsOf(imu)->intervals->front().count, 98);
}

TEST(SampleFacts, DoNotCountIntervalsThatAreAllDifferent) {
  ImuStream imu = Climbing(2'000);
  for (std::size_t k = 0; k < imu.samples.size(); ++k) {
    imu.samples[k].t += 1e-6 * static_cast<double>(k * k);
  }
  EXPECT_FALSE(FactsOf(imu)->intervals);
}

TEST(SampleFacts, KnowWhereReadingsRepeat) {
  constexpr std::size_t kPiece = SampleFacts::kRepeatPiece;
  ImuStream imu = Climbing(3 * kPiece);
  imu.samples[kPiece + 7].gyro.y() = imu.samples[kPiece + 6].gyro.y();
  imu.samples[2 * kPiece].gyro = imu.samples[2 * kPiece - 1].gyro;
  imu.samples[2 * kPiece].accel = imu.samples[2 * kPiece - 1].accel;
  const auto facts = FactsOf(imu);
  EXPECT_EQ(facts->repeats, (std::vector<bool>{false, true, true}));
  EXPECT_EQ(facts->whole_repeats, 1u);
}

TEST(SampleFacts, AreFoundAgainOnceAnythingHasChanged) {
  ImuStream imu = Climbing(1'000);
  const auto first = FactsOf(imu);
  EXPECT_EQ(FactsOf(imu), first);
  const ImuStream copy = imu;
  EXPECT_TRUE(FactsOf(copy)->drop_outs.empty());
  EXPECT_EQ(FactsOf(imu), first);

  imu.samples[999].t += 10.0;
  EXPECT_EQ(DropOuts(imu), std::vector<std::size_t>{999});
  imu.nominal_dt = 20.0;
  EXPECT_TRUE(DropOuts(imu).empty());
  imu.nominal_dt = kExactStep;
  imu.samples.pop_back();
  EXPECT_TRUE(DropOuts(imu).empty());
  EXPECT_EQ(FactsOf(imu)->readings.max_rate,
            (Eigen::Vector3d(999.0, 1000.0, -998.0).norm()));
  imu.kind = ImuStream::Kind::kIncrements;
  EXPECT_EQ(FactsOf(imu)->readings.max_rate,
            (Eigen::Vector3d(999.0, 1000.0, -998.0) / kExactStep).norm());
  EXPECT_TRUE(FactsOf(copy)->drop_outs.empty());
}

}  // namespace
}  // namespace hindsight
