#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <utility>

#include "base/units.h"
#include "dataset/injection.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "problems/reconstruction.h"
#include "problems/robust_batch.h"
#include "support/shuttle_flight.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

/// A minute, in the middle of which positions go astray as velocities say.
TestProblem PositionsAndVelocitiesThatErr() {
  constexpr double kBegin = 20.5;
  constexpr double kEnd = 35.5;
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.errors = true;
  options.duration = 60.0;
  options.position_sigma = 0.5;
  options.velocity_sigma = 0.05;
  TestProblem test = MakeProblem(options, 3);
  for (Measurement& z : test.measurements) {
    if (z.t < kBegin || z.t >= kEnd) continue;
    if (auto* fix = std::get_if<PositionFix>(&z.model)) {
      fix->p_e += NedAxes(fix->p_e).col(0) * 2.0 * (kEnd - z.t);
    } else if (auto* velocity = std::get_if<VelocityFix>(&z.model)) {
      velocity->v_n.x() -= 2.0;
    }
  }
  return test;
}

/// Where a search was as it was told: the fraction done, and whether it had been
/// farther before, as only one that begins with the velocities makes it.
struct Place {
  double fraction = 0.0;
  bool begun_anew = false;
};

/// With no time left from where `is_over` says so on.
struct Searched {
  RobustBatchResult result;
  bool met = false;  ///< such a place
};

Searched SearchUntil(const std::function<bool(const Place&)>& is_over) {
  const TestProblem test = PositionsAndVelocitiesThatErr();
  // A heading that is off by 15 deg is beyond what is linear.
  std::vector<State> initial = test.truth;
  for (State& x : initial) {
    x.q_eb = x.q_eb * Exp(Eigen::Vector3d(0.0, 0.0, 15.0 * kDegree));
  }
  bool met = false;
  double farthest = 0.0;
  RobustBatchOptions options;
  options.go_on = [&](double fraction) {
    Place place = {fraction, fraction < farthest - 0.05};
    farthest = std::max(farthest, fraction);
    met |= is_over(place);
    return !met;
  };
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  RobustBatchResult result =
      SolveRobustBatch(std::move(problem), initial, options);
  return {std::move(result), met};
}

TEST(EndedSearch, IsNoneWhereTimeIsEnough) {
  const Searched whole = SearchUntil([](const Place&) { return false; });
  EXPECT_TRUE(whole.result.stands);
  EXPECT_FALSE(whole.result.ended);
}

TEST(EndedSearch, MayBeThatFromTheVelocities) {
  const Searched one =
      SearchUntil([](const Place& at) { return at.begun_anew; });
  EXPECT_TRUE(one.met);
  EXPECT_TRUE(one.result.stands);
  EXPECT_TRUE(one.result.ended);
}

TEST(EndedSearch, MayBeThatAboutTheSolution) {
  const Searched one =
      SearchUntil([](const Place& at) { return at.fraction > 0.6; });
  EXPECT_TRUE(one.met);
  EXPECT_TRUE(one.result.stands);
  EXPECT_TRUE(one.result.ended);
}

TEST(EndedSearch, MayBeOneThatDidNotBegin) {
  const Searched one =
      SearchUntil([](const Place& at) { return at.fraction >= 0.5; });
  EXPECT_TRUE(one.met);
  EXPECT_TRUE(one.result.ended);
}

/// A flight to and fro whose clock is turned by positions that err, so that errors
/// are sought beside two clocks.
Dataset FlightWithTwoClocks() {
  ShuttleOptions options;
  options.duration = 16.0;
  Dataset dataset = LateShuttle(options, 7, 0.6, 0.5);
  Injection spikes;
  spikes.sensor = "gnss";
  spikes.kind = Injection::Kind::kSpikes;
  spikes.size = 10.0;
  spikes.share = 0.2;
  spikes.from = dataset.streams[0].measurements.front().t + 10.0;
  ApplyInjections({spikes}, 7, &dataset);
  return dataset;
}

bool IsOfEndedSearch(const Evidence& one) {
  return one.what.find("was ended before it was done") != std::string::npos;
}

/// How often it is said that a search was ended, if all of the time passes once
/// `is_last` has met its stage.
std::ptrdiff_t SaidIfTimeIsOverAt(
    double max_time,
    const std::function<bool(const std::string& stage)>& is_last) {
  const Dataset dataset = FlightWithTwoClocks();
  ReconstructionOptions options;
  options.method = "robust_batch";
  options.max_time = max_time;
  bool is_over = false;
  options.progress = [&](const std::string& stage, double) {
    if (!is_last(stage) || is_over) return;
    is_over = true;
    std::this_thread::sleep_for(
        std::chrono::duration<double>(options.max_time));
  };
  const Solution solution = Solve(dataset, options);
  return std::ranges::count_if(solution.evidence, IsOfEndedSearch);
}

TEST(EndedSearch, SaysNothingOfTimeThatWasEnough) {
  EXPECT_EQ(SaidIfTimeIsOverAt(1e6, [](const std::string&) { return false; }),
            0);
}

/// Of a search of half a second [s].
constexpr double kTime = 4.0;

/// Whether a stage follows that many searches: two about the first clocks, as nodes
/// move, and then one beside others.
class Follows {
 public:
  Follows(std::string stage, int searches)
      : wanted_(std::move(stage)), searches_(searches) {}

  bool operator()(const std::string& stage) {
    if (stage == "errors of sensors" && stage != last_) ++count_;
    last_ = stage;
    return count_ == searches_ && stage == wanted_;
  }

  /// Searches so far.
  int count() const { return count_; }

 private:
  std::string wanted_;
  std::string last_;
  int searches_;
  int count_ = 0;
};

TEST(EndedSearch, DoesNotBeginWhereNodesMove) {
  Follows follows("grading", 1);
  EXPECT_EQ(SaidIfTimeIsOverAt(kTime, std::ref(follows)), 1);
  EXPECT_EQ(follows.count(), 1);
}

TEST(EndedSearch, MayBeOneBesideOtherClocksThatDidNotBegin) {
  EXPECT_EQ(SaidIfTimeIsOverAt(kTime, Follows("grading", 2)), 1);
}

TEST(EndedSearch, MayBeThatBesideOtherClocks) {
  EXPECT_EQ(SaidIfTimeIsOverAt(kTime, Follows("ekf", 2)), 1);
}

}  // namespace
}  // namespace hindsight
