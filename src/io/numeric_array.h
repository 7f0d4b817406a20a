#ifndef HINDSIGHT_IO_NUMERIC_ARRAY_H_
#define HINDSIGHT_IO_NUMERIC_ARRAY_H_

#include <cstdint>
#include <string>
#include <vector>

namespace hindsight {

/// A matrix of numbers out of a binary file; a vector is one column.
struct NumericArray {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> values;  ///< row by row
  /// The same without rounding, of integer files (stamps in nanoseconds do not
  /// fit a double); else empty.
  std::vector<std::int64_t> integers;

  double at(std::size_t row, std::size_t column) const {
    return values[row * columns + column];
  }
};

/// Reads a NumPy file (.npy versions 1 to 3): little-endian f4, f8, i4 or i8 of
/// one or two dimensions, C or Fortran order. Throws InputError for anything
/// else and for a file that is too short or too long.
NumericArray ReadNpy(const std::string& path);

/// Reads a real numeric variable of a MATLAB file (version 5, plain or
/// compressed, and version 4) of at most two dimensions; a single row reads as
/// a column. Throws InputError if the file cannot be read or the variable is
/// not there, listing those that are.
NumericArray ReadMat(const std::string& path, const std::string& variable);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_NUMERIC_ARRAY_H_
