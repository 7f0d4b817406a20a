#include "io/write/packed_series.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace hindsight {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

void AppendVariableLength(std::uint64_t code, std::string* bytes) {
  while (code >= 128) {
    bytes->push_back(static_cast<char>((code & 127) | 128));
    code >>= 7;
  }
  bytes->push_back(static_cast<char>(code));
}

/// Rows at which the spans of Extremes begin, and the end.
std::size_t FirstRow(std::size_t rows, std::size_t bins, std::size_t bin) {
  return bin * rows / bins;
}

}  // namespace

double QuantumOf(const std::vector<double>& values) {
  constexpr double kFinest = 1e-12;
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  std::vector<double> magnitudes;
  const std::size_t stride = std::max<std::size_t>(1, values.size() / 4000);
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k])) continue;
    least = std::min(least, values[k]);
    most = std::max(most, values[k]);
    if (k % stride == 0) magnitudes.push_back(std::abs(values[k]));
  }
  std::erase(magnitudes, 0.0);
  if (magnitudes.empty()) return 1.0;
  const auto middle =
      magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  double wanted = *middle / 500.0;
  if (most > least) wanted = std::min(wanted, (most - least) / 20000.0);
  wanted = std::max(wanted, kFinest);
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  return (wanted >= 5.0 * power   ? 5.0
          : wanted >= 2.0 * power ? 2.0
                                  : 1.0) *
         power;
}

std::string PackSeries(const std::vector<double>& values, double quantum) {
  constexpr double kLimit = 4503599627370496.0;
  std::string bytes;
  bytes.reserve(2 * values.size());
  std::int64_t before = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) {
      bytes.push_back('\0');
      continue;
    }
    const auto k = static_cast<std::int64_t>(
        std::llround(std::clamp(value / quantum, -kLimit, kLimit)));
    const std::int64_t d = k - before;
    before = k;
    const std::uint64_t zigzag = d >= 0
                                     ? 2 * static_cast<std::uint64_t>(d)
                                     : 2 * static_cast<std::uint64_t>(-d) - 1;
    AppendVariableLength(zigzag + 1, &bytes);
  }
  return bytes;
}

std::vector<double> UnpackSeries(std::string_view bytes, std::size_t count,
                                 double quantum, std::size_t* offset) {
  std::vector<double> values;
  std::int64_t k = 0;
  while (values.size() < count) {
    std::uint64_t code = 0;
    for (int shift = 0;; shift += 7) {
      if (*offset >= bytes.size()) {
        throw std::invalid_argument("a packed series is cut off");
      }
      const auto byte = static_cast<unsigned char>(bytes[(*offset)++]);
      code |= static_cast<std::uint64_t>(byte & 127) << shift;
      if (byte < 128) break;
    }
    if (code == 0) {
      values.push_back(kNoValue);
      continue;
    }
    const std::uint64_t zigzag = code - 1;
    k += zigzag % 2 == 0 ? static_cast<std::int64_t>(zigzag / 2)
                         : -static_cast<std::int64_t>(zigzag / 2) - 1;
    values.push_back(static_cast<double>(k) * quantum);
  }
  return values;
}

std::vector<double> Extremes(const std::vector<double>& values,
                             std::size_t bins) {
  std::vector<double> extremes;
  extremes.reserve(2 * bins);
  for (std::size_t bin = 0; bin < bins; ++bin) {
    std::size_t least = values.size();
    std::size_t most = values.size();
    const std::size_t end = FirstRow(values.size(), bins, bin + 1);
    for (std::size_t k = FirstRow(values.size(), bins, bin); k < end; ++k) {
      if (!std::isfinite(values[k])) continue;
      if (least == values.size() || values[k] < values[least]) least = k;
      if (most == values.size() || values[k] > values[most]) most = k;
    }
    if (least == values.size()) {
      extremes.insert(extremes.end(), 2, kNoValue);
    } else {
      extremes.push_back(values[std::min(least, most)]);
      extremes.push_back(values[std::max(least, most)]);
    }
  }
  return extremes;
}

std::vector<double> ExtremeTimes(const std::vector<double>& t,
                                 std::size_t bins) {
  std::vector<double> times;
  times.reserve(2 * bins);
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const std::size_t begin = FirstRow(t.size(), bins, bin);
    const std::size_t end = FirstRow(t.size(), bins, bin + 1);
    times.push_back(t[begin]);
    times.push_back(t[(begin + end) / 2]);
  }
  return times;
}

std::string Deflate(std::string_view bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  constexpr int kLevel = 5;
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), kLevel) != Z_OK) {
    throw std::bad_alloc();
  }
  packed.resize(size);
  return packed;
}

std::string Base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::array<unsigned, 3> three = {};
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t j = 0; j < count; ++j) {
      three[j] = static_cast<unsigned char>(bytes[i + j]);
    }
    const unsigned word = three[0] << 16 | three[1] << 8 | three[2];
    text.push_back(kDigits[word >> 18]);
    text.push_back(kDigits[word >> 12 & 63]);
    text.push_back(count > 1 ? kDigits[word >> 6 & 63] : '=');
    text.push_back(count > 2 ? kDigits[word & 63] : '=');
  }
  return text;
}

}  // namespace hindsight
