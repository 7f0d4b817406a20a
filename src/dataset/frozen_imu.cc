#include "dataset/frozen_imu.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/median.h"
#include "dataset/resolution.h"

namespace hindsight {
namespace {

constexpr int kChannels = 6;  // three gyros, three accelerometers
constexpr ReadingRounding kUnitRounding = {.relative = 1e-12};

double ReadingOf(const ImuSample& sample, int channel) {
  return channel < 3 ? sample.gyro(channel) : sample.accel(channel - 3);
}

/// Channels [begin, end) together.
struct ChannelGroup {
  const char* name;
  int begin;
  int end;
};

constexpr ChannelGroup kWhole = {"", 0, kChannels};
constexpr ChannelGroup kParts[] = {
    {"gyro triad", 0, 3},      {"accelerometer triad", 3, 6},
    {"gyro x", 0, 1},          {"gyro y", 1, 2},
    {"gyro z", 2, 3},          {"accelerometer x", 3, 4},
    {"accelerometer y", 4, 5}, {"accelerometer z", 5, 6}};

/// Samples [begin, end) that are equal.
struct EqualSamples {
  std::size_t begin;
  std::size_t end;

  long rows() const { return static_cast<long>(end - begin); }
};

/// Channels whose reading is that of the sample before, a bit each.
unsigned Repeated(const PagedVector<ImuSample>& samples, std::size_t k) {
  const ImuSample& here = samples[k];
  const ImuSample& before = samples[k - 1];
  unsigned repeated = 0;
  for (int c = 0; c < kChannels; ++c) {
    if (ReadingOf(here, c) == ReadingOf(before, c)) repeated |= 1U << c;
  }
  return repeated;
}

unsigned ChannelsOf(const ChannelGroup& group) {
  return (1U << group.end) - (1U << group.begin);
}

/// Of each group those that chance does not explain, by one walk over a recording
/// of a day.
std::vector<std::vector<EqualSamples>> LongRuns(
    const ImuStream& imu, const std::vector<ChannelGroup>& groups) {
  constexpr std::size_t kPiece = SampleFacts::kRepeatPiece;
  const PagedVector<ImuSample>& samples = imu.samples;
  const auto facts = FactsOf(imu);
  std::vector<std::vector<EqualSamples>> found(groups.size());
  std::vector<std::size_t> begin(groups.size(), 0);
  unsigned before = 0;
  for (std::size_t k = 1; k <= samples.size(); ++k) {
    if (before == 0 && k < samples.size() && !facts->repeats[k / kPiece]) {
      k += kPiece - k % kPiece - 1;
      continue;
    }
    const unsigned repeated = k < samples.size() ? Repeated(samples, k) : 0U;
    if (repeated == 0 && before == 0) continue;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      const unsigned channels = ChannelsOf(groups[i]);
      const bool was_equal = (before & channels) == channels;
      const bool is_equal = (repeated & channels) == channels;
      if (is_equal && !was_equal) begin[i] = k - 1;
      if (was_equal && !is_equal) found[i].push_back({begin[i], k});
    }
    before = repeated;
  }
  for (std::vector<EqualSamples>& runs : found) {
    std::vector<long> rows;
    for (const EqualSamples& run : runs) rows.push_back(run.rows());
    std::sort(rows.begin(), rows.end());
    std::erase_if(runs, [&](const EqualSamples& run) {
      return samples[run.end - 1].t - samples[run.begin].t < kLeastFrozen ||
             IsByChance(rows, run.rows());
    });
  }
  return found;
}

/// Whether the readings of one channel tell a live sensor from a frozen one.
class LiveChannel {
 public:
  LiveChannel(const PagedVector<ImuSample>& samples, int channel)
      : samples_(samples), channel_(channel) {
    std::vector<double> values;
    std::vector<double> changes;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      values.push_back(Value(k));
      if (k == 0) continue;
      const double change = std::abs(Value(k) - Value(k - 1));
      if (change > 0.0) changes.push_back(change);
    }
    far_ = kStepsOfResolution * Resolution(std::move(values), kUnitRounding,
                                           ReadingCourse::kToAndFro);
    is_noisy_ = Median(std::move(changes)) > far_;
  }

