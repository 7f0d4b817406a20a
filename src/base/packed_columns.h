#ifndef HINDSIGHT_BASE_PACKED_COLUMNS_H_
#define HINDSIGHT_BASE_PACKED_COLUMNS_H_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace hindsight {

using PackedWord = std::uint64_t;

/// Rows of 64-bit words in little memory, without loss. Rows are held in blocks
/// of kRows, each block column by column in the narrowest of these forms:
///   word k of the block = base + slope k + (fraction k) / kRows + code k
///   word k of the block = values[code k],
/// the codes being 0 to 8 bytes wide. A column of one value takes nothing, one
/// of regular stamps a byte or two a row, one of at most 256 values a byte, and
/// none more than 8 bytes. The block that was written last is held as it is.
class PackedColumns {
 public:
  static constexpr unsigned kLogRows = 14;
  static constexpr std::size_t kRows = std::size_t{1} << kLogRows;

  std::size_t size() const { return size_; }
  /// Adds a row. Columns that a row lacks hold zero there.
  void Append(std::span<const PackedWord> row);
  /// Fills the whole of `row`.
  void Read(std::size_t index, std::span<PackedWord> row) const;
  /// Rows are best written in their order: each block is unpacked once.
  void Write(std::size_t index, std::span<const PackedWord> row);
  void PopBack();

 private:
  struct Column {
    PackedWord base = 0;
    PackedWord slope = 0;
    std::uint32_t values = 0;  ///< where they begin in Block::bytes
    std::uint32_t codes = 0;
    std::uint16_t fraction = 0;
    std::uint8_t width = 0;  ///< of a code [bytes]
    bool lookup = false;     ///< the codes choose one of the values
  };
  struct Block {
    std::vector<Column> columns;
    std::vector<std::uint8_t> bytes;
  };
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  static PackedWord At(const Block& block, const Column& column, std::size_t k);
  static Column Line(std::span<const PackedWord> words, PackedWord slope,
                     std::uint16_t fraction);
  static bool Lookup(std::span<const PackedWord> words, unsigned width,
                     Block* block);
  static void PackColumn(std::span<const PackedWord> words, Block* block);
  /// Gives the open block the columns in which the row is not zero.
  void AddColumns(std::span<const PackedWord> row);
  /// Packs the block that is open and unpacks this one.
  void Open(std::size_t block);

  std::size_t size_ = 0;
  std::vector<Block> blocks_;
  std::size_t open_ = kNone;                    ///< has no entry in its Block
  std::vector<std::vector<PackedWord>> words_;  ///< columns of the open block
};

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_PACKED_COLUMNS_H_
