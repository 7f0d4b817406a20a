#ifndef HINDSIGHT_FILTERS_FIXED_TRANSITIONS_H_
#define HINDSIGHT_FILTERS_FIXED_TRANSITIONS_H_

#include <cstddef>
#include <future>
#include <span>
#include <vector>

#include "timeline/time_update.h"

namespace hindsight {

/// Transitions between the nodes of a nominal trajectory that no update moves: they
/// wait for no measurement, and are linearised beside the pass that uses them.
class FixedTransitions {
 public:
  struct Step {
    double dt = 0.0;  ///< [s]
    Transition transition;
  };

  /// What the arguments refer to must outlive the object; meanwhile nobody else
  /// integrates or asks for summaries of the timeline.
  FixedTransitions(const ErrorLayout& layout, std::span<const State> nominal,
                   Timeline* timeline)
      : layout_(layout), nominal_(nominal), timeline_(*timeline) {}

  /// Over the interval that ends at node k, 0 < k < nominal.size(); to be asked for
  /// in order. Valid until the next call.
  const Step& To(std::size_t k);

 private:
  /// Of the interval that ends at node `first` and those behind it.
  void Linearize(std::size_t first, std::vector<Step>* steps);

  const ErrorLayout& layout_;
  std::span<const State> nominal_;
  Timeline& timeline_;
  std::vector<Step> steps_;
  std::size_t first_ = 1;  ///< node at whose end the first of them is
  std::vector<Step> next_;
  std::future<void>
      ahead_;  ///< until they are there; the last member: it waits
};

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_FIXED_TRANSITIONS_H_
