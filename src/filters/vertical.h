#ifndef HINDSIGHT_FILTERS_VERTICAL_H_
#define HINDSIGHT_FILTERS_VERTICAL_H_

#include <optional>

#include "timeline/timeline.h"

namespace hindsight {

/// True if the layout has a position whose down axis is masked: then the
/// vertical channel is not estimated and has to come from elsewhere.
bool MasksVertical(const ErrorLayout& layout);

/// Height and vertical velocity of a nominal from height measurements (Baek
/// 2019, where the 16 states have no vertical ones): at each node with one, the
/// height is the measured one and the vertical velocity its mean rate since the
/// height before, zero at the first.
class VerticalChannel {
 public:
  /// Overwrites both in `x`, the state at node k of the timeline; nothing if
  /// the node has no height measurement. Lever arms are taken off by the
  /// state's attitude.
  void Overwrite(const Timeline& timeline, std::size_t k,
                 const ErrorLayout& layout, State* x);

 private:
  struct Height {
    double t = 0.0;
    double value = 0.0;
  };
  std::optional<Height> last_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_VERTICAL_H_
