#include "base/packed_columns.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace hindsight {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Bytes that a number takes.
unsigned BytesFor(PackedWord most) {
  return (static_cast<unsigned>(std::bit_width(most)) + 7) / 8;
}

void AppendBytes(PackedWord word, unsigned width,
                 std::vector<std::uint8_t>* bytes) {
  for (unsigned i = 0; i < width; ++i) {
    bytes->push_back(static_cast<std::uint8_t>(word >> (8 * i)));
  }
}

/// A word is loaded in one piece, however narrow.
constexpr unsigned kWordBytes = sizeof(PackedWord);

PackedWord Load(const std::uint8_t* bytes, unsigned width) {
  PackedWord word = 0;
  std::memcpy(&word, bytes, kWordBytes);
  return width == kWordBytes ? word
                             : word & ((PackedWord{1} << (8 * width)) - 1);
}

PackedWord OnLine(PackedWord base, PackedWord slope, PackedWord fraction,
                  std::size_t k) {
  return base + slope * k + ((fraction * k) >> PackedColumns::kLogRows);
}

/// The different words of a column, numbered as they come.
class Numbering {
 public:
  Numbering() : slots_(2 * PackedColumns::kRows, 0) {}

  std::uint16_t NumberOf(PackedWord word) {
    constexpr PackedWord kMixing = 0x9e3779b97f4a7c15;
    constexpr unsigned kShift = 64 - PackedColumns::kLogRows - 1;
    for (std::size_t i = (word * kMixing) >> kShift;;
         i = (i + 1) % slots_.size()) {
      if (slots_[i] == 0) {
        words_.push_back(word);
        slots_[i] = static_cast<std::uint16_t>(words_.size());
      }
      if (words_[slots_[i] - 1U] == word) {
        return static_cast<std::uint16_t>(slots_[i] - 1U);
      }
    }
  }
  const std::vector<PackedWord>& words() const { return words_; }

 private:
  std::vector<std::uint16_t> slots_;  ///< one more than the number, 0: free
  std::vector<PackedWord> words_;
};

}  // namespace

PackedWord PackedColumns::At(const Block& block, const Column& column,
                             std::size_t k) {
  if (column.width == 0 && column.slope == 0 && column.fraction == 0) {
    return column.base;
  }
  PackedWord code = 0;
  if (column.width > 0) {
    code = Load(&block.bytes[column.codes + k * column.width], column.width);
  }
  if (column.lookup) {
    return Load(&block.bytes[column.values + code * kWordBytes], kWordBytes);
  }
  return OnLine(column.base, column.slope, column.fraction, k) + code;
}

/// The line moved down until no code is negative.
PackedColumns::Column PackedColumns::Line(std::span<const PackedWord> words,
                                          PackedWord slope,
                                          std::uint16_t fraction) {
  std::int64_t least = 0;
  std::int64_t most = 0;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const auto above = static_cast<std::int64_t>(
        words[k] - OnLine(words[0], slope, fraction, k));
    least = std::min(least, above);
    most = std::max(most, above);
  }
  Column column;
  column.base = words[0] + static_cast<PackedWord>(least);
  column.slope = slope;
  column.fraction = fraction;
  column.width = static_cast<std::uint8_t>(
      BytesFor(static_cast<PackedWord>(most) - static_cast<PackedWord>(least)));
  return column;
}

/// Packs the column by its values if that makes the codes narrower than `width`
/// by more than the values take.
bool PackedColumns::Lookup(std::span<const PackedWord> words, unsigned width,
                           Block* block) {
  constexpr std::size_t kByte = 256;
  const auto bytes = [&words](std::size_t values) {
    return values * kWordBytes + words.size() * (values > kByte ? 2 : 1);
  };
  Numbering numbering;
  std::vector<std::uint16_t> codes;
  codes.reserve(words.size());
  for (const PackedWord word : words) {
    codes.push_back(numbering.NumberOf(word));
    if (bytes(numbering.words().size()) >= words.size() * width) return false;
  }
  Column column;
  column.lookup = true;
  column.width = numbering.words().size() > kByte ? 2 : 1;
  column.values = static_cast<std::uint32_t>(block->bytes.size());
  for (const PackedWord word : numbering.words()) {
    AppendBytes(word, kWordBytes, &block->bytes);
  }
  column.codes = static_cast<std::uint32_t>(block->bytes.size());
  for (const std::uint16_t code : codes) {
    AppendBytes(code, column.width, &block->bytes);
  }
  block->columns.push_back(column);
  return true;
}

