#include "evaluation/series_fold.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <stdexcept>

#include "evaluation/statistics.h"

namespace hindsight {
namespace {

constexpr int kRuns = 37;
const CellFolds::key_type kCell = {0, {"case", "method"}};

/// Of a run, at five times.
std::vector<double> SeriesOf(int run) {
  std::mt19937 random(static_cast<unsigned>(run));
  std::normal_distribution<double> normal(1e3, 0.1);
  std::vector<double> values(5);
  for (double& value : values) value = normal(random);
  return values;
}

FoldTree::Node NodeOf(int run) {
  FoldTree::Node node = {0, run, {}};
  node.cells[kCell] =
      FoldOfRun({0.0, 1.0, 2.0, 3.0, 4.0}, {{"e", SeriesOf(run)}});
  return node;
}

SeriesFold InOrder() {
  FoldTree tree;
  for (int run = 0; run < kRuns; ++run) tree.Add(NodeOf(run));
  return tree.First(kRuns).at(kCell);
}

TEST(SeriesFold, IsMeanAndDeviationOverTheRuns) {
  const SeriesFold fold = InOrder();
  const SeriesFold::Moments& moments = fold.series.at("e");
  EXPECT_EQ(moments.runs, kRuns);
  const std::vector<double> deviation = SeriesFold::Deviation(moments);
  for (std::size_t k = 0; k < fold.t.size(); ++k) {
    std::vector<double> values;
    for (int run = 0; run < kRuns; ++run) values.push_back(SeriesOf(run)[k]);
    EXPECT_NEAR(moments.mean[k], Mean(values), 1e-12 * 1e3);
    EXPECT_NEAR(deviation[k], StandardDeviation(values), 1e-12);
  }
}

TEST(SeriesFold, HasTheSameBitsInAnyOrderAndAnyParts) {
  const SeriesFold expected = InOrder();
  std::mt19937 random(1);
  for (int parts = 1; parts <= 5; ++parts) {
    FoldTree all;
    for (int part = parts - 1; part >= 0; --part) {
      std::vector<int> runs(static_cast<std::size_t>(
          kRuns * (part + 1) / parts - kRuns * part / parts));
      std::iota(runs.begin(), runs.end(), kRuns * part / parts);
      std::shuffle(runs.begin(), runs.end(), random);
      FoldTree tree;
      for (const int run : runs) tree.Add(NodeOf(run));
      EXPECT_LE(tree.nodes().size(), 10u);
      for (const auto& [begin, node] : tree.nodes()) all.Add(node);
    }
    const SeriesFold fold = all.First(kRuns).at(kCell);
    EXPECT_EQ(fold.series.at("e").mean, expected.series.at("e").mean);
    EXPECT_EQ(fold.series.at("e").squares, expected.series.at("e").squares);
  }
}

TEST(SeriesFold, FirstRunsAreThoseOfFewerRuns) {
  FoldTree many, few;
  for (int run = 0; run < kRuns; ++run) {
    if (run == 6) continue;
    many.Add(NodeOf(run));
    if (run < 6) few.Add(NodeOf(run));
  }
  EXPECT_EQ(many.First(6).at(kCell).series.at("e").squares,
            few.First(6).at(kCell).series.at("e").squares);
}

TEST(SeriesFold, KeepsTheTimesThatAllRunsHave) {
  const SeriesFold sum = Combine(FoldOfRun({0, 1, 2}, {{"e", {1, 2, 3}}}),
                                 FoldOfRun({1, 2, 3}, {{"e", {4, 5, 6}}}));
  EXPECT_THAT(sum.t, ::testing::ElementsAre(1, 2));
  EXPECT_THAT(sum.series.at("e").mean, ::testing::ElementsAre(3, 4));
}

TEST(SeriesFold, MissingAndDoubledRunsAreRefused) {
  FoldTree tree;
  for (const int run : {0, 1, 3}) tree.Add(NodeOf(run));
  EXPECT_THROW(tree.First(4), std::invalid_argument);
  EXPECT_THROW(tree.Add(NodeOf(1)), std::invalid_argument);
}

}  // namespace
}  // namespace hindsight
