#include "io/read/tick_clock.h"

#include <cmath>
#include <limits>

namespace hindsight {
namespace {

/// Holds the product of two of 64 bits.
using Wide = unsigned __int128;

}  // namespace

TickClock::TickClock(double seconds_per_tick) {
  // Convergents of the continued fraction, until one rounds to the double.
  const long double tick = seconds_per_tick;
  const long double tolerance = tick * std::numeric_limits<double>::epsilon();
  std::uint64_t p = 1, p_before = 0, q = 0, q_before = 1;
  long double rest = tick;
  constexpr int kMostTerms = 40;
  constexpr std::uint64_t kMost = std::uint64_t{1} << 62;
  for (int i = 0; i < kMostTerms; ++i) {
    const long double whole = std::floor(rest);
    const auto a = static_cast<std::uint64_t>(whole);
    const Wide next_p = Wide{a} * p + p_before;
    const Wide next_q = Wide{a} * q + q_before;
    if (next_p > kMost || next_q > kMost) break;
    p_before = p;
    q_before = q;
    p = static_cast<std::uint64_t>(next_p);
    q = static_cast<std::uint64_t>(next_q);
    const long double error =
        static_cast<long double>(p) / static_cast<long double>(q) - tick;
    if (std::abs(error) <= tolerance || rest == whole) break;
    rest = 1.0L / (rest - whole);
    if (!(rest < static_cast<long double>(kMost))) break;
  }
  numerator_ = p;
  denominator_ = q;
}

Stamp TickClock::At(bool negative, std::uint64_t ticks) const {
  const Wide product = Wide{ticks} * numerator_;
  const auto seconds = static_cast<std::int64_t>(product / denominator_);
  const auto rest = static_cast<double>(product % denominator_);
  const double fraction = rest / static_cast<double>(denominator_);
  return negative ? Stamp{-seconds, -fraction} : Stamp{seconds, fraction};
}

}  // namespace hindsight
