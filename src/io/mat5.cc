#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <optional>

#include "base/error.h"
#include "io/mat_file.h"

namespace hindsight {
namespace {

constexpr std::size_t kHeader = 128;
constexpr std::size_t kTag = 8;
constexpr std::size_t kLongestName = 4096;
constexpr std::size_t kMostDimensions = 32;
/// Deflated data are never longer than this times their size.
constexpr std::size_t kDeflateLimit = 1032;

// Types of elements.
constexpr std::uint32_t kInt8 = 1;
constexpr std::uint32_t kInt32 = 5;
constexpr std::uint32_t kUint32 = 6;
constexpr std::uint32_t kMatrix = 14;
constexpr std::uint32_t kCompressed = 15;

struct Tag {
  std::uint32_t type = 0;
  std::size_t size = 0;
  bool small = false;  ///< its data stand in the tag itself
  std::array<char, 4> data = {};
};

std::uint32_t Word(const char* data, bool big_endian) {
  std::uint32_t word = 0;
  std::memcpy(&word, data, sizeof(word));
  return big_endian ? __builtin_bswap32(word) : word;
}

Tag ParseTag(const char* data, bool big_endian) {
  Tag tag;
  tag.type = Word(data, big_endian);
  tag.size = Word(data + 4, big_endian);
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

/// The bytes of one element of the file, inflated if it is compressed.
class Element {
 public:
  Element(const InputFile& file, std::size_t offset, std::size_t size,
          bool compressed)
      : file_(file), offset_(offset), end_(offset + size) {
    if (!compressed) return;
    stream_ = std::make_unique<z_stream>();
    packed_.resize(std::min(size, kPacked));
    if (inflateInit(stream_.get()) != Z_OK) throw std::bad_alloc();
  }
  ~Element() {
    if (stream_) inflateEnd(stream_.get());
  }
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;

  void Read(char* data, std::size_t count) {
    left_ -= std::min(left_, count);
    if (stream_) return Inflate(data, count);
    if (count > end_ - offset_ || file_.ReadAt(offset_, data, count) < count) {
      Fail("is damaged: its parts are longer than it");
    }
    offset_ += count;
  }
  void Skip(std::size_t count) {
    std::array<char, 4096> ignored;
    for (; count > 0; count -= std::min(count, ignored.size())) {
      Read(ignored.data(), std::min(count, ignored.size()));
    }
  }
  /// Bytes that the element still has, as its tag says it.
  void SetSize(std::size_t size) { left_ = size; }
  std::size_t left() const { return left_; }
  /// The most that can still come.
  std::size_t Most() const {
    return (end_ - offset_ + (stream_ ? stream_->avail_in : 0)) *
           (stream_ ? kDeflateLimit : 1);
  }
  /// Of compressed data: they must end here and be whole.
  void Finish() {
    if (!stream_) return;
    char beyond = 0;
    if (Pull(&beyond, 1) != 0) Fail("is damaged: it holds more than it says");
  }
  void SetName(const std::string& name) { name_ = name; }

  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(
        file_.path(), 0,
        (name_.empty() ? "a variable " : "the variable '" + name_ + "' ") +
            what + "; expected a whole MATLAB file");
  }

 private:
  static constexpr std::size_t kPacked = std::size_t{1} << 16;

  void Inflate(char* data, std::size_t count) {
    if (Pull(data, count) != count) Fail("is damaged: its data end too early");
  }

  /// Inflates up to `count` bytes, fewer only at the checked end of the data.
  std::size_t Pull(char* data, std::size_t count) {
    stream_->next_out = reinterpret_cast<unsigned char*>(data);
    stream_->avail_out = static_cast<unsigned>(count);
    while (!finished_ && stream_->avail_out > 0) {
      if (stream_->avail_in == 0) {
        const std::size_t got = file_.ReadAt(
            offset_, packed_.data(), std::min(packed_.size(), end_ - offset_));
        offset_ += got;
        stream_->next_in = reinterpret_cast<unsigned char*>(packed_.data());
        stream_->avail_in = static_cast<unsigned>(got);
      }
      const int code = inflate(stream_.get(), Z_NO_FLUSH);
      finished_ = code == Z_STREAM_END;
      if (code != Z_OK && code != Z_STREAM_END) {
        Fail("is damaged: its compressed data are not whole");
      }
    }
    return count - stream_->avail_out;
  }

  const InputFile& file_;
  std::size_t offset_;
  std::size_t end_;
  std::size_t left_ = 0;
  std::string name_;
  std::unique_ptr<z_stream> stream_;
  std::string packed_;
  bool finished_ = false;
};

class MatrixReader {
 public:
  MatrixReader(Element* element, bool big_endian)
      : element_(*element), big_endian_(big_endian) {}

