#include "io/reader_rows.h"

#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "io/units.h"

namespace hindsight {
namespace {

TextFormat WithClock(const StreamSource& source) {
  TextFormat format = source.format;
  format.ignore_time = source.clock.rate.has_value();
  return format;
}

std::string Seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g s", value);
  return text;
}

}  // namespace

StreamRows::StreamRows(const StreamSource& source,
                       const std::vector<FieldName>& fields, bool allow_absent)
    : source_(source),
      opened_(OpenTable(source.path, WithClock(source), fields,
                        {source.allow_truncated_tail, allow_absent})) {
  clock_.dated = opened_.dated || source.clock.week.has_value() ||
                 source.clock.scale != ClockMap::Scale::kDataset;
}

Stamp StreamRows::FileTime() const {
  if (source_.clock.rate) {
    return {0, static_cast<double>(rows_) / *source_.clock.rate};
  }
  Stamp stamp = opened_.table->stamp();
  if (source_.clock.scale == ClockMap::Scale::kUnix) return GpsFromUnix(stamp);
  if (source_.clock.week) stamp.seconds += *source_.clock.week * kWeekSeconds;
  return stamp;
}

StreamRows::Step StreamRows::Next() {
  while (opened_.table->Next()) {
    const Stamp stamp = FileTime();
    ++rows_;
    if (rows_ == 1) {
      clock_.first = stamp;
      return Step::kAppend;
    }
    const double t = stamp.Since(clock_.first);
    dt_ = t - t_;
    if (dt_ < 0.0) {
      opened_.table->Fail("time runs backwards by " + Seconds(-dt_) +
                          "; expected stamps that increase");
    }
    t_ = t;
    clock_.last = t;
    if (dt_ > 0.0) return Step::kAppend;
    if (source_.on_duplicate == DuplicatePolicy::kError) {
      opened_.table->Fail(
          "the stamp is the same as in the row before; expected stamps that "
          "increase (on_duplicate: drop_first or drop_last accepts it)");
    }
    ++duplicates_;
    if (source_.on_duplicate == DuplicatePolicy::kDropFirst) {
      return Step::kReplace;
    }
  }
  return Step::kEnd;
}

void StreamRows::CountPolicies(std::vector<PolicyCount>* policies) const {
  AddPolicy(source_.name,
            source_.on_duplicate == DuplicatePolicy::kDropFirst
                ? "first of duplicate stamps dropped"
                : "last of duplicate stamps dropped",
            duplicates_, policies);
  AddPolicy(source_.name, "truncated last line dropped",
            opened_.table->truncated(), policies);
}

void AddPolicy(const std::string& stream, const std::string& action, long count,
               std::vector<PolicyCount>* policies) {
  if (count > 0) policies->push_back({stream, action, count});
}

std::optional<Stamp> FirstGpsTime(const StreamSource& source,
                                  const StreamClock& clock) {
  if (source.clock.start_date) return source.clock.start_date;
  if (source.clock.start || !clock.dated) return std::nullopt;
  return clock.first;
}

TimeLine MapClock(const StreamSource& source, const StreamClock& clock,
                  std::optional<std::int64_t> epoch_gps_ns) {
  TimeLine line;
  const std::optional<Stamp> gps = FirstGpsTime(source, clock);
  if (source.clock.start) {
    line.offset = *source.clock.start;
  } else if (gps) {
    if (!epoch_gps_ns) {
      throw InputError(source.config_path, source.config_line,
                       source.name +
                           " has dates but the IMU's clock has none; expected "
                           "`epoch`, or `time` of the imu with week or start");
    }
    line.offset = gps->Since(StampFromNanoseconds(*epoch_gps_ns));
  } else {
    line.offset = clock.first.Since({});
  }
  if (source.clock.duration) {
    if (clock.last <= 0.0) {
      throw InputError(source.config_path, source.config_line,
                       source.name + ": duration needs at least two rows");
    }
    line.scale = *source.clock.duration / clock.last;
  }
  line.offset += source.clock.offset;
  return line;
}

}  // namespace hindsight
