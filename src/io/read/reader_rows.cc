#include "io/read/reader_rows.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "io/read/joined_rows.h"
#include "io/read/row_buffer.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

TextFormat WithClock(const StreamSource& source) {
  TextFormat format = source.format;
  format.ignore_time = source.clock.rate.has_value();
  return format;
}

/// What no reading of a vehicle on Earth comes near.
double Largest(Quantity quantity) {
  switch (quantity) {
    case Quantity::kLength:
      return 1e9;
    case Quantity::kSpeed:
    case Quantity::kAcceleration:
    case Quantity::kAngle:
    case Quantity::kMagneticField:
      return 1e6;
    case Quantity::kAngularRate:
      return 1e5;
    default:
      return std::numeric_limits<double>::max();
  }
}

std::string Seconds(double value) { return fmt::format("{:.6g} s", value); }

}  // namespace

std::vector<std::string> StreamSource::Paths() const {
  std::vector<std::string> paths = {path};
  paths.insert(paths.end(), more_paths.begin(), more_paths.end());
  return paths;
}

StreamRows::StreamRows(const StreamSource& source,
                       const std::vector<FieldName>& fields, bool allow_absent)
    : source_(source),
      fields_(fields),
      opened_(OpenJoined(
          source.Paths(), WithClock(source), fields,
          {source.allow_truncated_tail, allow_absent || source.absent_values,
           source.drop_text, source.digests})) {
  clock_.dated = opened_.dated || source.clock.week.has_value() ||
                 source.clock.scale != ClockMap::Scale::kDataset;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (opened_.table->Has(i))
      most_.push_back({i, Largest(fields[i].quantity)});
  }
  if (source.sort) Sort(fields, allow_absent || source.absent_values);
}

void StreamRows::CheckSizes() const {
  // Of all at once: hardly any is.
  bool is_any = false;
  for (const auto& [field, most] : most_) {
    is_any |= std::abs(opened_.table->value(field)) > most;
  }
  if (!is_any) return;
  for (const auto& [field, most] : most_) {
    const double value = opened_.table->value(field);
    if (!(std::abs(value) > most)) continue;
    opened_.table->Fail(std::string(fields_[field].name) + " is " +
                        FormatNumber(value) + " " +
                        SiUnit(fields_[field].quantity) +
                        "; expected at most " + FormatNumber(most));
  }
}

void StreamRows::Sort(const std::vector<FieldName>& fields, bool allow_absent) {
  RowBuffer buffer = Buffered(opened_.table.get(), fields, allow_absent);
  sorted_ = buffer.Sort();
  opened_.table = std::make_unique<RowBuffer>(std::move(buffer));
}

Stamp StreamRows::FileTime() {
  if (source_.clock.rate) {
    return {0, static_cast<double>(rows_) / *source_.clock.rate};
  }
  Stamp stamp = opened_.table->stamp();
  if (!opened_.dated && source_.clock.scale == ClockMap::Scale::kUnix) {
    return GpsFromUnix(stamp);
  }
  if (source_.clock.week) {
    // Seconds of week start again from zero on Sunday.
    if (last_stamp_ && stamp.Since(*last_stamp_) < -0.5 * kWeekSeconds) {
      ++weeks_;
    }
    last_stamp_ = stamp;
    stamp.seconds += (*source_.clock.week + weeks_) * kWeekSeconds;
  }
  stamp.seconds +=
      std::int64_t{source_.clock.week_rollovers} * 1024 * kWeekSeconds;
  return stamp;
}

StreamRows::Step StreamRows::Next() {
  while (opened_.table->Next()) {
    if (source_.abandoned != nullptr && *source_.abandoned) throw Interrupted();
    const Stamp stamp = FileTime();
    ++rows_;
    CheckSizes();
    if (rows_ == 1) clock_.first = stamp;
    const double since_first = stamp.Since(clock_.first);
    if (since_first < source_.clock.from || since_first > source_.clock.until) {
      ++outside_;
      continue;
    }
    if (!started_) {
      started_ = true;
      t_ = clock_.last = since_first;
      return Step::kAppend;
    }
    dt_ = since_first - t_;
    const std::size_t part = opened_.table->part();
    if (part != part_ && dt_ < 0.0) FailOverlap(part);
    part_ = part;
    if (dt_ < 0.0) {
      opened_.table->Fail("time runs backwards by " + Seconds(-dt_) +
                          "; expected stamps that increase (on_unordered: "
                          "sort puts them in order)");
    }
    t_ = clock_.last = since_first;
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

void StreamRows::FailOverlap(std::size_t part) const {
  opened_.table->Fail(
      "begins " + Seconds(-dt_) + " before " + source_.Paths()[part - 1] +
      " ends; expected the files of `file` in the order of "
      "time, none overlapping the next (on_unordered: sort puts "
      "the rows in order)");
}

void StreamRows::CountPolicies(std::vector<PolicyCount>* policies) const {
  AddPolicy(source_.name,
            source_.on_duplicate == DuplicatePolicy::kDropFirst
                ? "first of duplicate stamps dropped"
                : "last of duplicate stamps dropped",
            duplicates_, policies);
  AddPolicy(source_.name, "row out of order sorted", sorted_, policies);
  AddPolicy(source_.name, "row outside time.from and time.until", outside_,
            policies);
  for (const LeftOut& left : opened_.table->left_out()) {
    AddPolicy(source_.name, left.action, left.count, policies);
  }
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
  line.scale *= source.clock.stretch;
  line.offset += source.clock.offset;
  return line;
}

}  // namespace hindsight
