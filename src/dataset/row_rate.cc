#include "dataset/row_rate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/median.h"
#include "imu/preintegration.h"

namespace hindsight {
namespace {

using Vectors = GravityBalance::Vectors;
using Span = GravityBalance::Span;

constexpr std::size_t kSpell = 16;  // rows of the shortest

/// Of each axis over the rows `at` to `at` + kSpell - 1.
struct Moments {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d deviation = Eigen::Vector3d::Zero();
};

Moments MomentsOf(Vectors values, std::size_t at) {
  Moments moments;
  Eigen::Array3d squares = Eigen::Array3d::Zero();
  for (std::size_t k = at; k < at + kSpell; ++k) {
    moments.mean += values[k];
    squares += values[k].array().square();
  }
  moments.mean /= static_cast<double>(kSpell);
  squares /= static_cast<double>(kSpell);
  moments.deviation = (squares - moments.mean.array().square()).max(0.0).sqrt();
  return moments;
}

/// Medians of the axes, over the rows that `taken` marks.
Eigen::Vector3d MedianOf(Vectors values, const std::vector<bool>& taken) {
  Eigen::Vector3d medians;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> of_axis;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (taken[k]) of_axis.push_back(values[k](axis));
    }
    medians(axis) = of_axis.empty() ? 0.0 : Median(std::move(of_axis));
  }
  return medians;
}

/// Rows at which the specific force is gravity, steady, and the rate small
/// beside what it is otherwise.
std::vector<bool> QuietRows(Vectors accel, Vectors gyro) {
  constexpr double kSteady = 0.03;  // of gravity
  constexpr double kAlike = 0.02;
  constexpr double kSlow = 0.1;  // of the root mean square rate
  const Eigen::Vector3d usual =
      MedianOf(gyro, std::vector<bool>(gyro.size(), true));
  double squares = 0.0;
  for (const Eigen::Vector3d& w : gyro) squares += (w - usual).squaredNorm();
  const double slow =
      kSlow * std::sqrt(squares / static_cast<double>(gyro.size()));
  std::vector<bool> quiet(accel.size(), false);
  for (std::size_t k = 0; k + kSpell <= accel.size(); ++k) {
    const Moments force = MomentsOf(accel, k);
    const Moments rate = MomentsOf(gyro, k);
    if (force.deviation.maxCoeff() < kSteady &&
        std::abs(force.mean.norm() - 1.0) < kAlike &&
        (rate.mean - usual).norm() < slow) {
      std::fill_n(quiet.begin() + static_cast<std::ptrdiff_t>(k), kSpell, true);
    }
  }
  return quiet;
}

std::vector<Span> SpansOf(const std::vector<bool>& quiet, Vectors accel) {
  constexpr std::size_t kLongest = 1000;  // rows
  std::vector<Span> spans;
  for (std::size_t k = kSpell; k < quiet.size(); ++k) {
    if (quiet[k] || !quiet[k - 1]) continue;
    std::size_t end = k;
    while (end < quiet.size() && !quiet[end]) ++end;
    if (end == quiet.size()) break;
    if (end - k <= kLongest) {
      spans.push_back({k - kSpell / 2, end + kSpell / 2,
                       MomentsOf(accel, k - kSpell).mean.normalized()});
    }
  }
  return spans;
}

/// The least on a grid of ln(rate), refined between its neighbours by golden
/// sections.
double LeastSquares(const GravityBalance& balance, double from, double to) {
  constexpr double kStep = 0.08;
  const auto squares = [&](double x) { return balance.Squares(std::exp(x)); };
  double best = from;
  double least = squares(from);
  for (double x = from + kStep; x <= to; x += kStep) {
    const double here = squares(x);
    if (here < least) {
      least = here;
      best = x;
    }
  }
  constexpr double kGolden = 0.6180339887;
  constexpr double kFine = 1e-4;
  double a = best - kStep;
  double b = best + kStep;
  while (b - a > kFine) {
    const double low = b - kGolden * (b - a);
    const double high = a + kGolden * (b - a);
    if (squares(low) < squares(high)) {
      b = high;
    } else {
      a = low;
    }
  }
  return 0.5 * (a + b);
}

/// Of ln(rate): the spans' errors are alike in no direction, so that each counts
/// by what it moves the estimate.
double SigmaOf(const GravityBalance& balance, double log_rate) {
  constexpr double kStep = 0.02;
  const auto low = balance.Residuals(std::exp(log_rate - kStep));
  const auto here = balance.Residuals(std::exp(log_rate));
  const auto high = balance.Residuals(std::exp(log_rate + kStep));
  double information = 0.0;
  double pull = 0.0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    const Eigen::Vector3d J = (high[i] - low[i]) / (2.0 * kStep);
    information += J.squaredNorm();
    pull += std::pow(J.dot(here[i]), 2);
  }
  const auto n = static_cast<double>(here.size());
  return std::sqrt(pull * n / (n - 1.0)) / information;
}

}  // namespace

GravityBalance::GravityBalance(Vectors accel, Vectors gyro) {
  constexpr std::size_t kMostRows = 60'000;
  const std::size_t rows = std::min({accel.size(), gyro.size(), kMostRows});
  accel_ = accel.first(rows);
  gyro_ = gyro.first(rows);
  if (rows < 2 * kSpell) return;
  const std::vector<bool> quiet = QuietRows(accel_, gyro_);
  bias_ = MedianOf(gyro_, quiet);
  spans_ = SpansOf(quiet, accel_);
  rows_.samples.reserve(rows);
  for (std::size_t k = 0; k < rows; ++k) {
    rows_.samples.push_back({static_cast<double>(k), gyro_[k], accel_[k]});
  }
}

std::vector<Eigen::Vector3d> GravityBalance::Residuals(double rate) const {
  // Rows are a unit of time apart, so that the rates count by 1/rate: as those
  // of gyros with that scale do.
  ImuCalibration calibration;
  calibration.b_g = bias_;
  calibration.s_g.setConstant(rate - 1.0);
  ImuIntegrator integrator(rows_);
  std::vector<Eigen::Vector3d> residuals;
  for (const Span& span : spans_) {
    ImuSummary mean = EmptyMean(static_cast<double>(span.begin), calibration);
    integrator.AppendMean(static_cast<double>(span.end - 1), &mean);
    residuals.emplace_back(mean.dv / mean.dt() - span.f_0);
  }
  return residuals;
}

double GravityBalance::Squares(double rate) const {
  double sum = 0.0;
  for (const Eigen::Vector3d& r : Residuals(rate)) sum += r.squaredNorm();
  return sum;
}

std::optional<RowRate> FindRowRate(Vectors accel, Vectors gyro) {
  constexpr double kCertain = 0.05;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double first = std::log(10.0);
  const double last = std::log(4000.0);
  const GravityBalance balance(accel, gyro);
  if (balance.spans().size() < kFewestBalanced) return std::nullopt;
  const double best = LeastSquares(balance, first, last);
  const double sigma = SigmaOf(balance, best);
  if (best <= first || best >= last || !(sigma < kCertain) ||
      balance.Squares(std::exp(best)) >
          kMostUnbalanced * balance.Squares(kNever)) {
    return std::nullopt;
  }
  return RowRate{std::exp(best), sigma, balance.spans().size()};
}

}  // namespace hindsight
