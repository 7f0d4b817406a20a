#ifndef HINDSIGHT_RECEIVER_ERRORS_SEARCH_EFFORT_H_
#define HINDSIGHT_RECEIVER_ERRORS_SEARCH_EFFORT_H_

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>

namespace hindsight {

/// What a search may still cost, in filter steps: one hypothesis carried over
/// one node. A count and no clock, so that the same data give the same result;
/// whoever asks may end the search earlier.
class SearchEffort {
 public:
  /// Told the fraction of the effort that is spent, in [0, 1]; false ends the
  /// search with the best found so far; may throw to abandon it.
  using GoOn = std::function<bool(double)>;

  SearchEffort(double most, GoOn go_on)
      : most_(most), go_on_(std::move(go_on)) {}

  void Spend(std::size_t steps) {
    spent_ += static_cast<double>(steps);
    if (go_on_ && !stopped_) {
      stopped_ = !go_on_(std::min(1.0, spent_ / most_));
    }
  }
  /// Nothing more is to be tried.
  bool IsSpent() const { return stopped_ || spent_ >= most_; }
  double spent() const { return spent_; }
  /// What is left, at least 0; none once it was ended by whoever asked.
  double left() const { return stopped_ ? 0.0 : std::max(0.0, most_ - spent_); }
  /// Ended by whoever asked, not by the count.
  bool stopped() const { return stopped_; }

 private:
  double most_;
  double spent_ = 0.0;
  bool stopped_ = false;
  GoOn go_on_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_SEARCH_EFFORT_H_
