#include "problems/open_biases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "filters/forward_filter.h"
#include "filters/rts.h"
#include "receiver_errors/receiver_tape.h"
#include "receiver_errors/sensor_findings.h"

namespace hindsight {
namespace {

using testing::PositionsOnly;
using testing::TestProblem;

/// A minute of positions alone, of which the start is not known.
TestProblem LonePositions() {
  TestProblem test = PositionsOnly(60.0);
  test.prior.P.topLeftCorner<3, 3>() *= 1e6;
  return test;
}

/// Nobody sees a constant of a lone receiver: it is in the result whole, with its
/// probability, and in nothing but the positions.
TEST(OpenBiases, AreHeldAsMuchAsTheyAreLikely) {
  constexpr double kSigma = 3.0;
  const TestProblem test = LonePositions();
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const CovarianceSeries without = SmoothRts(tape).P;
  ErrorDecisions decisions(problem, tape, 0);
  std::vector<std::string> held;
  const auto widened = [&](const ErrorDecisions& by) {
    CovarianceSeries P = without;
    held =
        WidenByOpenBiases({{.errors = {std::make_shared<ErrorDecisions>(by)}}},
                          problem, test.truth, &P);
    return P;
  };
  EXPECT_EQ(widened(decisions).Get(30), without.Get(30));
  EXPECT_TRUE(held.empty());
  decisions.open.emplace();
  decisions.open->log_odds = -std::log(3.0);
  decisions.open->expected.sigma = kSigma;
  decisions.open->expected.tau = 1e9;
  const CovarianceSeries with = widened(decisions);
  EXPECT_EQ(held, std::vector<std::string>{OpenBiasInWords(decisions)});
  for (const std::size_t k : {0u, 30u, 60u}) {
    const ErrorMatrix added = with.Get(k) - without.Get(k);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(added(i, i), 0.25 * kSigma * kSigma, 0.02 * kSigma * kSigma);
      EXPECT_NEAR(added(3 + i, 3 + i), 0.0, 1e-3 * without.At(k, 3 + i, 3 + i));
    }
    EXPECT_NEAR(added(0, 1), 0.0, 0.02 * kSigma * kSigma);
  }
  // Certain.
  decisions.open->log_odds = 50.0;
  EXPECT_NEAR(widened(decisions).At(30, 0, 0) - without.At(30, 0, 0),
              kSigma * kSigma, 0.02 * kSigma * kSigma);
}

/// By as much as the error moves the states: covariances alone are the same whatever was
/// measured.
TEST(OpenBiases, AreHeldWithWhereTheyLead) {
  TestProblem test = LonePositions();
  const auto added = [&test] {
    Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
    const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
    const SmoothedTrajectory without = SmoothRts(tape);
    ErrorDecisions decisions(problem, tape, 0);
    decisions.open.emplace();
    decisions.open->expected.sigma = 1.0;
    decisions.open->expected.tau = 10.0;
    CovarianceSeries P = without.P;
    WidenByOpenBiases(
        {{.errors = {std::make_shared<ErrorDecisions>(decisions)}}}, problem,
        test.truth, &P);
    return P.At(30, 0, 0) - without.P.At(30, 0, 0);
  };
  const double as_it_is = added();
  testing::AddError(20, 40, Eigen::Vector3d(10.0, 0.0, 0.0), &test);
  EXPECT_GT(added(), 1.5 * as_it_is);
}

/// What was decided last of a sensor counts.
TEST(OpenBiases, OfALaterRoundCount) {
  const TestProblem test = LonePositions();
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const CovarianceSeries without = SmoothRts(tape).P;
  const auto closed = std::make_shared<ErrorDecisions>(problem, tape, 0);
  const auto open = std::make_shared<ErrorDecisions>(*closed);
  open->open.emplace();
  CovarianceSeries P = without;
  WidenByOpenBiases({{.errors = {open}}, {.errors = {closed}}}, problem,
                    test.truth, &P);
  EXPECT_EQ(P.Get(30), without.Get(30));
  WidenByOpenBiases({{.errors = {closed}}, {.errors = {open}}}, problem,
                    test.truth, &P);
  EXPECT_GT(P.At(30, 0, 0), without.At(30, 0, 0));
}

}  // namespace
}  // namespace hindsight
