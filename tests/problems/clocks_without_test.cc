#include "problems/clocks_without.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "dataset/injection.h"
#include "problems/reconstruction.h"
#include "support/shuttle_flight.h"

namespace hindsight {
namespace {

constexpr double kLate = 0.6;  // positions, in a flight to and fro [s]

Dataset Flight(std::uint64_t seed) {
  ShuttleOptions options;
  options.duration = 16.0;
  return LateShuttle(options, seed, kLate, 0.5);
}

/// From ten seconds on one fix in five is off.
Dataset WithSpikes(Dataset dataset, std::uint64_t seed) {
  Injection spikes;
  spikes.sensor = "gnss";
  spikes.kind = Injection::Kind::kSpikes;
  spikes.size = 10.0;
  spikes.share = 0.2;
  const double begin = dataset.streams[0].measurements.front().t;
  spikes.from = begin + 10.0;
  ApplyInjections({spikes}, seed, &dataset);
  return dataset;
}

/// What differs between the records of a sensor.
std::set<MeasurementKey> Changed(const Dataset& a, const Dataset& b) {
  std::set<MeasurementKey> keys;
  const MeasurementSeries& one = a.streams[0].measurements;
  const MeasurementSeries& other = b.streams[0].measurements;
  auto z = other.begin();
  for (const Measurement& x : one) {
    if (std::get<PositionFix>(x.model).p_e !=
        std::get<PositionFix>((*z).model).p_e) {
      keys.insert({x.sensor, x.t});
    }
    ++z;
  }
  return keys;
}

double OffsetOf(const Solution& solution) {
  const auto found = std::ranges::find(solution.constants, "gnss_time_offset",
                                       &ConstantEstimate::name);
  return found->value;
}

TEST(ClocksWithout, AreThoseOfTheRecordingWithoutWhatErrs) {
  const Dataset right = Flight(5);
  const Dataset wrong = WithSpikes(right, 5);
  const std::set<MeasurementKey> erring = Changed(right, wrong);
  ASSERT_GT(erring.size(), 5u);
  const auto found = ChooseClocksWithout(erring, wrong, {});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->choice.stage->offsets()[0], -kLate, 0.05);
  EXPECT_EQ(found->choice.given, &wrong);
}

TEST(ClocksWithout, GiveMethodsAllMeasurements) {
  const Dataset right = Flight(5);
  const Dataset wrong = WithSpikes(right, 5);
  const std::set<MeasurementKey> erring = Changed(right, wrong);
  const auto found = ChooseClocksWithout(erring, wrong, {});
  ASSERT_TRUE(found);
  std::size_t seen = 0;
  const Problem& problem = found->nodes.problem;
  for (std::size_t i = 0; i < problem.decisions.size(); ++i) {
    const Measurement& z = problem.timeline.all_measurements()[i];
    EXPECT_FALSE(z.withheld) << z.t;
    EXPECT_EQ(problem.decisions[i], 1) << z.t;
    seen += erring.contains({z.sensor, z.t});
  }
  EXPECT_EQ(seen, erring.size());
  for (const Measurement& z : wrong.streams[0].measurements) {
    EXPECT_FALSE(z.withheld) << z.t;
  }
}

/// The spikes turn the batch's clock; where they are found the others have it right.
TEST(ClocksWithout, KeepSpikesFromTurningTheClockOfRobustBatch) {
  const Dataset dataset = WithSpikes(Flight(7), 7);
  Reconstruction reconstruction(dataset, {});
  EXPECT_GT(OffsetOf(reconstruction.Run("batch")), 0.5);
  EXPECT_NEAR(OffsetOf(reconstruction.Run("robust_batch")), -kLate, 0.05);
}

/// A pulse turns the clock from which all methods begin so far that nothing explains
/// the data about it; the rough trajectory has it right.
TEST(ClocksWithout, MayBeThoseOfTheRoughTrajectory) {
  ShuttleOptions options;
  Dataset dataset = LateShuttle(options, 6, kLate, 0.5);
  Injection pulse;
  pulse.sensor = "gnss";
  pulse.kind = Injection::Kind::kPulse;
  pulse.size = 10.0;
  pulse.from = dataset.streams[0].measurements.front().t + 18.0;
  pulse.to = pulse.from + 6.0;
  ApplyInjections({pulse}, 7, &dataset);
  Reconstruction reconstruction(dataset, {});
  EXPECT_GT(OffsetOf(reconstruction.Run("batch")), 0.5);
  EXPECT_NEAR(OffsetOf(reconstruction.Run("robust_batch")), -kLate, 0.05);
}

}  // namespace
}  // namespace hindsight
