#include "io/read/column_lines.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/median.h"
#include "base/units.h"
#include "io/read/file_formats.h"
#include "io/read/units.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

FoundStream ColumnLines::Stream() const {
  FoundStream found;
  found.format = file_.format;
  if (file_.skip_lines > 0) {
    found.lines.push_back({"skip_lines", std::to_string(file_.skip_lines)});
  }
  if (file_.row_word.column >= 0) {
    found.lines.push_back({"rows", file_.row_word.Yaml()});
  }
  if (!file_.delimiter.empty()) {
    found.lines.push_back({"delimiter", file_.delimiter});
  }
  const int dated =
      stamps_->date_column >= 0 ? stamps_->date_column : stamps_->column;
  if (stamps_->scale == StampGuess::Scale::kDate) {
    const FileColumn& dates = file_.columns[static_cast<std::size_t>(dated)];
    const bool by_day = dates.date_order == DateOrder::kDayFirst;
    if (dates.date_order != DateOrder::kYearFirst) {
      found.lines.push_back({"dates", by_day ? "day_first" : "month_first",
                             dates.order_told ? "" : "(a guess)"});
    }
    if (!dates.order_told) {
      found.assumptions.push_back(
          fmt::format("dates as 07/08/2025 are taken for {} first",
                      by_day ? "day" : "month"));
    }
  }
  if (!file_.bad_values.empty()) {
    found.lines.push_back(
        {"bad_values", fmt::format("[{}]", fmt::join(file_.bad_values, ", ")),
         "stand again and again, far from all others: no readings (likely)"});
  }
  if (file_.cut_tail) found.lines.push_back({"allow_truncated_tail", "true"});
  if (file_.text_rows > 0) found.lines.push_back({"on_text", "drop"});
  found.remarks = file_.remarks;
  found.stamps = stamps_;
  found.lines.push_back({"columns", ""});
  if (stamps_->date_column >= 0) {
    AddColumn("date",
              {stamps_->date_column, stamps_->unit, 1.0, stamps_->certainty,
               stamps_->reason},
              &found);
    const auto clock = static_cast<std::size_t>(stamps_->column);
    found.lines.push_back({"  t", '"' + file_.columns[clock].reference + '"'});
  } else if (stamps_->column >= 0 && !stamps_->rate) {
    AddColumn("t",
              {stamps_->column, stamps_->unit, 1.0, stamps_->certainty,
               stamps_->reason},
              &found);
  }
  if (stamps_->rest_column >= 0 && !stamps_->rate) {
    AddColumn(std::string(kRestOfSecond),
              {stamps_->rest_column, stamps_->rest_unit, 1.0,
               Certainty::kCertain, ""},
              &found);
  }
  if (stamps_->repeated && !stamps_->rate) {
    SetLine({"on_duplicate", "drop_last", "stamps stand twice"}, &found.lines);
  }
  if (stamps_->unordered && !stamps_->rate) {
    SetLine({"on_unordered", "sort", "stamps run backwards"}, &found.lines);
  }
  if (stamps_->certainty == Certainty::kGuess ||
      (stamps_->rate && stamps_->certainty == Certainty::kLikely)) {
    found.assumptions.push_back(stamps_->reason);
  }
  return found;
}

FoundStream ColumnLines::ImuStreamOf(const ImuGuess& guess) const {
  constexpr double kUsualGap = 0.5;  // s, the default of max_gap
  constexpr double kLongest = 60.0;  // s
  constexpr double kShown = 0.5;
  FoundStream found = Stream();
  found.imu = true;
  if (!stamps_->rate && stamps_->gap > kUsualGap && stamps_->gap < kLongest) {
    SetLine(
        {"max_gap", fmt::format("{:.2g} s", 1.1 * stamps_->gap),
         fmt::format("drop-outs of up to {:.3g} s are bridged", stamps_->gap)},
        &found.lines);
  }
  if (guess.gyro.certainty == Certainty::kGuess) {
    found.assumptions.push_back("gyros: " + guess.gyro.reason);
  }
  if (guess.turn.slope < 0.0 && guess.turn.correlation < -kShown) {
    found.assumptions.push_back(fmt::format(
        "gravity turns against the gyros (correlation {:.2f}): an axis is "
        "mirrored in both, or the gyros have the other sign",
        guess.turn.correlation));
  }
  return found;
}

