#include "io/read/counted_rows.h"

#include <fmt/core.h>

#include <cmath>

#include "base/median.h"

namespace hindsight {
namespace {

/// Of steps against their median.
constexpr double kEven = 1e-6;

bool IsWhole(double value, double tolerance) {
  return value > 0.5 && std::abs(value - std::round(value)) < tolerance * value;
}

/// The whole number of rows a second, or of seconds a row, within 5 %; else the
/// rate itself.
double NearWhole(double rate) {
  constexpr double kNear = 0.05;
  const bool slow = rate < 1.0;
  const double whole = std::round(slow ? 1.0 / rate : rate);
  const double nearest = slow ? 1.0 / whole : whole;
  return std::abs(rate / nearest - 1.0) < kNear ? nearest : rate;
}

}  // namespace

std::optional<StampGuess> CountedRows(std::size_t rows,
                                      const StampHints& hints) {
  if (!hints.count_rate || rows < 2) return std::nullopt;
  StampGuess guess;
  const double steps = static_cast<double>(rows - 1);
  guess.rate = hints.count_rate;
  std::string as = hints.rate_stated ? "as the file says" : "as the IMU's";
  constexpr double kAsLong = 0.1;
  if (!hints.rate_stated && hints.span && *hints.span > 0.0 &&
      std::abs(steps / (*guess.rate * *hints.span) - 1.0) > kAsLong) {
    guess.rate = NearWhole(steps / *hints.span);
    as = "for a record as long as the IMU's";
  }
  guess.step = 1.0 / *guess.rate;
  guess.span = steps * guess.step;
  if (!hints.rate_stated) guess.certainty = Certainty::kLikely;
  guess.reason =
      fmt::format("rows are counted at {:g} Hz, {}", *guess.rate, as);
  return guess;
}

bool RecogniseWholeSeconds(const std::vector<double>& t, StampGuess* guess) {
  constexpr std::size_t kFewestSteps = 10;
  std::vector<double> steps;
  std::size_t first_step = 0;
  for (std::size_t k = 1; k < t.size(); ++k) {
    if (t[k] == t[k - 1]) continue;
    if (first_step == 0) first_step = k;
    steps.push_back(t[k] - t[k - 1]);
  }
  if (steps.size() < kFewestSteps || 2 * steps.size() > t.size()) return false;
  if (std::abs(Median(steps) - 1.0) > kEven) return false;
  std::size_t last_step = t.size() - 1;
  while (t[last_step] == t[last_step - 1]) --last_step;
  const double rows = static_cast<double>(last_step - first_step);
  guess->rate = rows / (t[last_step] - t[first_step]);
  guess->step = 1.0 / *guess->rate;
  guess->first = t[first_step] - static_cast<double>(first_step) * guess->step;
  guess->span = static_cast<double>(t.size() - 1) * guess->step;
  guess->gap = guess->step;
  guess->repeated = false;
  guess->starts = true;
  guess->certainty = Certainty::kLikely;
  guess->reason = fmt::format(
      "the stamps are whole seconds: rows are counted at {:g} Hz from where "
      "the first second must have begun",
      *guess->rate);
  return true;
}

void RecogniseDrawnAxis(std::size_t rows, const Steps& steps,
                        StampGuess* guess) {
  if (rows < 50 || steps.unevenness > kEven) return;
  const double rate = static_cast<double>(rows) / guess->span;
  if (!IsWhole(rate, 1e-9) || IsWhole(1.0 / guess->step, 1e-6)) return;
  guess->rate = std::round(rate);
  guess->certainty = Certainty::kLikely;
  guess->reason = fmt::format(
      "the stamps are {} points drawn evenly from 0 to {:g} s: rows are "
      "counted "
      "at {:g} Hz instead, a stretch of {:.3g} %",
      rows, guess->span, *guess->rate, 100.0 / static_cast<double>(rows - 1));
  guess->step = 1.0 / *guess->rate;
  guess->span = static_cast<double>(rows - 1) * guess->step;
}

void RecogniseWrongScale(std::size_t rows, const StampHints& hints,
                         StampGuess* guess) {
  if (!hints.span || guess->rate || guess->scale != StampGuess::Scale::kOwn) {
    return;
  }
  const double ratio = guess->span / *hints.span;
  const double power = std::round(std::log10(ratio));
  if (power == 0.0 || std::abs(std::log10(ratio) - power) > 0.013) return;
  const double seconds = guess->step / std::pow(10.0, power);
  guess->rate = 1.0 / seconds;
  guess->certainty = Certainty::kLikely;
  guess->reason = fmt::format(
      "the stamps span {:.4g} times the record of the IMU: rows are counted at "
      "{:g} Hz instead",
      ratio, *guess->rate);
  guess->step = seconds;
  guess->span = static_cast<double>(rows - 1) * seconds;
  guess->first = 0.0;
}

}  // namespace hindsight
