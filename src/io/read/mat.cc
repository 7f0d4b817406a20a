#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>

#include "base/error.h"
#include "io/read/array_rows.h"
#include "io/read/file_columns.h"
#include "io/read/file_formats.h"
#include "io/read/mat_file.h"

namespace hindsight {
namespace {

enum class MatVersion { kNone, k4, k5, k73 };

MatVersion VersionOf(const InputFile& file) {
  // Where a file of version 5 says its version and its order of bytes.
  constexpr std::size_t kVersion = 124;
  constexpr std::size_t kHeader = 128;
  std::array<char, kHeader> header = {};
  const std::size_t count = file.ReadAt(0, header.data(), header.size());
  if (count == 0) throw InputError(file.path(), 0, "the file is empty");
  const std::string_view mark(header.data() + kVersion, kHeader - kVersion);
  using namespace std::string_view_literals;
  if (mark == "\x00\x01IM"sv || mark == "\x01\x00MI"sv) return MatVersion::k5;
  if (mark == "\x00\x02IM"sv || mark == "\x02\x00MI"sv) return MatVersion::k73;
  // The type of a first variable is four digits, 0 to 4052.
  const bool little = header[2] == 0 && header[3] == 0;
  const bool big = header[0] == 0 && header[1] == 0;
  return count >= 20 && (little || big) ? MatVersion::k4 : MatVersion::kNone;
}

}  // namespace

std::uint32_t MatWord(const char* data, bool big_endian) {
  std::uint32_t word = 0;
  std::memcpy(&word, data, sizeof(word));
  return big_endian ? __builtin_bswap32(word) : word;
}

void FailCutOff(const InputFile& file, const std::string& name) {
  throw InputError(
      file.path(), 0,
      "ends within " +
          (name.empty() ? "a variable" : "the variable '" + name + "'") +
          "; expected a complete MATLAB file");
}

NumericArray ReadMatValues(const MatVariable& variable, NumberType type,
                           bool big_endian, std::size_t reserve,
                           const ByteSource& source) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  NumericArray array;
  array.type = type;
  array.big_endian = big_endian;
  array.column_major = true;
  array.rows = variable.shape[0];
  array.columns = variable.shape[1];
  if (array.rows == 1) std::swap(array.rows, array.columns);
  const std::size_t size = array.rows * array.columns * Width(type);
  array.bytes.reserve(std::min(size, reserve));
  while (array.bytes.size() < size) {
    const std::size_t begin = array.bytes.size();
    array.bytes.resize(std::min(size, begin + kPiece));
    source(array.bytes.data() + begin, array.bytes.size() - begin);
  }
  return array;
}

void VisitMat(const std::string& path, const MatVisitor& visit) {
  const InputFile file(path);
  const MatVersion version = VersionOf(file);
  if (version == MatVersion::kNone) {
    throw InputError(path, 0, "is no MATLAB file");
  }
  if (version == MatVersion::k73) {
    throw InputError(path, 0,
                     "is a MATLAB file of version 7.3; expected one saved with "
                     "-v7, -v6 or -v4");
  }
  if (version == MatVersion::k5) {
    VisitMat5(file, visit);
  } else {
    VisitMat4(file, visit);
  }
}

NumericArray ReadMat(const std::string& path, const std::string& variable) {
  std::optional<NumericArray> found;
  std::string names;
  std::set<std::string> known;
  VisitMat(path, [&](const MatVariable& here,
                     const std::function<NumericArray()>& values) {
    if (!here.name.empty() && !known.insert(here.name).second) {
      throw InputError(path, 0, "holds the variable '" + here.name + "' twice");
    }
    names += (names.empty() ? "" : ", ") + here.name;
    if (here.name != variable) return;
    if (!here.unfit.empty()) {
      throw InputError(path, 0,
                       "the variable '" + variable +
                           "' is no real matrix of numbers: it is " +
                           here.unfit);
    }
    found = values();
  });
  if (!found) {
    throw InputError(path, 0,
                     "has no variable '" + variable + "'; it holds " +
                         (names.empty() ? "none" : names));
  }
  return std::move(*found);
}

const FileFormat& MatFormat() {
  static const FileFormat kFormat = {
      .name = "mat",
      .help = "full, real matrices of a MATLAB file of version 7, 6 or 4",
      .streams = "all",
      .takes_columns = true,
      .whole_recordings = true,
      .open =
          [](const TableRequest& request) {
            return OpenArrays(request, ReadMat);
          },
      .read_columns =
          [](const std::string& path) {
            return std::filesystem::path(path).extension() == ".mat"
                       ? std::optional(ReadMatColumns(path))
                       : std::nullopt;
          }};
  return kFormat;
}

}  // namespace hindsight
