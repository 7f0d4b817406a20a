#ifndef HINDSIGHT_RECEIVER_ERRORS_SENSOR_TAPE_H_
#define HINDSIGHT_RECEIVER_ERRORS_SENSOR_TAPE_H_

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "filters/linear_tape.h"
#include "linear/sparse_product.h"
#include "receiver_errors/onset.h"

namespace hindsight {

/// A tape on which errors (e, r) of one of its sensors are sought, three axes each: what
/// every hypothesis meets alike at a node is prepared once, as a search passes over the
/// nodes a thousand times.
class SensorTape {
 public:
  /// The tape must outlive this.
  SensorTape(const LinearTape& tape, int sensor);

  const LinearTape& linear() const { return tape_; }
  int sensor() const { return sensor_; }
  std::size_t size() const { return nodes_.size(); }
  int dim() const { return tape_.dim(); }
  double t(std::size_t k) const { return tape_.t(k); }

  /// Whether the node has a fix of the sensor that is used.
  bool HasFix(std::size_t k) const { return nodes_[k].has_fix; }
  std::size_t fix_count() const { return fix_count_; }
  /// What the interval since the fix before is of the recording, 0 without a fix:
  /// by the mean interval and the number of fixes, of which twenty are the least. A gap is
  /// as many as it lacks.
  double share(std::size_t k) const { return nodes_[k].share; }
  /// Of a drift that begins: since the fix before. It lacks a fix where it is more than 1.5
  /// times the median of those between fixes.
  const UnseenTime& unseen_drift(std::size_t k) const {
    return nodes_[k].unseen_drift;
  }
  /// Of a velocity step before a fix: the same since the last node that saw the position, to
  /// a kilometre or better, or had a fix of the sensor.
  const UnseenTime& unseen_step(std::size_t k) const {
    return nodes_[k].unseen_step;
  }
  /// With the transition of the interval that ends at node k >= 1.
  const SparseCongruence& OverInterval(std::size_t k) const {
    return nodes_[k].over_interval;
  }
  /// Components of the tape's errors that have any process noise at all.
  const std::vector<Eigen::Index>& noisy() const { return noisy_; }

 private:
  struct Node {
    bool has_fix = false;
    double share = 0.0;
    UnseenTime unseen_drift;
    UnseenTime unseen_step;
    SparseCongruence over_interval;
  };

  void SetShares();
  void SetNoisy();

  const LinearTape& tape_;
  int sensor_;
  std::vector<Node> nodes_;
  std::vector<Eigen::Index> noisy_;
  std::size_t fix_count_ = 0;
};

/// Whether the node has a fix of the sensor that is used.
bool HasFix(const LinearTape& tape, std::size_t k, int sensor);
/// By node: SensorTape::unseen_drift.
std::vector<UnseenTime> UnseenSinceFix(const LinearTape& tape, int sensor);
/// By node: SensorTape::unseen_step; of length 0 where there is none, as without a fix.
std::vector<UnseenTime> UnseenSincePosition(const LinearTape& tape, int sensor);
/// The fixes, counted from 0, before which there are none for longer than
/// LongestSpacingWithoutGap, in order.
std::vector<std::size_t> FixesBehindGaps(const SensorTape& tape);
/// The most rows that a measurement of the sensor has.
int RowsOf(const LinearTape& tape, int sensor);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_SENSOR_TAPE_H_
