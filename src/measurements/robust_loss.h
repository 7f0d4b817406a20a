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
///   mixture        -2 ln((1 - a) exp(-s/2) + a k^-n exp(-s/(2 k^2))) + const
/// The mixture is the likelihood of n rows that are, with probability a,
/// outliers of k times the standard deviation; its weight is the expectation
/// step of expectation-maximisation,
///   rho' = g + (1 - g)/k^2,   g = probability of an inlier given s
/// (Pfeifer and Protzel, ICRA 2019).
/// For a measurement of three rows scales of 3 (Huber, Cauchy), 7 (Tukey) and 6
/// (Geman-McClure) cost good data little.
/// The last three redescend: their problem has local minima, and the batch
/// approaches them by graduated non-convexity.
struct RobustLoss {
  enum class Kind { kNone, kHuber, kCauchy, kTukey, kGemanMcClure, kMixture };
  Kind kind = Kind::kNone;
  double scale = 3.0;           ///< c; of a mixture 1, but for widening
  double outlier_share = 0.05;  ///< a
  double outlier_ratio = 20.0;  ///< k
  int rows = 3;  ///< n; see OfRows: a sensor's may differ from one to another

  /// The loss of a measurement that has so many rows.
  RobustLoss OfRows(int count) const;

  bool redescends() const { return kind > Kind::kHuber; }
  /// Of a mixture: probability that s is of an inlier.
  double InlierProbability(double s) const;
  /// rho(s).
  double Cost(double s) const;
  /// rho'(s), the factor by which the measurement's information counts.
  double Weight(double s) const;
  /// rho''(s).
  double Curvature(double s) const;
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_ROBUST_LOSS_H_