  /// Whether the channel is alive beside a run that is not the whole record.
  bool LivesBeside(const EqualSamples& run) const {
    constexpr std::size_t kBeside = 10;  // rows
    const std::size_t first = run.begin - std::min(run.begin, kBeside);
    const std::size_t last = std::min(run.end + kBeside, samples_.size());
    return is_noisy_ && (run.begin > 0 || run.end < samples_.size()) &&
           IsFar(first, run.begin, Value(run.begin)) &&
           IsFar(run.end, last, Value(run.begin));
  }

 private:
  double Value(std::size_t k) const { return ReadingOf(samples_[k], channel_); }

  bool IsFar(std::size_t begin, std::size_t end, double held) const {
    if (begin == end) return true;
    std::vector<double> distances;
    for (std::size_t k = begin; k < end; ++k) {
      distances.push_back(std::abs(Value(k) - held));
    }
    return Median(std::move(distances)) > far_;
  }

  const PagedVector<ImuSample>& samples_;
  int channel_;
  double far_ = 0.0;
  bool is_noisy_ = false;
};

/// The median change of a channel from row to row over samples [begin, end).
double UsualStep(const PagedVector<ImuSample>& samples, int channel,
                 std::size_t begin, std::size_t end) {
  std::vector<double> changes;
  for (std::size_t k = begin + 1; k < end; ++k) {
    changes.push_back(std::abs(ReadingOf(samples[k], channel) -
                               ReadingOf(samples[k - 1], channel)));
  }
  return Median(std::move(changes));
}

/// Whether a channel changes during a run at least half as much as usual.
class Liveliness {
 public:
  Liveliness(const PagedVector<ImuSample>& samples, int channel)
      : samples_(samples),
        channel_(channel),
        usual_(UsualStep(samples, channel, 0, samples.size())) {}

  bool GoesOnDuring(const EqualSamples& run) const {
    return usual_ > 0.0 &&
           UsualStep(samples_, channel_, run.begin, run.end) >= 0.5 * usual_;
  }

 private:
  const PagedVector<ImuSample>& samples_;
  int channel_;
  double usual_;
};

/// Whether white noise makes most of what a channel changes from row to row:
/// its changes then differ from each other by more than their own size.
bool IsWhite(const PagedVector<ImuSample>& samples, int channel) {
  std::vector<double> changes;
  std::vector<double> differences;
  for (std::size_t k = 2; k < samples.size(); ++k) {
    const double last =
        ReadingOf(samples[k], channel) - ReadingOf(samples[k - 1], channel);
    const double before =
        ReadingOf(samples[k - 1], channel) - ReadingOf(samples[k - 2], channel);
    changes.push_back(std::abs(last));
    differences.push_back(std::abs(last - before));
  }
  return Median(std::move(differences)) > Median(std::move(changes));
}

/// Whether one axis is dead for the whole of a recording, where both others of
/// its triad show noise.
bool IsDeadAxis(const PagedVector<ImuSample>& samples,
                const ChannelGroup& group,
                const std::vector<EqualSamples>& runs) {
  constexpr std::size_t kLeastRows = 100;
  if (group.end - group.begin != 1 || runs.size() != 1) return false;
  if (runs[0].begin != 0 || runs[0].end != samples.size()) return false;
  if (samples.size() < kLeastRows) return false;
  const int triad = group.begin - group.begin % 3;
  for (int c = triad; c < triad + 3; ++c) {
    if (c != group.begin && !IsWhite(samples, c)) return false;
  }
  return true;
}

/// With which a group is compared: the other axes of a triad, or the other
/// triad.
std::vector<Liveliness> BesidesOf(const PagedVector<ImuSample>& samples,
                                  const ChannelGroup& group) {
  const bool is_axis = group.end - group.begin == 1;
  std::vector<Liveliness> besides;
  for (int c = 0; c < kChannels; ++c) {
    const bool same_triad = c / 3 == group.begin / 3;
    const bool inside = c >= group.begin && c < group.end;
    if (!inside && same_triad == is_axis) besides.emplace_back(samples, c);
  }
  return besides;
}

