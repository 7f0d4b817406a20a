#include "base/chi_square.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace hindsight {

double ChiSquareQuantile(double probability, double dof) {
  return boost::math::quantile(boost::math::chi_squared(dof), probability);
}

double ChiSquareCdf(double x, double dof) {
  return boost::math::cdf(boost::math::chi_squared(dof), x);
}

namespace {

/// The sum of weighted squares at a saddlepoint zeta / (2 largest weight): its
/// value there and the logarithm of the probability of more.
struct Saddle {
  double value = 0.0;
  double log_tail = 0.0;
};

/// `weights` over the largest of them, zeta in (0, 1).
Saddle SaddleAt(const std::vector<double>& weights, double zeta) {
  double cumulant = 0.0, value = 0.0, curvature = 0.0;
  for (const double weight : weights) {
    const double rest = 1.0 - zeta * weight;
    cumulant -= 0.5 * std::log(rest);
    value += weight / rest;
    curvature += 2.0 * (weight / rest) * (weight / rest);
  }
  const double w = std::sqrt(std::max(zeta * value - 2.0 * cumulant, 0.0));
  const double v = 0.5 * zeta * std::sqrt(curvature);
  const double normal = w + std::log(v / w) / w;
  // Where it is no number any more it is far below what is asked for.
  constexpr double kLeast = 1e-300;
  return {value, std::log(std::max(
                     0.5 * std::erfc(normal / std::numbers::sqrt2), kLeast))};
}

}  // namespace

double WeightedChiSquareQuantile(std::span<const double> weights, double tail) {
  const double largest =
      weights.empty() ? 0.0 : *std::max_element(weights.begin(), weights.end());
  if (!(largest > 0.0)) return 0.0;
  std::vector<double> relative;
  for (const double weight : weights) {
    if (weight > 0.0) relative.push_back(weight / largest);
  }
  const double wanted = std::log(tail);
  // In u = -log(1 - zeta), in which the tail falls about evenly; below the
  // first end the formula is 0/0.
  const auto at = [&](double u) { return SaddleAt(relative, -std::expm1(-u)); };
  std::uintmax_t iterations = 200;
  const auto [low, high] = boost::math::tools::toms748_solve(
      [&](double u) { return at(u).log_tail - wanted; }, 1e-3, 30.0,
      boost::math::tools::eps_tolerance<double>(40), iterations);
  return largest * at(0.5 * (low + high)).value;
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
