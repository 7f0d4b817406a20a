#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "base/error.h"
#include "io/read/mat_element.h"
#include "io/read/mat_file.h"

namespace hindsight {
namespace {

constexpr std::size_t kMat5Header = 128;
constexpr std::size_t kTagSize = 8;
constexpr std::size_t kMostDimensions = 32;

// Types of elements.
constexpr std::uint32_t kInt8 = 1;
constexpr std::uint32_t kInt32 = 5;
constexpr std::uint32_t kUint32 = 6;
constexpr std::uint32_t kMatrix = 14;
constexpr std::uint32_t kCompressed = 15;

struct MatTag {
  std::uint32_t type = 0;
  std::size_t size = 0;
  bool small = false;  ///< its data stand in the tag itself
  std::array<char, 4> data = {};
};

MatTag ParseTag(const char* data, bool big_endian) {
  MatTag tag;
  tag.type = MatWord(data, big_endian);
  tag.size = MatWord(data + 4, big_endian);
  if (tag.type >> 16 != 0) {
    tag.small = true;
    tag.size = tag.type >> 16;
    tag.type &= 0xffff;
    std::memcpy(tag.data.data(), data + 4, 4);
  }
  return tag;
}

std::optional<NumberType> NumbersOf(std::uint32_t type) {
  constexpr std::array kNumbers = {NumberType::kI1, NumberType::kU1,
                                   NumberType::kI2, NumberType::kU2,
                                   NumberType::kI4, NumberType::kU4};
  if (type >= 1 && type <= kNumbers.size()) return kNumbers[type - 1];
  if (type == 7) return NumberType::kF4;
  if (type == 9) return NumberType::kF8;
  if (type == 12) return NumberType::kI8;
  if (type == 13) return NumberType::kU8;
  return std::nullopt;
}

/// What a class of arrays is called that holds no plain numbers.
std::string UnfitClass(std::uint32_t array_class) {
  switch (array_class) {
    case 1:
      return "a cell array";
    case 2:
      return "a structure";
    case 3:
      return "an object";
    case 4:
      return "text";
    case 5:
      return "a sparse matrix";
    default:
      return array_class >= 6 && array_class <= 15
                 ? ""
                 : "of a class that is not known";
  }
}

/// int8 to uint64. Their values may be stored as smaller integers, those of
/// floating-point classes as any numbers.
bool IsIntegerClass(std::uint32_t array_class) {
  return array_class >= 8 && array_class <= 15;
}

class MatrixReader {
 public:
  MatrixReader(MatElement* element, bool big_endian)
      : element_(*element), big_endian_(big_endian) {}

  MatVariable ReadHeader() {
    const std::string flags = Bytes(kUint32, 8);
    if (flags.size() != 8) element_.Fail("it has no class");
    const std::uint32_t word = MatWord(flags.data(), big_endian_);
    constexpr std::uint32_t kComplex = 0x0800;
    MatVariable variable;
    class_ = word & 0xff;
    variable.unfit = UnfitClass(class_);
    if (variable.unfit.empty() && (word & kComplex) != 0) {
      variable.unfit = "a complex matrix";
    }
    const std::string shape = Bytes(kInt32, 4 * kMostDimensions);
    for (std::size_t i = 0; i + 4 <= shape.size(); i += 4) {
      variable.shape.push_back(MatWord(shape.data() + i, big_endian_));
    }
    if (variable.shape.size() < 2) {
      element_.Fail("it has no dimensions");
    }
    if (variable.unfit.empty() && variable.shape.size() > 2) {
      variable.unfit =
          "of " + std::to_string(variable.shape.size()) + " dimensions";
    }
    variable.name = Bytes(kInt8, kLongestMatName);
    element_.SetName(variable.name);
    return variable;
  }