void ColumnLines::Take(const std::string& family, const TripleGuess& triple) {
  for (std::size_t i = 0; i < 3; ++i) {
    meanings_[static_cast<std::size_t>(triple.columns[i])].quantity =
        family + "xyz"[i];
  }
}

void ColumnLines::TakeForDvl() {
  for (std::size_t i = 0; i < meanings_.size(); ++i) {
    const std::string& title = file_.columns[i].title;
    ColumnMeaning meaning = MeaningOfTitle("dvl " + title);
    if (!meaning.quantity.starts_with("v_")) continue;
    meanings_[i] = std::move(meaning);
  }
  // "Down" beside "forward" and "starboard" is the vehicle's.
  if (!HasAll({"v_x", "v_y", "v_d"}) || Titled("v_z") >= 0) return;
  meanings_[static_cast<std::size_t>(Titled("v_d"))].quantity = "v_z";
}

void ColumnLines::TakeAxesFor(const std::string& family) {
  for (std::size_t i = 0; i < meanings_.size(); ++i) {
    ColumnMeaning meaning = AxisMeaning(file_.columns[i].title, family);
    if (!meaning.quantity.empty()) meanings_[i] = std::move(meaning);
  }
}

void ColumnLines::AddColumn(const std::string& quantity,
                            const ColumnGuess& guess,
                            FoundStream* found) const {
  const FileColumn& column =
      file_.columns[static_cast<std::size_t>(guess.column)];
  std::string comment;
  if (file_.format == &ColumnsFormat() && !column.title.empty()) {
    comment = "'" + column.title + "'";
  }
  if (!guess.reason.empty()) {
    comment += (comment.empty() ? "" : "; ") + guess.reason;
  }
  if (guess.certainty != Certainty::kCertain) {
    comment += std::string(comment.empty() ? "(" : " (") +
               CertaintyName(guess.certainty) + ")";
  }
  const std::string& reference = column.reference;
  const std::string unit = guess.unit.empty() ? "1" : guess.unit;
  std::string value;
  if (std::abs(guess.sign) != 1.0) {
    value = fmt::format("{{column: \"{}\", unit: \"{}\", scale: {:.12g}}}",
                        reference, unit, guess.sign);
  } else {
    value = fmt::format("\"{}{} [{}]\"", guess.sign < 0.0 ? "-" : "", reference,
                        unit);
  }
  AddLine({"  " + quantity, value, comment}, found);
  if (std::none_of(column.values.begin(), column.values.end(),
                   [](double x) { return std::isnan(x); })) {
    return;
  }
  if (!found->imu) {
    SetLine({"absent_values", "true", "rows without a value are passed over"},
            &found->lines);
  } else if (file_.format == &ColumnsFormat()) {
    SetLine({"on_text", "drop", "rows without a reading are left out"},
            &found->lines);
  }
}

void ColumnLines::AddLine(KeyLine line, FoundStream* found) {
  std::size_t end = found->lines.size();
  while (!found->lines[end - 1].key.starts_with(' ') &&
         found->lines[end - 1].key != "columns") {
    --end;
  }
  found->lines.insert(found->lines.begin() + static_cast<std::ptrdiff_t>(end),
                      std::move(line));
}

void ColumnLines::AddTriple(const std::string& family,
                            const TripleGuess& triple,
                            FoundStream* found) const {
  for (std::size_t i = 0; i < 3; ++i) {
    AddColumn(
        family + "xyz" [i],
        {
          triple.columns[i], triple.unit, triple.scale, triple.certainty,
              i == 0 ? triple.reason : ""
        },
        found);
  }
}

int ColumnLines::Titled(const std::string& quantity) const {
  for (std::size_t i = 0; i < meanings_.size(); ++i) {
    if (meanings_[i].quantity == quantity) return static_cast<int>(i);
  }
  return -1;
}

bool ColumnLines::HasAll(const std::vector<std::string>& names) const {
  return std::all_of(names.begin(), names.end(),
                     [&](const auto& name) { return Titled(name) >= 0; });
}

