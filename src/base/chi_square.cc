#include "base/chi_square.h"

#include <boost/math/distributions/chi_squared.hpp>

namespace hindsight {

double ChiSquareQuantile(double probability, double dof) {
  return boost::math::quantile(boost::math::chi_squared(dof), probability);
}

double ChiSquareCdf(double x, double dof) {
  return boost::math::cdf(boost::math::chi_squared(dof), x);
}

Interval AneesBounds(int runs, int dof, double confidence) {
  const double n = runs;
  const double tail = 0.5 * (1.0 - confidence);
  const boost::math::chi_squared distribution(n * dof);
  return {
      boost::math::quantile(distribution, tail) / n,
      boost::math::quantile(boost::math::complement(distribution, tail)) / n};
}

}  // namespace hindsight
