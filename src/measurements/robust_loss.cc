#include "measurements/robust_loss.h"

#include <cmath>

namespace hindsight {

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
  }
  return 0.0;
}

}  // namespace hindsight
