#include <algorithm>
#include <array>
#include <cstring>

#include "base/error.h"
#include "io/read/mat_file.h"

namespace hindsight {
namespace {

constexpr std::size_t kMat4Header = 20;
constexpr std::array kMat4Types = {NumberType::kF8, NumberType::kF4,
                                   NumberType::kI4, NumberType::kI2,
                                   NumberType::kU2, NumberType::kU1};

/// The five words before a variable's name and values.
struct Mat4Header {
  bool big_endian = false;
  NumberType type = NumberType::kF8;
  MatVariable variable;
  std::size_t name_length = 0;
  std::size_t numbers = 0;  ///< of the real and of the imaginary part together
};

/// The type is M*1000 + P*10 + T: order of bytes, numbers, kind of matrix.
bool ParseMat4Type(std::uint32_t code, bool big_endian, Mat4Header* header) {
  const std::uint32_t order = code / 1000;
  const std::uint32_t zero = code / 100 % 10;
  const std::uint32_t numbers = code / 10 % 10;
  const std::uint32_t kind = code % 10;
  if (order != (big_endian ? 1 : 0) || zero != 0 ||
      numbers >= kMat4Types.size() || kind > 2) {
    return false;
  }
  header->big_endian = big_endian;
  header->type = kMat4Types[numbers];
  if (kind == 1) header->variable.unfit = "text";
  if (kind == 2) header->variable.unfit = "a sparse matrix";
  return true;
}

Mat4Header ReadMat4Header(const InputFile& file, std::size_t offset) {
  std::array<char, kMat4Header> words;
  if (file.ReadAt(offset, words.data(), kMat4Header) < kMat4Header) {
    FailCutOff(file, "");
  }
  Mat4Header header;
  if (!ParseMat4Type(MatWord(words.data(), false), false, &header) &&
      !ParseMat4Type(MatWord(words.data(), true), true, &header)) {
    throw InputError(file.path(), 0,
                     offset == 0 ? "is no MATLAB file"
                                 : "is a damaged MATLAB file of version 4");
  }
  const auto word = [&](std::size_t i) -> std::size_t {
    return MatWord(words.data() + 4 * i, header.big_endian);
  };
  header.variable.shape = {word(1), word(2)};
  // Far beyond any file, and not yet beyond the type.
  constexpr std::size_t kMost = std::size_t{1} << 60;
  header.numbers = std::min(kMost, word(1) * word(2));
  if (word(3) != 0) {
    header.numbers *= 2;
    header.variable.unfit = "a complex matrix";
  }
  header.name_length = word(4);
  return header;
}

}  // namespace

void VisitMat4(const InputFile& file, const MatVisitor& visit) {
  std::size_t offset = 0;
  while (offset < file.size()) {
    Mat4Header header = ReadMat4Header(file, offset);
    offset += kMat4Header;
    if (header.name_length == 0 || header.name_length > kLongestMatName) {
      throw InputError(file.path(), 0,
                       "is a damaged MATLAB file of version 4: a name of " +
                           std::to_string(header.name_length) + " bytes");
    }
    std::string& name = header.variable.name;
    name.resize(header.name_length);
    if (file.ReadAt(offset, name.data(), name.size()) < name.size()) {
      FailCutOff(file, "");
    }
    offset += name.size();
    name.resize(std::strlen(name.c_str()));
    const std::size_t left = file.size() - offset;
    if (header.numbers > left / Width(header.type)) FailCutOff(file, name);
    const std::size_t size = header.numbers * Width(header.type);
    visit(header.variable, [&] {
      std::size_t at = offset;
      return ReadMatValues(header.variable, header.type, header.big_endian,
                           size, [&](char* data, std::size_t count) {
                             at += file.ReadAt(at, data, count);
                           });
    });
    offset += size;
  }
}

}  // namespace hindsight
