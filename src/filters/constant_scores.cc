#include "filters/constant_scores.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "base/chi_square.h"
#include "filters/tape_gains.h"

namespace hindsight {
namespace {

/// What one epoch adds: a row a constant.
struct EpochScore {
  double t = 0.0;
  Eigen::VectorXd score;     ///< w nu
  Eigen::VectorXd variance;  ///< w S w'
};

EpochScore ScoreOf(const LinearTape& tape, std::size_t k,
                   const Eigen::MatrixXd& covariance) {
  EpochScore out{tape.t(k), Eigen::VectorXd::Zero(covariance.cols()),
                 Eigen::VectorXd::Zero(covariance.cols())};
  for (const TapeMeasurement& z : tape.measurements(k)) {
    if (!z.accepted) continue;
    const Eigen::MatrixXd w =
        Eigen::LLT<Eigen::MatrixXd>(z.S).solve(z.H * covariance).transpose();
    out.score += w * z.innovation;
    out.variance += (w * z.S).cwiseProduct(w).rowwise().sum();
  }
  return out;
}

/// Of the epochs with measurements, in order of time.
std::vector<EpochScore> ScoreEpochs(const LinearTape& tape,
                                    std::span<const int> components) {
  std::vector<EpochScore> all;
  const std::size_t last = tape.size() - 1;
  Eigen::MatrixXd covariance(tape.dim(),
                             static_cast<Eigen::Index>(components.size()));
  const ErrorMatrix P = tape.P_plus(last);
  for (std::size_t i = 0; i < components.size(); ++i) {
    covariance.col(static_cast<Eigen::Index>(i)) = P.col(components[i]);
  }
  for (std::size_t k = last + 1; k-- > 0;) {
    if (k < last) covariance = Smoothed(tape, k, covariance);
    if (!tape.measurements(k).empty()) {
      all.push_back(ScoreOf(tape, k, covariance));
    }
  }
  std::reverse(all.begin(), all.end());
  return all;
}

/// Sums over blocks of one duration, of one constant.
struct BlockSums {
  double squares = 0.0;           ///< of the scores' sums
  std::vector<double> variances;  ///< of each block

  void Add(double score, double v) {
    squares += score * score;
    variances.push_back(v);
  }
};

std::vector<BlockSums> SumBlocks(const std::vector<EpochScore>& all,
                                 double duration) {
  const Eigen::Index count = all.front().score.size();
  std::vector<BlockSums> sums(static_cast<std::size_t>(count));
  Eigen::VectorXd score = Eigen::VectorXd::Zero(count);
  Eigen::VectorXd variance = score;
  double block = 0.0;
  const auto close = [&] {
    for (Eigen::Index i = 0; i < count; ++i) {
      sums[static_cast<std::size_t>(i)].Add(score(i), variance(i));
    }
    score.setZero();
    variance.setZero();
  };
  for (const EpochScore& one : all) {
    const double own = std::floor((one.t - all.front().t) / duration);
    if (own != block) close();
    block = own;
    score += one.score;
    variance += one.variance;
  }
  close();
  return sums;
}

std::vector<double> Durations(const std::vector<EpochScore>& all) {
  double shortest = all.back().t - all.front().t;
  double duration = shortest / 4.0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    shortest = std::min(shortest, all[i].t - all[i - 1].t);
  }
  std::vector<double> durations;
  for (; duration >= shortest && duration > 0.0; duration /= 2.0) {
    durations.push_back(duration);
  }
  return durations;
}

}  // namespace

std::vector<double> ExcessOfConstants(const LinearTape& tape,
                                      std::span<const int> components,
                                      double false_alarms) {
  RequireFixedNominal(tape);
  std::vector<double> factors(components.size(), 1.0);
  if (components.empty()) return factors;
  const std::vector<EpochScore> all = ScoreEpochs(tape, components);
  if (all.size() < 2) return factors;
  const std::vector<double> durations = Durations(all);
  const double tail =
      false_alarms / static_cast<double>(durations.size() * factors.size());
  for (const double duration : durations) {
    const std::vector<BlockSums> sums = SumBlocks(all, duration);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const BlockSums& own = sums[i];
      const double variance =
          std::accumulate(own.variances.begin(), own.variances.end(), 0.0);
      if (!(variance > 0.0) ||
          own.squares < WeightedChiSquareQuantile(own.variances, tail)) {
        continue;
      }
      factors[i] = std::max(factors[i], std::sqrt(own.squares / variance));
    }
  }
  return factors;
}

}  // namespace hindsight
