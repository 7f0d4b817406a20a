#ifndef HINDSIGHT_BASE_CHI_SQUARE_H_
#define HINDSIGHT_BASE_CHI_SQUARE_H_

#include <span>

namespace hindsight {

/// x with P(chi^2 <= x) = probability, for `dof` > 0 degrees of freedom and a
/// probability in [0, 1). Throws std::domain_error outside.
double ChiSquareQuantile(double probability, double dof);

/// P(chi^2 <= x) for x >= 0.
double ChiSquareCdf(double x, double dof);

/// x that a weighted sum of squares of independent N(0, 1) variables exceeds
/// with the probability `tail`: from Lugannani and Rice's saddlepoint
/// approximation (Kuonen 1999), whose tails are right to a tenth of
/// themselves; that of the sum's mean or less is not asked for, `tail` <= 0.3.
/// Weights that are not positive are left out; 0 of none.
double WeightedChiSquareQuantile(std::span<const double> weights, double tail);

struct Interval {
  double lower = 0.0;
  double upper = 0.0;
  bool Contains(double x) const { return lower <= x && x <= upper; }
};

/// Two-sided bounds of the average over `runs` independent normalised squared
/// errors of `dof` degrees of freedom each, if the estimator is consistent:
/// runs * average is chi-square with runs * dof degrees of freedom (Bar-Shalom,
/// Li, Kirubarajan 2001, section 5.4). `confidence` in (0, 1), for example
/// 0.95.
Interval AneesBounds(int runs, int dof, double confidence);

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_CHI_SQUARE_H_
