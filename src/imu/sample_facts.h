#ifndef HINDSIGHT_IMU_SAMPLE_FACTS_H_
#define HINDSIGHT_IMU_SAMPLE_FACTS_H_

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace hindsight {

struct ImuStream;

/// Of an interval between stamps, how often it comes.
struct IntervalCount {
  double interval = 0.0;  ///< [s]
  long count = 0;
};

/// What the readings of a record are as a whole, in body axes. Of increments,
/// they over their intervals.
struct ReadingFacts {
  Eigen::Vector3d accel_sum = Eigen::Vector3d::Zero();  ///< as they are read
  /// Means over time of the specific force and of its size [m/s^2].
  Eigen::Vector3d mean_force_b = Eigen::Vector3d::Zero();
  double mean_force = 0.0;
  double max_force = 0.0;  ///< [m/s^2]
  double max_rate = 0.0;   ///< [rad/s]
  /// Mean over the second in which the specific force varies least; of a shorter
  /// record, over all of it [m/s^2].
  Eigen::Vector3d quietest_force = Eigen::Vector3d::Zero();
};

/// What one walk along the samples of a record finds for all who ask.
struct SampleFacts {
  /// Samples of which `repeats` has one entry.
  static constexpr std::size_t kRepeatPiece = 4096;

  /// Sample numbers at the ends of drop-outs.
  std::vector<std::size_t> drop_outs;
  /// Intervals between rows of the file, ascending; none if there are more than
  /// some hundred different ones.
  std::optional<std::vector<IntervalCount>> intervals;
  ReadingFacts readings;
  /// Whether a sample of the piece has a reading of the one before, on any axis.
  std::vector<bool> repeats;
  std::size_t whole_repeats =
      0;  ///< samples with all readings of the one before
};

/// Of a record of two samples at least, of a shorter one the counts alone; found
/// when first asked for, and again once its samples, kind or nominal_dt have changed.
std::shared_ptr<const SampleFacts> FactsOf(const ImuStream& stream);

/// The facts that were found of a stream last.
class SampleFactsMemo {
 public:
  SampleFactsMemo() = default;
  SampleFactsMemo(const SampleFactsMemo& other) { *this = other; }
  SampleFactsMemo& operator=(const SampleFactsMemo& other);
  ~SampleFactsMemo() = default;

  /// Any thread may ask; the others wait.
  std::shared_ptr<const SampleFacts> Of(const ImuStream& stream) const;

 private:
  /// What the facts depend on.
  struct Key {
    std::uint64_t version = 0;  ///< of the samples
    int kind = 0;
    double nominal_dt = 0.0;

    bool operator==(const Key&) const = default;
  };

  mutable std::mutex mutex_;
  mutable Key key_;
  mutable std::shared_ptr<const SampleFacts> facts_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_SAMPLE_FACTS_H_