void KeepRunsOfLiveChannels(const PagedVector<ImuSample>& samples,
                            const ChannelGroup& group,
                            std::vector<EqualSamples>* runs) {
  if (IsDeadAxis(samples, group, *runs)) return;
  for (int c = group.begin; c < group.end && !runs->empty(); ++c) {
    const LiveChannel channel(samples, c);
    std::erase_if(*runs, [&channel](const EqualSamples& run) {
      return !channel.LivesBeside(run);
    });
  }
  if (runs->empty()) return;
  const std::vector<Liveliness> besides = BesidesOf(samples, group);
  std::erase_if(*runs, [&besides](const EqualSamples& run) {
    return std::none_of(
        besides.begin(), besides.end(),
        [&run](const Liveliness& other) { return other.GoesOnDuring(run); });
  });
}

}  // namespace

bool IsByChance(const std::vector<long>& rows, long length) {
  constexpr double kChance = 1e-6;
  constexpr long kUsualShare = 2;
  double repeats = 1.0;  // a repetition that ends, so that none is certain
  double ends = 1.0;
  for (const long r : rows) {
    if (kUsualShare * r >= length) break;
    repeats += static_cast<double>(r - 2);
    ends += 1.0;
  }
  const double go_on = repeats / (repeats + ends);
  const double expected = static_cast<double>(rows.size()) *
                          std::pow(go_on, static_cast<double>(length - 2));
  return expected > kChance;
}

std::vector<RepeatedRun> FindFrozenImu(const ImuStream& imu) {
  const PagedVector<ImuSample>& samples = imu.samples;
  std::vector<RepeatedRun> found;
  const auto add = [&](const ChannelGroup& group,
                       const std::vector<EqualSamples>& runs) {
    for (const EqualSamples& run : runs) {
      const double begin = samples[run.begin].t;
      const double end = samples[run.end - 1].t;
      const bool known = std::any_of(
          found.begin(), found.end(), [&](const RepeatedRun& other) {
            return other.t_begin <= end && begin <= other.t_end;
          });
      if (!known) found.push_back({begin, end, run.rows(), group.name});
    }
  };
  std::vector<ChannelGroup> groups = {kWhole};
  groups.insert(groups.end(), std::begin(kParts), std::end(kParts));
  std::vector<std::vector<EqualSamples>> runs = LongRuns(imu, groups);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (i > 0) KeepRunsOfLiveChannels(samples, groups[i], &runs[i]);
    add(groups[i], runs[i]);
  }
  return found;
}

double StaleImuShare(const ImuStream& imu) {
  const auto& samples = imu.samples;
  const auto repeats = [&](std::size_t k) {
    return samples[k].gyro == samples[k - 1].gyro &&
           samples[k].accel == samples[k - 1].accel;
  };
  if (3 * FactsOf(imu)->whole_repeats < samples.size()) return 0.0;
  std::vector<EqualSamples> runs;
  std::vector<long> lengths;
  for (std::size_t begin = 0, k = 1; k <= samples.size(); ++k) {
    if (k < samples.size() && repeats(k)) continue;
    runs.push_back({begin, k});
    lengths.push_back(runs.back().rows());
    begin = k;
  }
  if (runs.size() < 3) return 0.0;
  double far[kChannels];
  for (int c = 0; c < kChannels; ++c) {
    std::vector<double> values;
    for (const EqualSamples& run : runs) {
      values.push_back(ReadingOf(samples[run.begin], c));
    }
    far[c] = kStepsOfResolution * Resolution(std::move(values), kUnitRounding,
                                             ReadingCourse::kToAndFro);
  }
  const auto is_far = [&](const EqualSamples& a, const EqualSamples& b) {
    for (int c = 0; c < kChannels; ++c) {
      if (std::abs(ReadingOf(samples[a.begin], c) -
                   ReadingOf(samples[b.begin], c)) > far[c]) {
        return true;
      }
    }
    return false;
  };
  const long usual = 2 * Median(lengths);
  long stale = 0;
  for (std::size_t i = 1; i + 1 < runs.size(); ++i) {
    if (runs[i].rows() <= usual && is_far(runs[i - 1], runs[i]) &&
        is_far(runs[i], runs[i + 1])) {
      stale += runs[i].rows() - 1;
    }
  }
  const long judged = static_cast<long>(samples.size()) - runs.front().rows() -
                      runs.back().rows();
  return static_cast<double>(stale) / static_cast<double>(judged);
}

}  // namespace hindsight
