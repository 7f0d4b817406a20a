#ifndef HINDSIGHT_IO_READ_NUMERIC_ARRAY_H_
#define HINDSIGHT_IO_READ_NUMERIC_ARRAY_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace hindsight {

/// How a number stands in a binary file.
enum class NumberType { kI1, kU1, kI2, kU2, kI4, kU4, kI8, kU8, kF4, kF8 };

/// Bytes of one number.
std::size_t Width(NumberType type);

/// A matrix of numbers out of a binary file, kept as it stands there; a vector
/// is one column.
struct NumericArray {
  std::size_t rows = 0;
  std::size_t columns = 0;
  NumberType type = NumberType::kF8;
  bool column_major = false;  ///< column by column, not row by row
  bool big_endian = false;
  std::string bytes;  ///< rows * columns * Width(type)

  double at(std::size_t row, std::size_t column) const;
  /// Whether the file holds whole numbers (stamps in nanoseconds do not fit a
  /// double).
  bool IsInteger() const;
  /// Of a file of whole numbers: sign and magnitude, without rounding.
  std::pair<bool, std::uint64_t> IntegerAt(std::size_t row,
                                           std::size_t column) const;
};

/// Reads a NumPy file (.npy versions 1 to 3) of one or two dimensions, C or
/// Fortran order: little-endian floats of 4 or 8 bytes, or integers of 1, 2, 4
/// or 8. Throws InputError for anything else and for a file that is too short
/// or too long.
NumericArray ReadNpy(const std::string& path);
/// The same of the bytes of such a file; messages call it `path`.
NumericArray ReadNpy(const std::string& path, const std::string& bytes);

/// Reads a real numeric variable of a MATLAB file (version 5, plain or
/// compressed, and version 4) of two dimensions; a single row reads as a
/// column. Throws InputError if the file is damaged or cut off, wherever in it,
/// and, listing the variables there are, if this one is missing; if it is
/// sparse, complex, text or anything else than a full matrix of numbers.
NumericArray ReadMat(const std::string& path, const std::string& variable);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_NUMERIC_ARRAY_H_