void ColumnLines::AddTitledColumn(const std::string& quantity,
                                  Quantity dimension,
                                  FoundStream* found) const {
  const int column = Titled(quantity);
  const ColumnMeaning& meaning = meanings_[static_cast<std::size_t>(column)];
  const bool known = UnitFactor(meaning.unit, dimension).has_value();
  const bool sure = known || dimension == Quantity::kRatio;
  ColumnGuess guess{column, known ? meaning.unit : SiUnit(dimension),
                    meaning.upwards ? -1.0 : 1.0,
                    sure ? Certainty::kCertain : Certainty::kGuess,
                    sure ? "" : "unit not stated"};
  const bool place = quantity == "lat" || quantity == "lon";
  if (!known && dimension == Quantity::kAngle) {
    guess.unit = place ? PlaceUnit() : AngleUnit();
  }
  if (!known && dimension == Quantity::kMagneticField) {
    guess.unit =
        FieldSizeOf({Titled("mag_x"), Titled("mag_y"), Titled("mag_z")}).unit;
    guess.certainty = Certainty::kLikely;
    guess.reason = "as strong as the Earth's";
  }
  AddColumn(quantity, guess, found);
}

/// By size: rolls, pitches and headings in radians stay below 2 pi.
std::string ColumnLines::AngleUnit() const {
  constexpr double kMostRadians = 6.3;
  for (const char* name : {"roll", "pitch", "heading"}) {
    const int column = Titled(name);
    if (column < 0) continue;
    const auto& v = file_.columns[static_cast<std::size_t>(column)].values;
    if (std::any_of(v.begin(), v.end(),
                    [](double x) { return std::abs(x) > kMostRadians; })) {
      return "deg";
    }
  }
  return "rad";
}

/// By size: who is neither in the Gulf of Guinea nor at its antipodes has a
/// longitude beyond pi or a latitude beyond pi/2 degrees.
std::string ColumnLines::PlaceUnit() const {
  const auto within = [&](const char* name, double most) {
    const int column = Titled(name);
    if (column < 0) return true;
    const auto& v = file_.columns[static_cast<std::size_t>(column)].values;
    return std::all_of(v.begin(), v.end(),
                       [&](double x) { return std::abs(x) <= most; });
  };
  return within("lat", 0.5 * kPi) && within("lon", kPi) ? "rad" : "deg";
}

ColumnLines::FieldSize ColumnLines::FieldSizeOf(
    const ColumnTriple& columns) const {
  std::vector<double> lengths(file_.rows);
  for (std::size_t k = 0; k < lengths.size(); ++k) {
    for (const int column : columns) {
      const auto i = static_cast<std::size_t>(column);
      lengths[k] = std::hypot(lengths[k], file_.columns[i].values[k]);
    }
  }
  constexpr double kEarth = 48.0;  // uT
  const double length = Median(std::move(lengths));
  FieldSize nearest;
  double distance = std::numeric_limits<double>::infinity();
  for (const char* unit : {"uT", "nT", "mG", "G"}) {
    const double field = length * *UnitFactor(unit, Quantity::kMagneticField);
    const double here = std::abs(std::log(field / kEarth));
    if (here < distance) nearest = {unit, field};
    distance = std::min(distance, here);
  }
  return nearest;
}

bool ColumnLines::IsOfEarth(const ColumnTriple& columns) const {
  constexpr double kWeakest = 20.0;    // uT
  constexpr double kStrongest = 70.0;  // uT
  const double field = FieldSizeOf(columns).field;
  return field > kWeakest && field < kStrongest;
}

void ColumnLines::AddFieldsOf(const SensorKind& kind,
                              const std::vector<std::string>& names,
                              FoundStream* found) const {
  for (const FieldName& field : kind.columns) {
    const bool wanted =
        std::find(names.begin(), names.end(), field.name) != names.end();
    if (wanted) AddTitledColumn(field.name, field.quantity, found);
  }
}

KeyLine SlowFixNoise(double slow, double white, const std::string& comment) {
  return {"noise",
          fmt::format("{{model: gauss_markov, sigma: {:.2g} m, tau: 60 s, "
                      "white: {:.2g} m}}",
                      slow, white),
          comment};
}

}  // namespace hindsight
