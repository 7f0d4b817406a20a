#include "base/packed_columns.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

namespace hindsight {
namespace {

using Row = std::vector<PackedWord>;

PackedWord Bits(double value) { return std::bit_cast<PackedWord>(value); }

/// A column of every form, for which `k` chooses the word.
Row RowOf(std::size_t k) {
  const auto i = static_cast<double>(k);
  const PackedWord noise = (k + 1) * 0x9e3779b97f4a7c15;
  return {Bits(9.81),                // one value
          Bits(1234.5 + i / 100.0),  // stamps
          Bits(1e6 - i / 3.0),       // stamps that run backwards
          Bits(std::floor(std::fmod(i * 0.37, 10.0))),     // few values
          Bits(0.001 * static_cast<double>(noise >> 52)),  // many values
          noise,                                           // anything
          k % 7 == 0 ? Bits(std::nan("")) : Bits(-0.0),
          k % 2 == 0 ? PackedWord{0} : ~PackedWord{0}};
}

void ExpectRows(const PackedColumns& columns, std::size_t count) {
  ASSERT_EQ(columns.size(), count);
  Row row(RowOf(0).size() + 1);
  for (std::size_t k = 0; k < count; ++k) {
    columns.Read(k, row);
    Row expected = RowOf(k);
    expected.push_back(0);
    ASSERT_EQ(row, expected) << k;
  }
}

constexpr std::size_t kCount = 3 * PackedColumns::kRows + 100;

PackedColumns Filled() {
  PackedColumns columns;
  for (std::size_t k = 0; k < kCount; ++k) columns.Append(RowOf(k));
  return columns;
}

TEST(PackedColumns, GivesBackWhatWasPutIn) { ExpectRows(Filled(), kCount); }

TEST(PackedColumns, RowsAreWrittenInAnyOrder) {
  PackedColumns columns = Filled();
  const std::size_t some[] = {kCount - 1, 5, PackedColumns::kRows, 6, 0};
  for (const std::size_t k : some) columns.Write(k, RowOf(k + 1));
  Row row(RowOf(0).size());
  for (const std::size_t k : some) {
    columns.Read(k, row);
    EXPECT_EQ(row, RowOf(k + 1));
    columns.Write(k, RowOf(k));
  }
  ExpectRows(columns, kCount);
}

TEST(PackedColumns, RowsAreTakenFromTheEnd) {
  PackedColumns columns = Filled();
  const std::size_t left = PackedColumns::kRows - 1;
  while (columns.size() > left) columns.PopBack();
  ExpectRows(columns, left);
  for (std::size_t k = left; k < kCount; ++k) columns.Append(RowOf(k));
  ExpectRows(columns, kCount);
  while (columns.size() > 0) columns.PopBack();
  columns.Append(RowOf(0));
  ExpectRows(columns, 1);
}

TEST(PackedColumns, WhatARowLacksIsZero) {
  PackedColumns columns;
  columns.Append(Row{1});
  for (std::size_t k = 0; k < PackedColumns::kRows; ++k) {
    columns.Append(Row{2, 3});
  }
  columns.Append(Row{4});
  Row row(3);
  columns.Read(0, row);
  EXPECT_EQ(row, (Row{1, 0, 0}));
  columns.Read(PackedColumns::kRows, row);
  EXPECT_EQ(row, (Row{2, 3, 0}));
  columns.Read(PackedColumns::kRows + 1, row);
  EXPECT_EQ(row, (Row{4, 0, 0}));
}

}  // namespace
}  // namespace hindsight
