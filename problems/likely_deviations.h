#ifndef HINDSIGHT_PROBLEMS_LIKELY_DEVIATIONS_H_
#define HINDSIGHT_PROBLEMS_LIKELY_DEVIATIONS_H_

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "filters/mean_shift.h"

namespace hindsight {

/// A deviation beyond its limit.
struct LikelyDeviation {
  MeanShift shift;
  double z = 0.0;
  double limit = 0.0;
  // Of one that comes and goes: of all additive columns of the group.
  std::vector<int> columns = {};
  Eigen::MatrixXd steps = {};

  double Excess() const { return std::abs(z) / limit; }
};

/// The likeliest deviations of each source beyond their limits, one a column
/// and course. No limit of a sensor's is below the least one, by sensor, nor any other's
/// below the smallest of these.
class LikelyDeviations {
 public:
  explicit LikelyDeviations(std::vector<double> least)
      : least_(std::move(least)) {}

  void Offer(LikelyDeviation one) {
    one.limit = std::max(one.limit, LeastOf(one.shift));
    if (!(std::abs(one.z) >= one.limit)) return;
    const Course course = !one.columns.empty() ? Course::kVaries
                          : one.shift.grows    ? Course::kGrows
                                               : Course::kStays;
    const int source = one.shift.of_state ? kState : one.shift.group;
    LikelyDeviation& best = best_[source][{one.shift.column, course}];
    if (best.limit == 0.0 || one.Excess() > best.Excess()) {
      best = std::move(one);
    }
  }

  /// By source, those farthest beyond their limits first.
  std::map<int, std::vector<LikelyDeviation>> Sorted() const {
    std::map<int, std::vector<LikelyDeviation>> all;
    for (const auto& [source, own] : best_) {
      for (const auto& [column, one] : own) all[source].push_back(one);
      std::stable_sort(all[source].begin(), all[source].end(),
                       [](const LikelyDeviation& a, const LikelyDeviation& b) {
                         return a.Excess() > b.Excess();
                       });
    }
    return all;
  }

 private:
  static constexpr int kState = -3;
  enum class Course { kStays, kGrows, kVaries };

  double LeastOf(const MeanShift& shift) const {
    if (least_.empty()) return 0.0;
    return shift.of_state || shift.group < 0
               ? *std::min_element(least_.begin(), least_.end())
               : least_[static_cast<std::size_t>(shift.group)];
  }

  std::vector<double> least_;
  std::map<int, std::map<std::pair<int, Course>, LikelyDeviation>> best_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_LIKELY_DEVIATIONS_H_
