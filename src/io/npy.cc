#include <bit>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include "base/error.h"
#include "io/numeric_array.h"
#include "io/units.h"

namespace hindsight {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the bytes of the file are used as they stand");

constexpr std::string_view kMagic = "\x93NUMPY";

struct NpyHeader {
  std::string type;  ///< "<f8"
  bool fortran_order = false;
  std::vector<std::size_t> shape;
};

std::string ReadBytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file && bytes.empty()) throw InputError(path, 0, "cannot be read");
  if (bytes.empty()) throw InputError(path, 0, "the file is empty");
  return bytes;
}

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

NpyHeader ParseHeader(std::string_view header, const std::string& path) {
  NpyHeader parsed;
  const std::string_view type = ValueOf(header, "descr", path);
  const std::size_t quote =
      type.starts_with('\'') ? type.find('\'', 1) : type.npos;
  if (quote == type.npos) {
    throw InputError(path, 0, "holds a structure; expected plain numbers");
  }
  parsed.type = type.substr(1, quote - 1);
  parsed.fortran_order =
      ValueOf(header, "fortran_order", path).starts_with("True");
  parsed.shape = ParseShape(ValueOf(header, "shape", path), path);
  return parsed;
}

template <typename T>
void Fill(std::string_view data, const NpyHeader& header, NumericArray* array) {
  const std::size_t count = array->rows * array->columns;
  array->values.resize(count);
  if (std::is_integral_v<T>) array->integers.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    T value;
    std::memcpy(&value, data.data() + i * sizeof(T), sizeof(T));
    const std::size_t at =
        header.fortran_order
            ? i % array->rows * array->columns + i / array->rows
            : i;
    array->values[at] = static_cast<double>(value);
    if constexpr (std::is_integral_v<T>) array->integers[at] = value;
  }
}

}  // namespace

NumericArray ReadNpy(const std::string& path) {
  const std::string bytes = ReadBytes(path);
  const std::string_view view = bytes;
  if (!view.starts_with(kMagic) || view.size() < 12) {
    throw InputError(path, 0, "is no NumPy file");
  }
  const int version = view[6];
  if (version < 1 || version > 3) {
    throw InputError(path, 0, "is a NumPy file of an unknown version");
  }
  const std::size_t start = version == 1 ? 10 : 12;
  std::uint32_t length = 0;
  std::memcpy(&length, view.data() + 8, start - 8);
  if (length > view.size() - start) {
    throw InputError(path, 0, "ends within its NumPy header");
  }
  const NpyHeader header = ParseHeader(view.substr(start, length), path);
  NumericArray array;
  array.rows = header.shape[0];
  array.columns = header.shape.size() > 1 ? header.shape[1] : 1;
  const std::string_view data = view.substr(start + length);
  const std::size_t width = header.type == "<f8" || header.type == "<i8"   ? 8
                            : header.type == "<f4" || header.type == "<i4" ? 4
                                                                           : 0;
  if (width == 0) {
    throw InputError(path, 0,
                     "holds numbers of type '" + header.type +
                         "'; expected <f4, <f8, <i4 or <i8");
  }
  const bool fits =
      array.columns == 0 ||
      array.rows <= std::numeric_limits<std::uint32_t>::max() / array.columns;
  if (!fits || data.size() != array.rows * array.columns * width) {
    throw InputError(path, 0,
                     "holds " + std::to_string(data.size()) +
                         " bytes of data, which do not fit its shape");
  }
  if (header.type == "<f8") Fill<double>(data, header, &array);
  if (header.type == "<f4") Fill<float>(data, header, &array);
  if (header.type == "<i8") Fill<std::int64_t>(data, header, &array);
  if (header.type == "<i4") Fill<std::int32_t>(data, header, &array);
  return array;
}

}  // namespace hindsight
