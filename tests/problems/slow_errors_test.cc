#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "base/random.h"
#include "base/units.h"
#include "dataset/injection.h"
#include "io/config/injection_text.h"
#include "io/config/scenario_config.h"
#include "problems/accuracy.h"
#include "simulation/scenario.h"

namespace hindsight {
namespace {

using testing::Accuracy;
using testing::Judge;
using testing::SolveBy;

bool Notes(const Solution& solution, const std::string& begin) {
  return std::ranges::any_of(solution.notes, [&begin](const std::string& one) {
    return one.starts_with(begin);
  });
}

/// Wheels that come to measure 4 % too much within a minute, by less than a sigma from
/// one measurement to the next: not the receiver errs.
TEST(RobustBatch, FindsWheelsWhoseScaleDrifts) {
  const Dataset clean = Simulate(FindScenario("test_car"), 31);
  Dataset dirty = clean;
  for (AidingStream& stream : dirty.streams) {
    for (Measurement& z : stream.measurements.Edited()) {
      auto* odometer = std::get_if<Odometer>(&z.model);
      if (odometer == nullptr) continue;
      odometer->speed *= 1.0 + 0.04 * std::clamp((z.t - 40.0) / 60.0, 0.0, 1.0);
    }
  }
  const Accuracy without = Judge(clean, SolveBy("batch", clean));
  EXPECT_GT(Judge(dirty, SolveBy("batch", dirty)).horizontal_rms,
            2.0 * without.horizontal_rms);
  const Solution solution = SolveBy("robust_batch", dirty);
  EXPECT_LT(Judge(dirty, solution).horizontal_rms,
            1.2 * without.horizontal_rms);
  EXPECT_TRUE(Notes(solution, "odometer: against the noise as stated"));
}

/// A field of currents that turns with the vehicle, is up to nine times as large as the
/// Earth's horizontal one and changes within seconds.
TEST(RobustBatch, LeavesOutACompassThatContradictsAllOthers) {
  const Dataset clean = Simulate(FindScenario("test_drone"), 32);
  Dataset dirty = clean;
  for (AidingStream& stream : dirty.streams) {
    for (Measurement& z : stream.measurements.Edited()) {
      auto* field = std::get_if<MagneticField>(&z.model);
      if (field == nullptr) continue;
      field->field_b += 200.0 * std::abs(std::sin(z.t / 7.0)) *
                        Eigen::Vector3d(0.8, -0.6, 0.2);
    }
  }
  const Accuracy without = Judge(clean, SolveBy("batch", clean));
  EXPECT_GT(Judge(dirty, SolveBy("batch", dirty)).horizontal_rms,
            3.0 * without.horizontal_rms);
  const Solution solution = SolveBy("robust_batch", dirty);
  EXPECT_LT(Judge(dirty, solution).horizontal_rms,
            1.5 * without.horizontal_rms);
  EXPECT_EQ(solution.left_out.size(), 1u);
  EXPECT_EQ(solution.grade, Grade::kDoubtful) << solution.verdict;
  EXPECT_TRUE(std::ranges::any_of(solution.evidence, [](const Evidence& one) {
    return one.what.starts_with("compass left out");
  }));
}

/// A lone receiver of 0.5 m that has Gauss-Markov errors of 2 m and 60 s as well from its
/// first fix to its last, of which the IMU sees but how fast they walk.
TEST(RobustBatch, IsHonestBesideErrorsOfWhichOnlyTheWalkIsSeen) {
  constexpr int kRuns = 8;
  constexpr double kSigma = 2.0;
  constexpr double kTau = 60.0;
  constexpr double kHonest = 15.0;  // of three degrees of freedom
  int honest = 0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    Dataset dataset = Simulate(FindScenario("two_receivers"), 41 + run);
    dataset.streams.pop_back();
    Random random(51 + run);
    Eigen::Vector3d e = kSigma * random.NormalVector3();
    double t = 0.0;
    for (Measurement& z : dataset.streams.front().measurements.Edited()) {
      auto* fix = std::get_if<PositionFix>(&z.model);
      if (fix == nullptr) continue;
      const double a = std::exp(-(z.t - t) / kTau);
      e = a * e + kSigma * std::sqrt(1.0 - a * a) * random.NormalVector3();
      t = z.t;
      fix->p_e += NedAxes(fix->p_e) * e;
    }
    EXPECT_GT(Judge(dataset, SolveBy("batch", dataset)).position_nees, 100.0);
    const Solution solution = SolveBy("robust_batch", dataset);
    const double nees = Judge(dataset, solution).position_nees;
    honest += nees < kHonest;
    EXPECT_TRUE(nees < kHonest || !solution.usable()) << 41 + run;
  }
  EXPECT_GE(honest, 6);
}

/// Multipath of the size of a stated sigma: beside the noise of the fixes and of a consumer
/// IMU nothing is seen of it, and nothing is moved; but it may be there.
TEST(RobustBatch, HoldsErrorsThatNoiseHides) {
  constexpr int kRuns = 6;
  constexpr double kWrong = 30.0;
  int wrong = 0;
  int wrong_without = 0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const Dataset clean = Simulate(FindScenario("test_hand"), 61 + run);
    Dataset dirty = clean;
    ApplyInjections({ParseInjection("camera:multipath=2cm,tau=60s,axes=ned")},
                    71 + run, &dirty);
    const Solution batch = SolveBy("batch", dirty);
    const Solution solution = SolveBy("robust_batch", dirty);
    wrong_without += Judge(dirty, batch).position_nees > kWrong;
    wrong += Judge(dirty, solution).position_nees > kWrong && solution.usable();
    // Of one of which the data tell nothing the prior does, beside which it is small.
    EXPECT_LT(Judge(clean, SolveBy("robust_batch", clean)).position_nees, 4.0);
  }
  EXPECT_GE(wrong_without, 4);
  EXPECT_LE(wrong, 1);
}

}  // namespace
}  // namespace hindsight
