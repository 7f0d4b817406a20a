#include "evaluation/solution_table.h"

#include <gtest/gtest.h>

#include <vector>

namespace hindsight {
namespace {

TEST(SolutionTable, OfSomeStatesHasTheirRows) {
  Solution solution;
  solution.method = "rts";
  solution.layout = NavigationLayout({});
  const int dim = solution.layout.dim();
  constexpr std::size_t kCount = 7;
  solution.covariances = CovarianceSeries(dim, kCount);
  for (std::size_t k = 0; k < kCount; ++k) {
    const auto size = static_cast<double>(k + 1);
    State x = MakeState(size, {0.8, 0.1, size}, {size, 2.0, 3.0},
                        {0.1, 0.2, 0.01 * size});
    solution.states.push_back(x);
    solution.covariances.Set(k, size * ErrorMatrix::Identity(dim, dim));
  }
  solution.two_filter.emplace();
  solution.two_filter->separation = {1, 2, 3, 4, 5, 6, 7};
  const SolutionTable whole = TableFromSolution(solution);
  const SolutionTable rows = RowsOf(whole, {2, 3, 4});
  const SolutionTable part = TableFromSolution(solution, 2, 5);
  EXPECT_EQ(part.method, "rts");
  EXPECT_EQ(part.t, rows.t);
  EXPECT_EQ(part.p_e, rows.p_e);
  EXPECT_EQ(part.v_e, rows.v_e);
  EXPECT_EQ(part.P_position, rows.P_position);
  EXPECT_EQ(part.P_attitude, rows.P_attitude);
  EXPECT_EQ(part.sigma_euler, rows.sigma_euler);
  EXPECT_EQ(part.b_g, rows.b_g);
  EXPECT_EQ(part.sigma_b_a, rows.sigma_b_a);
  EXPECT_EQ(part.separation, rows.separation);
  EXPECT_TRUE(part.accel_sigma.empty());
  EXPECT_EQ(TableFromSolution(solution, 5, 5).size(), 0u);
}

}  // namespace
}  // namespace hindsight