  MatVariable ReadHeader() {
    const std::string flags = Bytes(kUint32, 8);
    if (flags.size() != 8) element_.Fail("is damaged: it has no class");
    const std::uint32_t word = Word(flags.data(), big_endian_);
    constexpr std::uint32_t kComplex = 0x0800;
    MatVariable variable;
    variable.unfit = UnfitClass(word & 0xff);
    if (variable.unfit.empty() && (word & kComplex) != 0) {
      variable.unfit = "a complex matrix";
    }
    const std::string shape = Bytes(kInt32, 4 * kMostDimensions);
    for (std::size_t i = 0; i + 4 <= shape.size(); i += 4) {
      variable.shape.push_back(Word(shape.data() + i, big_endian_));
    }
    if (variable.shape.size() < 2) {
      element_.Fail("is damaged: it has no dimensions");
    }
    if (variable.unfit.empty() && variable.shape.size() > 2) {
      variable.unfit =
          "of " + std::to_string(variable.shape.size()) + " dimensions";
    }
    variable.name = Bytes(kInt8, kLongestName);
    element_.SetName(variable.name);
    return variable;
  }

  NumericArray ReadValues(const MatVariable& variable) {
    const Tag tag = ReadTag();
    const std::optional<NumberType> type = NumbersOf(tag.type);
    if (!type) element_.Fail("is damaged: it holds no numbers");
    const std::size_t count = tag.size / Width(*type);
    const std::size_t rows = variable.shape[0];
    const std::size_t columns = variable.shape[1];
    if (tag.size % Width(*type) != 0 ||
        (rows == 0 || columns == 0
             ? count != 0
             : count / columns != rows || count % columns != 0)) {
      element_.Fail("is damaged: it holds " + std::to_string(tag.size) +
                    " bytes, which do not fit " + std::to_string(rows) + " x " +
                    std::to_string(columns) + " numbers");
    }
    if (!tag.small && tag.size > element_.left()) {
      element_.Fail("is damaged: its values are longer than it");
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
  Tag ReadTag() {
    std::array<char, kTag> data;
    element_.Read(data.data(), data.size());
    return ParseTag(data.data(), big_endian_);
  }

  /// The bytes of a part of this type, which are at most `most`.
  std::string Bytes(std::uint32_t type, std::size_t most) {
    const Tag tag = ReadTag();
    if (tag.type != type || tag.size > (tag.small ? 4 : most)) {
      element_.Fail("is damaged: a part of its header is none");
    }
    if (tag.small) return {tag.data.data(), tag.size};
    std::string bytes(tag.size, '\0');
    element_.Read(bytes.data(), bytes.size());
    element_.Skip((8 - tag.size % 8) % 8);
    return bytes;
  }

  Element& element_;
  bool big_endian_;
};

void VisitElement(const InputFile& file, std::size_t offset, const Tag& tag,
                  bool big_endian, const MatVisitor& visit) {
  Element element(file, offset, tag.size, tag.type == kCompressed);
  element.SetSize(tag.size);
  if (tag.type == kCompressed) {
    std::array<char, kTag> inner;
    element.Read(inner.data(), inner.size());
    const Tag matrix = ParseTag(inner.data(), big_endian);
    if (matrix.type != kMatrix) return;
    element.SetSize(matrix.size);
  }
  MatrixReader reader(&element, big_endian);
  const MatVariable variable = reader.ReadHeader();
  visit(variable, [&] {
    NumericArray array = reader.ReadValues(variable);
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
  std::size_t offset = kHeader;
  while (offset < file.size()) {
    std::array<char, kTag> bytes;
    if (file.ReadAt(offset, bytes.data(), kTag) < kTag) FailCutOff(file, "");
    const Tag tag = ParseTag(bytes.data(), big_endian);
    offset += kTag;
    const bool variable = tag.type == kMatrix || tag.type == kCompressed;
    if (tag.size > file.size() - offset) {
      std::string name;
      if (variable) {
        try {
          VisitElement(
              file, offset, tag, big_endian,
              [&](const MatVariable& cut, const auto&) { name = cut.name; });
        } catch (const InputError&) {
          // So little of it is there that not even its name is.
        }
      }
      FailCutOff(file, name);
    }
    if (variable) VisitElement(file, offset, tag, big_endian, visit);
    offset += tag.small ? 0 : tag.size;
  }
}

}  // namespace hindsight
