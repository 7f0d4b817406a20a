#include "problems/blunders.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace hindsight {
namespace {

struct Position {
  std::size_t index;
  double t;
  Eigen::Vector3d p_e;
};

std::vector<Position> PositionsOf(const Timeline& timeline, int sensor) {
  std::vector<Position> all;
  for (std::size_t i = 0; i < timeline.all_measurements().size(); ++i) {
    const Measurement& z = timeline.all_measurements()[i];
    const auto* fix = std::get_if<PositionFix>(&z.model);
    if (fix == nullptr || z.sensor != sensor || z.withheld) continue;
    all.push_back({i, z.t, fix->p_e});
  }
  return all;
}

/// Those that cannot be reached from the possible ones before them.
template <typename Iterator>
std::vector<std::size_t> Unreachable(Iterator begin, Iterator end) {
  constexpr double kMayErr = 1e3;  // [m]
  std::vector<std::size_t> out;
  if (begin == end) return out;
  Iterator last = begin;
  for (Iterator one = std::next(begin); one != end; ++one) {
    const double reach =
        kMayErr + kImpossibleSpeed * std::abs(one->t - last->t);
    if ((one->p_e - last->p_e).norm() > reach) {
      out.push_back(one->index);
    } else {
      last = one;
    }
  }
  return out;
}

}  // namespace

std::vector<std::size_t> FindBlunders(const Timeline& timeline) {
  std::vector<std::size_t> blunders;
  for (std::size_t i = 0; i < timeline.sensors().size(); ++i) {
    const std::vector<Position> all =
        PositionsOf(timeline, static_cast<int>(i));
    std::vector<std::size_t> out = Unreachable(all.begin(), all.end());
    std::vector<std::size_t> back = Unreachable(all.rbegin(), all.rend());
    if (back.size() < out.size()) out = std::move(back);
    if (2 * out.size() > all.size()) continue;
    blunders.insert(blunders.end(), out.begin(), out.end());
  }
  std::sort(blunders.begin(), blunders.end());
  return blunders;
}

}  // namespace hindsight
