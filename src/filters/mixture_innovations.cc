#include "filters/mixture_innovations.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

namespace hindsight {
namespace {

/// Beyond it a normal tail is no normal number any more.
constexpr double kLargestScore = 37.0;

double UpperTail(double x) { return 0.5 * std::erfc(x / std::numbers::sqrt2); }

/// The score whose tail is the mixture's, by the lesser tail: the other has no
/// digits left.
double Score(const Eigen::ArrayXd& weights, const Eigen::ArrayXd& x) {
  double above = 0.0, below = 0.0;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    above += weights(j) * UpperTail(x(j));
    below += weights(j) * UpperTail(-x(j));
  }
  const double tail =
      std::max(std::min(above, below), UpperTail(kLargestScore));
  const double size = std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * tail);
  return above < below ? size : -size;
}

/// exp(log_weights) over their sum.
Eigen::ArrayXd Weights(const Eigen::ArrayXd& log_weights) {
  const Eigen::ArrayXd weights = (log_weights - log_weights.maxCoeff()).exp();
  return weights / weights.sum();
}

}  // namespace

std::vector<MixtureInnovation> MixtureInnovations(const ImmTape& tape) {
  const auto models = static_cast<Eigen::Index>(tape.tapes.size());
  std::vector<MixtureInnovation> all;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    Eigen::ArrayXd log_weights = tape.epochs[k].predicted.array().log();
    const std::size_t count = tape.tapes.front().measurements(k).size();
    for (std::size_t i = 0; i < count; ++i) {
      const TapeMeasurement& first = tape.tapes.front().measurements(k)[i];
      if (!first.accepted) continue;
      const Eigen::Index rows = first.innovation.size();
      Eigen::ArrayXXd x(models, rows), log_scale(models, rows);
      for (Eigen::Index j = 0; j < models; ++j) {
        const TapeMeasurement& z =
            tape.tapes[static_cast<std::size_t>(j)].measurements(k)[i];
        const Eigen::LLT<RowMatrix> llt(z.S);
        x.row(j) = llt.matrixL().solve(z.innovation).transpose();
        log_scale.row(j) = llt.matrixLLT().diagonal().array().log().transpose();
      }
      MixtureInnovation& innovation = all.emplace_back();
      innovation.epoch = k;
      innovation.measurement = i;
      innovation.scores.resize(rows);
      for (Eigen::Index row = 0; row < rows; ++row) {
        innovation.scores(row) = Score(Weights(log_weights), x.col(row));
        log_weights -= 0.5 * x.col(row).square() + log_scale.col(row);
      }
    }
  }
  return all;
}

}  // namespace hindsight