void PackedColumns::PackColumn(std::span<const PackedWord> words,
                               Block* block) {
  const auto last = static_cast<std::int64_t>(words.size()) - 1;
  const auto rise = static_cast<std::int64_t>(words.back() - words.front());
  Column column = Line(words, 0, 0);
  if (column.width > 1) {
    std::int64_t slope = rise / last;
    std::int64_t rest = rise % last;
    if (rest < 0) {
      slope -= 1;
      rest += last;
    }
    const auto fraction =
        static_cast<std::uint16_t>((static_cast<PackedWord>(rest) << kLogRows) /
                                   static_cast<PackedWord>(last));
    const Column sloping =
        Line(words, static_cast<PackedWord>(slope), fraction);
    if (sloping.width < column.width) column = sloping;
  }
  if (column.width > 1 && Lookup(words, column.width, block)) return;
  column.codes = static_cast<std::uint32_t>(block->bytes.size());
  for (std::size_t k = 0; k < words.size() && column.width > 0; ++k) {
    const PackedWord line =
        OnLine(column.base, column.slope, column.fraction, k);
    AppendBytes(words[k] - line, column.width, &block->bytes);
  }
  block->columns.push_back(column);
}

void PackedColumns::Open(std::size_t block) {
  if (block == open_) return;
  if (open_ < blocks_.size()) {
    Block packed;
    for (const std::vector<PackedWord>& words : words_)
      PackColumn(words, &packed);
    packed.bytes.resize(packed.bytes.size() + kWordBytes);
    packed.columns.shrink_to_fit();
    packed.bytes.shrink_to_fit();
    blocks_[open_] = std::move(packed);
  }
  open_ = block;
  const Block packed = std::move(blocks_[block]);
  blocks_[block] = {};
  const std::size_t rows = std::min(kRows, size_ - block * kRows);
  words_.resize(std::max(words_.size(), packed.columns.size()));
  for (std::size_t c = 0; c < words_.size(); ++c) {
    words_[c].assign(rows, 0);
    for (std::size_t k = 0; k < rows && c < packed.columns.size(); ++k) {
      words_[c][k] = At(packed, packed.columns[c], k);
    }
  }
}

void PackedColumns::AddColumns(std::span<const PackedWord> row) {
  std::size_t count = row.size();
  while (count > words_.size() && row[count - 1] == 0) --count;
  if (count <= words_.size()) return;
  const std::size_t rows = std::min(kRows, size_ - open_ * kRows);
  words_.resize(count, std::vector<PackedWord>(rows, 0));
}

void PackedColumns::Append(std::span<const PackedWord> row) {
  const std::size_t block = size_ / kRows;
  if (block == blocks_.size()) blocks_.emplace_back();
  Open(block);
  AddColumns(row);
  for (std::size_t c = 0; c < words_.size(); ++c) {
    words_[c].push_back(c < row.size() ? row[c] : 0);
  }
  ++size_;
}

void PackedColumns::Read(std::size_t index, std::span<PackedWord> row) const {
  const std::size_t k = index % kRows;
  const Block& block = blocks_[index / kRows];
  const bool open = index / kRows == open_;
  const std::size_t columns =
      std::min(row.size(), open ? words_.size() : block.columns.size());
  for (std::size_t c = 0; c < columns; ++c) {
    row[c] = open ? words_[c][k] : At(block, block.columns[c], k);
  }
  std::fill(row.begin() + static_cast<std::ptrdiff_t>(columns), row.end(), 0);
}

void PackedColumns::Write(std::size_t index, std::span<const PackedWord> row) {
  Open(index / kRows);
  AddColumns(row);
  for (std::size_t c = 0; c < words_.size(); ++c) {
    words_[c][index % kRows] = c < row.size() ? row[c] : 0;
  }
}

void PackedColumns::PopBack() {
  Open((size_ - 1) / kRows);
  for (std::vector<PackedWord>& words : words_) words.pop_back();
  --size_;
  if (size_ % kRows != 0) return;
  blocks_.pop_back();
  open_ = kNone;
}

}  // namespace hindsight
