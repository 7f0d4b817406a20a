#ifndef HINDSIGHT_DATASET_TIMELINE_BUILDER_H_
#define HINDSIGHT_DATASET_TIMELINE_BUILDER_H_

#include <optional>
#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "timeline/timeline.h"

namespace hindsight {

/// Times so near are one instant, rounded [s].
inline constexpr double kSameTime = 1e-7;

struct TimelineOptions {
  double t_begin = 0.0;             ///< first node [s]
  double t_end = 0.0;               ///< last node [s]
  std::vector<double> extra_times;  ///< further nodes, any order
  /// Where to place each sensor's nodes, stamp + offset [s]; empty: at the
  /// sensors' own time offsets.
  std::vector<double> time_offsets;
  bool with_scale_jacobians = false;
};

/// What is wrong with Dataset::max_node_spacing, if anything: it is shorter than
/// the IMU's sample interval.
std::optional<std::string> WhyNotNodes(const Dataset& dataset);

/// Turns a data set into nodes and measurements. A node stands at every time an
/// aiding sensor measured (stamp + time offset: nothing is rounded to a
/// neighbour; times within kSameTime are one node), at every extra time, at
/// both ends, and between these so often that no interval is longer than
/// Dataset::max_node_spacing; with distance increments than 0.2 s, and a node
/// stands at the beginning of each. `dataset.imu` must outlive the timeline.
Timeline BuildTimeline(const Dataset& dataset, const TimelineOptions& options);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_TIMELINE_BUILDER_H_
