#include "imu/sample_facts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "imu/imu_stream.h"

namespace hindsight {
namespace {

/// Counts the different intervals, as long as they are few.
class IntervalCounter {
 public:
  void Add(double interval) {
    if (slots_.empty()) return;
    Slot* slot = Find(interval);
    if (slot->count++ == 0 && ++different_ > kMost) slots_.clear();
  }

  std::optional<std::vector<IntervalCount>> Counts() const {
    if (slots_.empty()) return std::nullopt;
    std::vector<IntervalCount> counts;
    for (const Slot& slot : slots_) {
      if (slot.count > 0) counts.push_back(slot);
    }
    std::sort(counts.begin(), counts.end(),
              [](const IntervalCount& a, const IntervalCount& b) {
                return a.interval < b.interval;
              });
    return counts;
  }

 private:
  using Slot = IntervalCount;
  static constexpr std::size_t kMost = 512;
  static constexpr int kLogSlots = 11;
  static constexpr std::size_t kSlots = std::size_t{1} << kLogSlots;
  static_assert(kSlots >= 4 * kMost);

  /// Where it is counted, or will be.
  Slot* Find(double interval) {
    // Those of one rate differ in the last bits alone; Fibonacci hashing spreads
    // them.
    constexpr std::uint64_t kFactor = 0x9E3779B97F4A7C15;
    std::size_t at =
        (std::bit_cast<std::uint64_t>(interval) * kFactor) >> (64 - kLogSlots);
    while (slots_[at].count > 0 && slots_[at].interval != interval) {
      at = (at + 1) % kSlots;
    }
    slots_[at].interval = interval;
    return &slots_[at];
  }

  std::vector<Slot> slots_ = std::vector<Slot>(kSlots);
  std::size_t different_ = 0;
};

/// The mean of the specific force over the second in which it varies least.
class QuietestSecond {
 public:
  void Add(double dt, const Eigen::Vector3d& f, double squared_norm) {
    sum_ += dt * f;
    squares_ += dt * squared_norm;
    duration_ += dt;
    if (duration_ >= 1.0) End();
  }

  /// Of a shorter record, the mean over all of it.
  Eigen::Vector3d mean() const {
    return std::isfinite(least_) ? mean_ : Eigen::Vector3d(sum_ / duration_);
  }

 private:
  void End() {
    const Eigen::Vector3d mean = sum_ / duration_;
    const double variance = squares_ / duration_ - mean.squaredNorm();
    if (variance < least_) {
      least_ = variance;
      mean_ = mean;
    }
    sum_.setZero();
    squares_ = duration_ = 0.0;
  }

  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  double squares_ = 0.0;
  double duration_ = 0.0;
  double least_ = std::numeric_limits<double>::infinity();
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
};

class ReadingSums {
 public:
  explicit ReadingSums(bool increments) : increments_(increments) {}

  void Add(double dt, const ImuSample& sample) {
    facts_.accel_sum += sample.accel;
    const double scale = increments_ ? 1.0 / dt : 1.0;
    const Eigen::Vector3d f = scale * sample.accel;
    const double f2 = f.squaredNorm();
    facts_.mean_force += dt * std::sqrt(f2);
    facts_.mean_force_b += dt * f;
    duration_ += dt;
    max_f2_ = std::max(max_f2_, f2);
    max_w2_ = std::max(max_w2_, (scale * sample.gyro).squaredNorm());
    quietest_.Add(dt, f, f2);
  }
  void AddFirst(const ImuSample& sample) { facts_.accel_sum += sample.accel; }

  ReadingFacts Facts() const {
    ReadingFacts facts = facts_;
    facts.mean_force /= duration_;
    facts.mean_force_b /= duration_;
    facts.max_force = std::sqrt(max_f2_);
    facts.max_rate = std::sqrt(max_w2_);
    facts.quietest_force = quietest_.mean();
    return facts;
  }

 private:
  bool increments_;
  ReadingFacts facts_;
  double duration_ = 0.0;
  double max_f2_ = 0.0;
  double max_w2_ = 0.0;
  QuietestSecond quietest_;
};

/// Without a branch for each axis: hardly any is equal.
int EqualReadings(const ImuSample& a, const ImuSample& b) {
  int equal = 0;
  for (int i = 0; i < 3; ++i) {
    equal += static_cast<int>(a.gyro(i) == b.gyro(i)) +
             static_cast<int>(a.accel(i) == b.accel(i));
  }
  return equal;
}

SampleFacts FindFacts(const ImuStream& stream) {
  constexpr int kChannels = 6;
  const bool increments = stream.kind == ImuStream::Kind::kIncrements;
  SampleFacts facts;
  if (stream.samples.empty()) return facts;
  facts.repeats.resize((stream.samples.size() - 1) / SampleFacts::kRepeatPiece +
                       1);
  IntervalCounter intervals;
  ReadingSums readings(increments);
  readings.AddFirst(stream.samples[0]);
  const std::size_t first_row = increments ? 1 : 0;
  ImuSample before = stream.samples[0];
  for (std::size_t k = 1; k < stream.samples.size();) {
    for (const ImuSample& sample : stream.samples.Piece(k)) {
      const double dt = sample.t - before.t;
      if (stream.IsDropOut(dt)) facts.drop_outs.push_back(k);
      if (k > first_row) intervals.Add(dt);
      readings.Add(dt, sample);
      if (const int equal = EqualReadings(before, sample); equal > 0) {
        facts.repeats[k / SampleFacts::kRepeatPiece] = true;
        if (equal == kChannels) ++facts.whole_repeats;
      }
      before = sample;
      ++k;
    }
  }
  facts.intervals = intervals.Counts();
  facts.readings = readings.Facts();
  return facts;
}

}  // namespace

SampleFactsMemo& SampleFactsMemo::operator=(const SampleFactsMemo& other) {
  if (this == &other) return *this;
  const std::scoped_lock guard(mutex_, other.mutex_);
  key_ = other.key_;
  facts_ = other.facts_;
  return *this;
}

std::shared_ptr<const SampleFacts> SampleFactsMemo::Of(
    const ImuStream& stream) const {
  const Key key = {stream.samples.version(), static_cast<int>(stream.kind),
                   stream.nominal_dt};
  const std::lock_guard<std::mutex> guard(mutex_);
  if (facts_ == nullptr || key != key_) {
    facts_ = std::make_shared<const SampleFacts>(FindFacts(stream));
    key_ = key;
  }
  return facts_;
}

std::shared_ptr<const SampleFacts> FactsOf(const ImuStream& stream) {
  return stream.facts.Of(stream);
}

}  // namespace hindsight
