#ifndef HINDSIGHT_IO_WRITE_PACKED_SERIES_H_
#define HINDSIGHT_IO_WRITE_PACKED_SERIES_H_

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hindsight {

/// \file
/// Series of numbers as a page carries them: integer multiples of a quantum,
/// each as its difference from the one before.

/// The largest of 1, 2 and 5 times a power of ten that is fine enough to draw
/// the series with: at most a 20 000th of its range and a 500th of its median
/// magnitude, but at least 1e-12. 1 for a series without finite values or of
/// zeros alone.
double QuantumOf(const std::vector<double>& values);

/// The k_i = round(v_i / quantum), as variable-length integers of seven bits a
/// byte, the lowest first, the eighth bit set in all but the last: 0 for a
/// value that is not finite, else 1 + zigzag(k_i - k_j), where j is the last
/// finite value before, k_j = 0 for the first, and zigzag(d) = 2 d for d >= 0,
/// -2 d - 1 below. Magnitudes of v / quantum are cut at 2^52.
std::string PackSeries(const std::vector<double>& values, double quantum);

/// The first `count` values of a packed series, NaN for those not finite.
/// `*offset` is where it begins in `bytes`, and then where it ends. Throws
/// std::invalid_argument where `bytes` end within.
std::vector<double> UnpackSeries(std::string_view bytes, std::size_t count,
                                 double quantum, std::size_t* offset);

/// The lowest and the highest value of each of `bins` spans of about equally
/// many rows, in the order in which they come, NaN twice for a span without
/// finite values. Requires as many rows as bins.
std::vector<double> Extremes(const std::vector<double>& values,
                             std::size_t bins);

/// The times that Extremes are drawn at: of the first and of the middle row of
/// each span.
std::vector<double> ExtremeTimes(const std::vector<double>& t,
                                 std::size_t bins);

/// Deflated, as RFC 1950 (zlib) has it.
std::string Deflate(std::string_view bytes);

/// RFC 4648, with padding.
std::string Base64(std::string_view bytes);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_PACKED_SERIES_H_
