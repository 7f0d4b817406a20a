#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/read/imu_pair.h"
#include "io/read/reader_rows.h"

namespace hindsight {
namespace {

/// First column of the rates and of the increments in ImuFields().
constexpr std::size_t kRates = 0;
constexpr std::size_t kIncrements = 6;

ImuStream::Kind FindKind(const StreamSource& source,
                         const ImuReadOptions& options,
                         const OpenedTable& opened) {
  const auto has_any = [&](std::size_t first) {
    for (std::size_t i = first; i < first + 6; ++i) {
      if (opened.table->Has(i)) return true;
    }
    return false;
  };
  const ImuStream::Kind kind = options.kind.value_or(
      has_any(kIncrements) && !has_any(kRates) ? ImuStream::Kind::kIncrements
                                               : ImuStream::Kind::kRates);
  const std::size_t first =
      kind == ImuStream::Kind::kRates ? kRates : kIncrements;
  const bool whole = !options.accelerometer;
  if (!whole && kind != ImuStream::Kind::kRates) {
    throw InputError(source.config_path, source.config_line,
                     "imu.accelerometer goes with rates; these are increments");
  }
  for (std::size_t i = first + 3; !whole && i < first + 6; ++i) {
    if (!opened.table->Has(i)) continue;
    throw InputError(source.config_path, source.config_line,
                     "accelerations stand in imu.file and in "
                     "imu.accelerometer; expected one of them");
  }
  RequireFields(opened, source.format, ImuFields(), first,
                first + (whole ? 5 : 2));
  return kind;
}

/// Moves each row from the start of its interval to its end: the next row's
/// stamp, or one usual interval later before a drop-out and at the last row.
void StampAtEnd(ImuStream* imu) {
  PagedVector<ImuSample>& samples = imu->samples;
  const double usual = imu->nominal_dt;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double start = samples[i].t;
    const double next =
        i + 1 < samples.size() ? samples[i + 1].t : start + usual;
    samples[i].t =
        next - start > ImuStream::kGapFactor * usual ? start + usual : next;
  }
}

/// The sample before the first row, where the row's interval begins: at the
/// row's stamp, or one usual interval before.
void SetBegin(bool stamp_at_start, ImuStream* imu) {
  imu->samples[0] = imu->samples[1];
  if (stamp_at_start) {
    StampAtEnd(imu);
  } else {
    // On the whole nanosecond that a stamp of the same instant has; + 0.0 takes
    // the sign from a negative zero.
    constexpr double kPerSecond = 1e9;
    const double begin = imu->samples[0].t - imu->nominal_dt;
    imu->samples[0].t = std::round(begin * kPerSecond) / kPerSecond + 0.0;
  }
}

[[noreturn]] void FailGap(const StreamRows& rows, double gap, double max_gap) {
  rows.table().Fail(fmt::format(
      "gap of {:.3f} s in the IMU before this row, longer than max_gap "
      "({:.3g} s); a larger max_gap bridges it",
      gap, max_gap));
}

}  // namespace

ImuStream ReadImu(const StreamSource& source, const ImuReadOptions& options,
                  StreamClock* clock, std::vector<PolicyCount>* policies) {
  StreamRows rows(source, ImuFields(), false);
  ImuStream imu;
  imu.kind = FindKind(source, options, rows.opened());
  imu.max_gap = options.max_gap;
  const bool rates = imu.kind == ImuStream::Kind::kRates;
  const std::size_t first = rates ? kRates : kIncrements;
  const std::size_t begin = rates ? 0 : 1;
  const RowSource& table = rows.table();
  const auto vector = [&](std::size_t i) {
    return Eigen::Vector3d(table.value(i), table.value(i + 1),
                           table.value(i + 2));
  };
  std::optional<AccelerometerFile> accelerometer;
  if (options.accelerometer) {
    accelerometer.emplace(*options.accelerometer, policies);
  }
  long alone = 0;
  TimeLine line;
  double last = 0.0;
  double longest = 0.0;
  while (true) {
    const StreamRows::Step step = rows.Next();
    if (step == StreamRows::Step::kEnd) break;
    const auto force = accelerometer ? accelerometer->At(rows.t(), rows.clock())
                                     : std::optional(vector(first + 3));
    if (!force) {
      ++alone;
      continue;
    }
    if (imu.samples.empty()) {
      if (options.place) line = options.place(rows.clock());
      imu.samples.reserve(table.RowsHint() + begin);
      imu.samples.resize(begin, {line(rows.t())});
    }
    const double gap = imu.samples.size() > begin ? rows.t() - last : 0.0;
    if (gap > options.max_gap) FailGap(rows, gap, options.max_gap);
    longest = std::max(longest, gap);
    if (step == StreamRows::Step::kReplace && imu.samples.size() > begin) {
      imu.samples.pop_back();
    }
    last = rows.t();
    imu.samples.push_back(
        {line(last), options.C_bs * vector(first), options.C_bs * *force});
  }
  if (imu.samples.size() < begin + 2) {
    const std::size_t count = imu.samples.empty() ? 0 : 1;
    throw InputError(
        source.path, 0,
        "holds " + std::to_string(count) + " IMU samples; expected at least 2");
  }
  imu.nominal_dt = MedianInterval(imu);
  if (!rates) {
    SetBegin(options.stamp_at_start, &imu);
  } else if (options.stamp_at_start) {
    throw InputError(source.path, 0,
                     "imu.stamp: start goes with increments; these are rates, "
                     "which belong to their stamps");
  }
  *clock = rows.clock();
  rows.CountPolicies(policies);
  AddPolicy(source.name, "row without readings of accelerometers dropped",
            alone, policies);
  // Stamps moved to the ends of intervals are no farther apart.
  const std::size_t bridged = imu.IsDropOut(longest) ? DropOuts(imu).size() : 0;
  AddPolicy(source.name, "gap bridged", static_cast<long>(bridged), policies);
  return imu;
}

}  // namespace hindsight
