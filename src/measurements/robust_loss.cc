#include "measurements/robust_loss.h"

#include <algorithm>
#include <cmath>

namespace hindsight {

namespace {

/// Logarithm of the odds of an inlier.
double LogOdds(const RobustLoss& loss, double s) {
  const double a = loss.outlier_share;
  const double k2 = loss.outlier_ratio * loss.outlier_ratio;
  return std::log((1.0 - a) / a) + 0.5 * loss.rows * std::log(k2) -
         0.5 * s * (1.0 - 1.0 / k2);
}

/// ln of the inlier probability, for any odds.
double LogInlier(double log_odds) {
  return std::min(log_odds, 0.0) - std::log1p(std::exp(-std::abs(log_odds)));
}

}  // namespace

RobustLoss RobustLoss::OfRows(int count) const {
  RobustLoss loss = *this;
  loss.rows = count;
  return loss;
}

double RobustLoss::InlierProbability(double s) const {
  return std::exp(LogInlier(LogOdds(*this, s)));
}

double RobustLoss::Cost(double s) const {
  const double c2 = scale * scale;
  switch (kind) {
    case Kind::kNone:
      return s;
    case Kind::kHuber:
      return s <= c2 ? s : 2.0 * scale * std::sqrt(s) - c2;
    case Kind::kCauchy:
      return c2 * std::log1p(s / c2);
    case Kind::kTukey: {
      const double u = s < c2 ? 1.0 - s / c2 : 0.0;
      return c2 / 3.0 * (1.0 - u * u * u);
    }
    case Kind::kGemanMcClure:
      return c2 * s / (c2 + s);
    case Kind::kMixture:
      // -2 ln of the mixture is s + 2 ln g but for a constant.
      return s + 2.0 * c2 *
                     (LogInlier(LogOdds(*this, s / c2)) -
                      LogInlier(LogOdds(*this, 0.0)));
  }
  return s;
}

double RobustLoss::Weight(double s) const {
  const double c2 = scale * scale;
  switch (kind) {
    case Kind::kNone:
      return 1.0;
    case Kind::kHuber:
      return s <= c2 ? 1.0 : scale / std::sqrt(s);
    case Kind::kCauchy:
      return c2 / (c2 + s);
    case Kind::kTukey: {
      const double u = s < c2 ? 1.0 - s / c2 : 0.0;
      return u * u;
    }
    case Kind::kGemanMcClure:
      return c2 * c2 / ((c2 + s) * (c2 + s));
    case Kind::kMixture: {
      const double g = InlierProbability(s / c2);
      return g + (1.0 - g) / (outlier_ratio * outlier_ratio);
    }
  }
  return 1.0;
}

double RobustLoss::Curvature(double s) const {
  const double c2 = scale * scale;
  switch (kind) {
    case Kind::kNone:
      return 0.0;
    case Kind::kHuber:
      return s <= c2 ? 0.0 : -0.5 * scale / (s * std::sqrt(s));
    case Kind::kCauchy:
      return -c2 / ((c2 + s) * (c2 + s));
    case Kind::kTukey:
      return s < c2 ? -2.0 * (1.0 - s / c2) / c2 : 0.0;
    case Kind::kGemanMcClure:
      return -2.0 * c2 * c2 / ((c2 + s) * (c2 + s) * (c2 + s));
    case Kind::kMixture: {
      const double g = InlierProbability(s / c2);
      const double slope = 1.0 - 1.0 / (outlier_ratio * outlier_ratio);
      return -0.5 * slope * slope * g * (1.0 - g) / c2;
    }
  }
  return 0.0;
}

}  // namespace hindsight
