#include <cstdio>

#include "base/error.h"
#include "io/reader_rows.h"

namespace hindsight {
namespace {

/// First column of the rates and of the increments in ImuFields().
constexpr std::size_t kRates = 0;
constexpr std::size_t kIncrements = 6;

/// Gaps up to here need no declaration [s].

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
  RequireFields(opened, source.format, ImuFields(), first, first + 5);
  return kind;
}

[[noreturn]] void FailGap(const StreamRows& rows, double max_gap) {
  char text[160];
  std::snprintf(text, sizeof(text),
                "gap of %.3f s in the IMU before this row, longer than max_gap "
                "(%.3g s); a larger max_gap bridges it",
                rows.dt(), max_gap);
  rows.table().Fail(text);
}

}  // namespace

ImuStream ReadImu(const StreamSource& source, const ImuReadOptions& options,
                  StreamClock* clock, std::vector<PolicyCount>* policies) {
  StreamRows rows(source, ImuFields(), false);
  ImuStream imu;
  imu.kind = FindKind(source, options, rows.opened());
  imu.max_gap = options.max_gap;
  const std::size_t first =
      imu.kind == ImuStream::Kind::kRates ? kRates : kIncrements;
  const RowSource& table = rows.table();
  const auto vector = [&](std::size_t i) {
    return Eigen::Vector3d(table.value(i), table.value(i + 1),
                           table.value(i + 2));
  };
  while (true) {
    const StreamRows::Step step = rows.Next();
    if (step == StreamRows::Step::kEnd) break;
    if (imu.samples.empty()) imu.samples.reserve(table.RowsHint());
    if (rows.dt() > options.max_gap) FailGap(rows, options.max_gap);
    if (step == StreamRows::Step::kReplace) imu.samples.pop_back();
    imu.samples.push_back({rows.t(), options.C_bs * vector(first),
                           options.C_bs * vector(first + 3)});
  }
  if (imu.samples.size() < 2) {
    throw InputError(source.path, 0,
                     "holds " + std::to_string(imu.samples.size()) +
                         " IMU samples; expected at least 2");
  }
  if (imu.kind == ImuStream::Kind::kIncrements && options.stamp_at_start) {
    const std::size_t last = imu.samples.size() - 1;
    const double dt = imu.samples[last].t - imu.samples[last - 1].t;
    for (std::size_t i = 0; i < last; ++i) {
      imu.samples[i].t = imu.samples[i + 1].t;
    }
    imu.samples[last].t += dt;
  }
  *clock = rows.clock();
  rows.CountPolicies(policies);
  imu.nominal_dt = MedianInterval(imu);
  AddPolicy(source.name, "gap bridged", static_cast<long>(DropOuts(imu).size()),
            policies);
  return imu;
}

}  // namespace hindsight
