#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "io/read/array_rows.h"
#include "io/read/file_columns.h"
#include "io/read/file_formats.h"
#include "io/read/input_file.h"
#include "io/read/numeric_array.h"
#include "io/read/paths.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

constexpr std::string_view kNpyMagic = "\x93NUMPY";

struct NpyHeader {
  std::string type;  ///< "<f8"
  bool fortran_order = false;
  std::vector<std::size_t> shape;
};

/// The text behind "'key':" in the header, which is a Python dictionary.
std::string_view ValueOf(std::string_view header, const std::string& key,
                         const std::string& path) {
  const std::size_t at = header.find("'" + key + "':");
  if (at == header.npos) {
    throw InputError(path, 0, "has no '" + key + "' in its NumPy header");
  }
  return Trim(header.substr(at + key.size() + 3));
}

std::vector<std::size_t> ParseShape(std::string_view text,
                                    const std::string& path) {
  const std::size_t close = text.find(')');
  std::vector<std::size_t> shape;
  bool good = text.starts_with('(') && close != text.npos;
  text = good ? text.substr(1, close - 1) : std::string_view();
  while (good && !Trim(text).empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const std::string_view item = Trim(text.substr(0, comma));
    std::size_t size = 0;
    const auto result =
        std::from_chars(item.data(), item.data() + item.size(), size);
    good = result.ec == std::errc() && result.ptr == item.data() + item.size();
    shape.push_back(size);
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  if (!good || shape.empty() || shape.size() > 2) {
    throw InputError(path, 0, "has another shape than N or N x M");
  }
  return shape;
}

NpyHeader ParseNpyHeader(std::string_view header, const std::string& path) {
  NpyHeader parsed;
  const std::string_view type = ValueOf(header, "descr", path);
  const std::size_t quote =
      type.starts_with('\'') ? type.find('\'', 1) : type.npos;
  if (quote == type.npos) {
    throw InputError(path, 0, "holds a structure; expected plain numbers");
  }
  parsed.type = type.substr(1, quote - 1);
  const std::string_view order = ValueOf(header, "fortran_order", path);
  parsed.fortran_order = order.starts_with("True");
  if (!parsed.fortran_order && !order.starts_with("False")) {
    throw InputError(path, 0, "has no order in its NumPy header");
  }
  parsed.shape = ParseShape(ValueOf(header, "shape", path), path);
  return parsed;
}

struct NpyType {
  const char* name;
  NumberType type;
};

constexpr std::array kNpyTypes = {
    NpyType{"<f8", NumberType::kF8}, NpyType{"<f4", NumberType::kF4},
    NpyType{"<i8", NumberType::kI8}, NpyType{"<i4", NumberType::kI4},
    NpyType{"<u8", NumberType::kU8}, NpyType{"<u4", NumberType::kU4},
    NpyType{"<i2", NumberType::kI2}, NpyType{"<u2", NumberType::kU2},
    NpyType{"|i1", NumberType::kI1}, NpyType{"|u1", NumberType::kU1},
};

NumberType NpyTypeOf(const NpyHeader& header, const std::string& path) {
  std::string known;
  for (const NpyType& type : kNpyTypes) {
    if (header.type == type.name) return type.type;
    known += (known.empty() ? "" : ", ") + std::string(type.name);
  }
  throw InputError(
      path, 0,
      "holds numbers of type '" + header.type + "'; expected one of " + known);
}

/// Where the bytes of an array are: a file, or memory.
struct NpyBytes {
  std::string path;
  std::size_t size = 0;
  /// As InputFile::ReadAt.
  std::function<std::size_t(std::size_t, char*, std::size_t)> read_at;
};

/// The header's text; `data` becomes where it ends.
std::string ReadNpyHeader(const NpyBytes& file, std::size_t* data) {
  constexpr std::size_t kShort = 10;
  constexpr std::size_t kLong = 12;
  // NumPy itself refuses longer ones.
  constexpr std::size_t kLongestHeader = 10000;
  std::array<char, kLong> start = {};
  const std::size_t count = file.read_at(0, start.data(), start.size());
  if (count == 0) throw InputError(file.path, 0, "the file is empty");
  if (!std::string_view(start.data(), count).starts_with(kNpyMagic) ||
      count < kLong) {
    throw InputError(file.path, 0, "is no NumPy file");
  }
  const auto version = static_cast<unsigned char>(start[6]);
  if (version < 1 || version > 3) {
    throw InputError(file.path, 0, "is a NumPy file of an unknown version");
  }
  const std::size_t begin = version == 1 ? kShort : kLong;
  std::uint32_t length = 0;
  std::memcpy(&length, start.data() + 8, begin - 8);
  if (length > kLongestHeader || length > file.size - begin) {
    throw InputError(file.path, 0, "ends within its NumPy header");
  }
  std::string header(length, '\0');
  file.read_at(begin, header.data(), length);
  *data = begin + length;
  return header;
}

NumericArray ReadArray(const NpyBytes& file) {
  const std::string& path = file.path;
  std::size_t data = 0;
  const std::string text = ReadNpyHeader(file, &data);
  const NpyHeader header = ParseNpyHeader(text, path);
  NumericArray array;
  array.type = NpyTypeOf(header, path);
  array.column_major = header.fortran_order;
  array.rows = header.shape[0];
  array.columns = header.shape.size() > 1 ? header.shape[1] : 1;
  const std::size_t bytes = file.size - data;
  const std::size_t count = bytes / Width(array.type);
  const bool fits = array.columns == 0 ? bytes == 0
                                       : count / array.columns == array.rows &&
                                             count % array.columns == 0 &&
                                             bytes % Width(array.type) == 0;
  if (!fits) {
    throw InputError(path, 0,
                     "holds " + std::to_string(bytes) +
                         " bytes of data, which do not fit its shape");
  }
  array.bytes.resize(bytes);
  file.read_at(data, array.bytes.data(), bytes);
  return array;
}

}  // namespace

NumericArray ReadNpy(const std::string& path) {
  const InputFile file(path);
  return ReadArray({path, file.size(),
                    [&file](std::size_t offset, char* data, std::size_t count) {
                      return file.ReadAt(offset, data, count);
                    }});
}

NumericArray ReadNpy(const std::string& path, const std::string& bytes) {
  return ReadArray(
      {path, bytes.size(),
       [&bytes](std::size_t offset, char* data, std::size_t count) {
         return offset > bytes.size() ? 0 : bytes.copy(data, count, offset);
       }});
}

namespace {

/// `name` is a file below a folder, or `path` is the file.
NumericArray ReadNamedNpy(const std::string& path, const std::string& name) {
  if (name.empty()) return ReadNpy(path);
  return ReadNpy((std::filesystem::path(path) / name).string());
}

}  // namespace

const FileFormat& NpyFormat() {
  static const FileFormat kFormat = {
      .name = "npy",
      .help = "NumPy arrays, one file or a folder of them",
      .streams = "all",
      .takes_columns = true,
      .open =
          [](const TableRequest& request) {
            return OpenArrays(request, ReadNamedNpy);
          },
      .read_columns =
          [](const std::string& path) {
            return IsFolder(path) ? ReadNpyColumns(path) : std::nullopt;
          }};
  return kFormat;
}

}  // namespace hindsight
