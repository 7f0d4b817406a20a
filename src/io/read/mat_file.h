#ifndef HINDSIGHT_IO_READ_MAT_FILE_H_
#define HINDSIGHT_IO_READ_MAT_FILE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/read/input_file.h"
#include "io/read/numeric_array.h"

namespace hindsight {

/// Bytes of a variable's name.
inline constexpr std::size_t kLongestMatName = 4096;

/// A word of a MATLAB file.
std::uint32_t MatWord(const char* data, bool big_endian);

/// Bytes of a MATLAB file one after the other, as they stand or inflated.
/// Throws InputError past their end.
using ByteSource = std::function<void(char* data, std::size_t count)>;

/// A variable as its file declares it.
struct MatVariable {
  std::string name;
  /// What it is if it is no full, real matrix of numbers: "a sparse matrix";
  /// else empty.
  std::string unfit;
  std::vector<std::size_t> shape;
};

/// What both versions of the format share: an array of the variable's shape,
/// its values read from `source` piece by piece, so that memory follows what
/// the file holds rather than what it says. `reserve` is the most that it can
/// hold.
NumericArray ReadMatValues(const MatVariable& variable, NumberType type,
                           bool big_endian, std::size_t reserve,
                           const ByteSource& source);

/// What one variable of version 4 or 5 is read as; called for each in turn.
/// `values` reads its array if it is fit.
using MatVisitor = std::function<void(
    const MatVariable& variable, const std::function<NumericArray()>& values)>;

/// Walks over all variables of a file of version 4 or 5. Throw InputError for
/// whatever does not follow the format.
void VisitMat4(const InputFile& file, const MatVisitor& visit);
void VisitMat5(const InputFile& file, const MatVisitor& visit);

/// Of whichever version the file is. Throws InputError if it is none, or 7.3.
void VisitMat(const std::string& path, const MatVisitor& visit);

/// "ends within the variable 'x'"
[[noreturn]] void FailCutOff(const InputFile& file, const std::string& name);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_MAT_FILE_H_
