#include "dataset/clock_windows.h"

#include <Eigen/SVD>
#include <algorithm>
#include <utility>

#include "base/median.h"

namespace hindsight {

double MedianStep(const std::vector<double>& t) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < t.size(); ++k) steps.push_back(t[k] - t[k - 1]);
  return Median(std::move(steps));
}

ClockWindows MakeWindows(const std::vector<double>& t, double length,
                         bool triples, double piece) {
  constexpr std::size_t kMost = 2000;
  constexpr double kSlack = 1e-3;  // stamps jitter [s]
  ClockWindows out;
  out.length = std::max(length, MedianStep(t));
  const auto after = [&](std::size_t k) {
    return static_cast<std::size_t>(
        std::lower_bound(t.begin(), t.end(), t[k] + out.length - kSlack) -
        t.begin());
  };
  const auto is_long = [&](std::size_t from, std::size_t to) {
    return t[to] - t[from] > 2.0 * out.length;
  };
  for (std::size_t k = 0; k < t.size(); ++k) {
    const std::size_t middle = after(k);
    if (middle >= t.size() || is_long(k, middle)) continue;
    const std::size_t end = triples ? after(middle) : middle;
    if (end >= t.size() || is_long(middle, end)) continue;
    out.windows.push_back(
        {k, middle, end, static_cast<int>((t[k] - t.front()) / piece)});
  }
  if (out.windows.size() <= kMost) return out;
  std::vector<ClockWindows::Window> thinned;
  for (std::size_t i = 0; i < kMost; ++i) {
    thinned.push_back(out.windows[i * out.windows.size() / kMost]);
  }
  out.windows = std::move(thinned);
  return out;
}

double ClockWindows::IndependentWindows(const std::vector<double>& t) const {
  double count = 0.0;
  double covered = -1e300;
  for (const Window& window : windows) {
    if (t[window.begin] < covered) continue;
    covered = t[window.end];
    count += 1.0;
  }
  return count;
}

double CommonMotion::Motion() const {
  const double n = std::max(count_, 1);
  return 0.5 * (square_a_ - sum_a_.squaredNorm() / n + square_b_ -
                sum_b_.squaredNorm() / n);
}

double CommonMotion::LeftByRotation() const {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
      cross_, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d s = svd.singularValues();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) {
    s.z() = -s.z();
  }
  return std::max(0.0, square_a_ + square_b_ - 2.0 * s.sum());
}

double CommonMotion::LeftByConstant() const {
  const double n = std::max(count_, 1);
  return std::max(0.0, square_a_ + square_b_ - 2.0 * cross_.trace() -
                           (sum_a_ - sum_b_).squaredNorm() / n);
}

}  // namespace hindsight
