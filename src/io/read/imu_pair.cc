#include "io/read/imu_pair.h"

#include <string>
#include <utility>

#include "base/error.h"
#include "base/median.h"
#include "io/read/reader_rows.h"

namespace hindsight {
namespace {

constexpr std::size_t kFirstAccel = 3;  // in ImuFields()

}  // namespace

AccelerometerFile::AccelerometerFile(const StreamSource& source,
                                     std::vector<PolicyCount>* policies)
    : source_(source) {
  StreamRows rows(source_, ImuFields(), false);
  RequireFields(rows.opened(), source_.format, ImuFields(), kFirstAccel,
                kFirstAccel + 2);
  std::vector<double> intervals;
  for (auto step = rows.Next(); step != StreamRows::Step::kEnd;
       step = rows.Next()) {
    if (step == StreamRows::Step::kReplace) {
      readings_.pop_back();
    } else if (!readings_.empty()) {
      intervals.push_back(rows.dt());
    }
    const RowSource& table = rows.table();
    readings_.push_back(
        {rows.t(),
         {table.value(kFirstAccel), table.value(kFirstAccel + 1),
          table.value(kFirstAccel + 2)}});
  }
  if (readings_.size() < 2) {
    throw InputError(source_.path, 0,
                     "holds " + std::to_string(readings_.size()) +
                         " readings of accelerometers; expected at least 2");
  }
  longest_ = ImuStream::kGapFactor * Median(std::move(intervals));
  clock_ = rows.clock();
  rows.CountPolicies(policies);
}

std::optional<Eigen::Vector3d> AccelerometerFile::At(double t,
                                                     const StreamClock& clock) {
  if (clock.dated != clock_.dated) {
    throw InputError(source_.path, 0,
                     std::string("stamps are ") +
                         (clock_.dated ? "dates" : "no dates") +
                         ", unlike those of the gyros; expected one clock");
  }
  const double here = t + clock.first.Since(clock_.first);
  if (here < readings_.front().t || here > readings_.back().t) {
    return std::nullopt;
  }
  while (next_ + 2 < readings_.size() && readings_[next_ + 1].t < here) ++next_;
  const Reading& before = readings_[next_];
  const Reading& behind = readings_[next_ + 1];
  if (here == before.t) return before.f;
  if (here == behind.t) return behind.f;
  const double interval = behind.t - before.t;
  if (interval > longest_) return std::nullopt;
  const double share = (here - before.t) / interval;
  return Eigen::Vector3d(before.f + share * (behind.f - before.f));
}

}  // namespace hindsight
