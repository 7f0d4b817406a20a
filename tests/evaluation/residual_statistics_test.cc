#include "evaluation/residual_statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hindsight {
namespace {

ResidualRecord Record(int sensor, int rows, double nis) {
  ResidualRecord record;
  record.sensor = sensor;
  record.residual = RowVector::Zero(rows);
  record.nis = nis;
  return record;
}

TEST(ResidualStatistics, MatchHandComputedCase) {
  Dataset dataset;
  dataset.streams.resize(3);
  dataset.streams[0].sensor.name = "gnss";
  dataset.streams[1].sensor.name = "silent";
  dataset.streams[2].sensor.name = "height";
  Solution solution;
  solution.residuals = {Record(0, 3, 3.0), Record(0, 3, 9.0),
                        Record(0, 3, 300.0), Record(0, 3, 500.0),
                        Record(2, 1, 80.0)};
  solution.residuals[2].accepted = false;
  solution.residuals[3].withheld = true;
  solution.residuals[4].accepted = false;
  const auto statistics = ComputeResidualStatistics(solution, dataset);
  ASSERT_EQ(statistics.size(), 2u);
  EXPECT_EQ(statistics[0].sensor, "gnss");
  EXPECT_EQ(statistics[0].count, 3u);
  EXPECT_EQ(statistics[0].rejected, 1u);
  EXPECT_EQ(statistics[0].withheld, 1u);
  EXPECT_DOUBLE_EQ(*statistics[0].normalized_rms, std::sqrt(2.0));
  EXPECT_EQ(statistics[1].sensor, "height");
  EXPECT_EQ(statistics[1].rejected, 1u);
  EXPECT_FALSE(statistics[1].normalized_rms);
}

}  // namespace
}  // namespace hindsight