  NumericArray ReadValues(const MatVariable& variable) {
    const MatTag tag = ReadTag();
    const std::optional<NumberType> type = NumbersOf(tag.type);
    if (!type) element_.Fail("it holds no numbers");
    if (IsIntegerClass(class_) &&
        (*type == NumberType::kF4 || *type == NumberType::kF8)) {
      element_.Fail(
          "its class is one of integers, its values are floating-point "
          "numbers");
    }
    const std::size_t count = tag.size / Width(*type);
    const std::size_t rows = variable.shape[0];
    const std::size_t columns = variable.shape[1];
    if (tag.size % Width(*type) != 0 ||
        (rows == 0 || columns == 0
             ? count != 0
             : count / columns != rows || count % columns != 0)) {
      element_.Fail("it holds " + std::to_string(tag.size) +
                    " bytes, which do not fit " + std::to_string(rows) + " x " +
                    std::to_string(columns) + " numbers");
    }
    if (!tag.small && tag.size > element_.left()) {
      element_.Fail("its values are longer than it");
    }
    return ReadMatValues(variable, *type, big_endian_, element_.Most(),
                         [&](char* data, std::size_t bytes) {
                           if (tag.small) {
                             std::memcpy(data, tag.data.data(), bytes);
                           } else {
                             element_.Read(data, bytes);
                           }
                         });
  }

 private:
  MatTag ReadTag() {
    std::array<char, kTagSize> data;
    element_.Read(data.data(), data.size());
    const MatTag tag = ParseTag(data.data(), big_endian_);
    if (tag.small && tag.size > tag.data.size()) {
      element_.Fail("a small part is longer than its tag");
    }
    return tag;
  }

  /// The bytes of a part of this type, which are at most `most`.
  std::string Bytes(std::uint32_t type, std::size_t most) {
    const MatTag tag = ReadTag();
    if (tag.type != type || tag.size > most) {
      element_.Fail("a part of its header is none");
    }
    if (tag.small) return {tag.data.data(), tag.size};
    std::string bytes(tag.size, '\0');
    element_.Read(bytes.data(), bytes.size());
    element_.Skip((8 - tag.size % 8) % 8);
    return bytes;
  }

  MatElement& element_;
  bool big_endian_;
  std::uint32_t class_ = 0;
};

void VisitElement(const InputFile& file, std::size_t offset, const MatTag& tag,
                  bool big_endian, const MatVisitor& visit) {
  MatElement element(file, offset, tag.size, tag.type == kCompressed);
  element.SetSize(tag.size);
  if (tag.type == kCompressed) {
    std::array<char, kTagSize> inner;
    element.Read(inner.data(), inner.size());
    const MatTag matrix = ParseTag(inner.data(), big_endian);
    if (matrix.type != kMatrix) element.Fail("it is no matrix");
    element.SetSize(matrix.size);
  }
  MatrixReader reader(&element, big_endian);
  const MatVariable variable = reader.ReadHeader();
  visit(variable, [&] {
    NumericArray array = reader.ReadValues(variable);
    if (element.left() >= kTagSize) element.Fail("it holds more than it says");
    element.Skip(element.left());
    element.Finish();
    return array;
  });
}

}  // namespace

void VisitMat5(const InputFile& file, const MatVisitor& visit) {
  std::array<char, 4> mark;
  file.ReadAt(124, mark.data(), mark.size());
  const bool big_endian = mark[2] == 'M';
  std::size_t offset = kMat5Header;
  while (offset < file.size()) {
    std::array<char, kTagSize> bytes;
    if (file.ReadAt(offset, bytes.data(), kTagSize) < kTagSize)
      FailCutOff(file, "");
    const MatTag tag = ParseTag(bytes.data(), big_endian);
    offset += kTagSize;
    if (tag.type != kMatrix && tag.type != kCompressed) {
      throw InputError(file.path(), 0,
                       "is a damaged MATLAB file: it holds something that is "
                       "no variable");
    }
    if (tag.size > file.size() - offset) {
      std::string name;
      try {
        VisitElement(
            file, offset, tag, big_endian,
            [&](const MatVariable& cut, const auto&) { name = cut.name; });
      } catch (const InputError&) {
        // So little of it is there that not even its name is.
      }
      FailCutOff(file, name);
    }
    VisitElement(file, offset, tag, big_endian, visit);
    offset += tag.small ? 0 : tag.size;
  }
}

}  // namespace hindsight
