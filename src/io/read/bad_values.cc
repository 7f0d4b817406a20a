#include "io/read/bad_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace hindsight {
namespace {

/// How far from zero the values other than `except` are at most, and how often that
/// one stands.
struct Others {
  double largest = 0.0;
  std::size_t count = 0;
};

Others OthersThan(double except, const std::vector<double>& values) {
  Others others;
  for (const double value : values) {
    if (value == except) {
      ++others.count;
    } else if (!std::isnan(value)) {
      others.largest = std::max(others.largest, std::abs(value));
    }
  }
  return others;
}

/// Nines alone, the ends of 16 and 32 bits, or what nothing on the Earth measures;
/// with a decimal point anywhere.
bool IsWrittenForNone(double value) {
  constexpr double kBeyond = 1e9;
  constexpr int kDecimals = 4;
  const double size = std::abs(value);
  if (size >= kBeyond) return true;
  double scale = 1.0;
  for (int i = 0; i <= kDecimals; ++i, scale *= 10.0) {
    const double whole = std::round(scale * size);
    if (std::abs(scale * size - whole) > 1e-9 * whole) continue;
    for (const double end :
         {32767.0, 32768.0, 65535.0, 2147483647.0, 2147483648.0}) {
      if (whole == end) return true;
    }
    // 10^n - 1
    const double next = std::log10(whole + 1.0);
    if (whole >= 99.0 && next == std::round(next)) return true;
  }
  return false;
}

std::optional<double> BadValueOf(const std::vector<double>& values) {
  constexpr std::size_t kLeast = 3;
  constexpr double kFar = 10.0;
  double farthest = 0.0;
  for (const double value : values) {
    if (std::abs(value) > std::abs(farthest)) farthest = value;
  }
  const Others others = OthersThan(farthest, values);
  if (!IsWrittenForNone(farthest) || others.count < kLeast ||
      2 * others.count >= values.size() || others.largest == 0.0 ||
      std::abs(farthest) < kFar * others.largest) {
    return std::nullopt;
  }
  return farthest;
}

}  // namespace

void TakeOutBadValues(FileColumns* file) {
  for (FileColumn& column : file->columns) {
    if (column.holds != FileColumn::Holds::kNumbers) continue;
    const auto bad = BadValueOf(column.values);
    if (!bad) continue;
    std::replace(column.values.begin(), column.values.end(), *bad,
                 std::numeric_limits<double>::quiet_NaN());
    std::vector<double>& known = file->bad_values;
    if (std::find(known.begin(), known.end(), *bad) == known.end()) {
      known.push_back(*bad);
    }
  }
}

}  // namespace hindsight
