#ifndef HINDSIGHT_MEASUREMENTS_ROBUST_LOSS_H_
#define HINDSIGHT_MEASUREMENTS_ROBUST_LOSS_H_

namespace hindsight {

/// A robust loss rho of s = |whitened residual|^2 (all rows of a measurement
/// together). `scale` is c, in standard deviations.
///   none           rho = s
///   Huber          s, beyond c^2: 2 c sqrt(s) - c^2
///   Cauchy         c^2 log(1 + s/c^2)
///   Tukey          c^2/3 (1 - (1 - s/c^2)^3), beyond c^2: c^2/3
///   Geman-McClure  c^2 s/(c^2 + s)
/// For a measurement of three rows scales of 3 (Huber, Cauchy), 7 (Tukey) and 6
/// (Geman-McClure) cost good data little.
/// The last three redescend: their problem has local minima, and the batch
/// approaches them by graduated non-convexity.
struct RobustLoss {
  enum class Kind { kNone, kHuber, kCauchy, kTukey, kGemanMcClure };
  Kind kind = Kind::kNone;
  double scale = 3.0;

  bool redescends() const { return kind > Kind::kHuber; }
  /// rho(s).
  double Cost(double s) const;
  /// rho'(s), the factor by which the measurement's information counts.
  double Weight(double s) const;
  /// rho''(s).
  double Curvature(double s) const;
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_ROBUST_LOSS_H_
