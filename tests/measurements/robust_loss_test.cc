#include "measurements/robust_loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hindsight {
namespace {

RobustLoss Mixture(double share, double ratio, int rows, double scale = 1.0) {
  RobustLoss loss;
  loss.kind = RobustLoss::Kind::kMixture;
  loss.outlier_share = share;
  loss.outlier_ratio = ratio;
  loss.rows = rows;
  loss.scale = scale;
  return loss;
}

TEST(RobustLoss, DerivativesAreThoseOfTheCost) {
  std::vector<RobustLoss> losses = {Mixture(0.05, 20.0, 3),
                                    Mixture(0.2, 5.0, 1, 3.0)};
  for (const auto kind : {RobustLoss::Kind::kNone, RobustLoss::Kind::kHuber,
                          RobustLoss::Kind::kCauchy, RobustLoss::Kind::kTukey,
                          RobustLoss::Kind::kGemanMcClure}) {
    losses.push_back({kind, 3.0});
  }
  for (const RobustLoss& loss : losses) {
    EXPECT_NEAR(loss.Cost(0.0), 0.0, 1e-12);
    for (const double s : {0.3, 2.0, 8.5, 15.0, 40.0, 400.0}) {
      const double h = 1e-4;
      EXPECT_NEAR(loss.Weight(s),
                  (loss.Cost(s + h) - loss.Cost(s - h)) / (2.0 * h), 1e-6)
          << static_cast<int>(loss.kind) << " " << s;
      EXPECT_NEAR(loss.Curvature(s),
                  (loss.Weight(s + h) - loss.Weight(s - h)) / (2.0 * h), 1e-6)
          << static_cast<int>(loss.kind) << " " << s;
    }
  }
}

TEST(RobustLoss, MixtureIsTheLogarithmOfTheTwoDensities) {
  const double a = 0.1;
  const double k = 8.0;
  const RobustLoss loss = Mixture(a, k, 2);
  const auto density = [&](double s) {
    return (1.0 - a) * std::exp(-0.5 * s) +
           a / (k * k) * std::exp(-0.5 * s / (k * k));
  };
  for (const double s : {0.0, 1.0, 9.0, 30.0, 100.0}) {
    EXPECT_NEAR(loss.Cost(s), -2.0 * std::log(density(s) / density(0.0)), 1e-9);
    EXPECT_NEAR(loss.InlierProbability(s),
                (1.0 - a) * std::exp(-0.5 * s) / density(s), 1e-12);
  }
  // Far out nothing overflows, and the outliers' own weight is left.
  EXPECT_NEAR(loss.Weight(1e7), 1.0 / (k * k), 1e-12);
  EXPECT_TRUE(std::isfinite(loss.Cost(1e7)));
}

}  // namespace
}  // namespace hindsight
