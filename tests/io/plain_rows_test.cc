#include "io/read/plain_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "io/read/text_row_parser.h"

namespace hindsight {
namespace {

/// A stamp and numbers, one of which is skipped and one absent.
TableLayout PlainLayout(char delimiter, bool skips) {
  TableLayout layout;
  layout.delimiter = delimiter;
  layout.time_column = 0;
  layout.column_count = skips ? 4 : 3;
  layout.fields.push_back({"x", 1, 0.5});
  layout.fields.push_back({"absent", -1});
  layout.fields.push_back({"y", skips ? 3 : 2, -2.0});
  return layout;
}

struct ReadRow {
  std::string problem;
  std::vector<double> values = std::vector<double>(3, 7.0);
  Stamp stamp;
  int columns = 0;
  std::size_t last_length = 0;
};

ReadRow ReadBy(const TableLayout& layout, const std::string& line) {
  const TextRowParser parser(layout, false);
  TextRowParser::Scratch scratch;
  ReadRow row;
  row.problem = parser.Parse(line, &scratch, row.values, &row.stamp,
                             &row.columns, &row.last_length);
  return row;
}

/// That a number is bad which stands nowhere makes no row plain.
TableLayout WithoutPlainRows(TableLayout layout) {
  layout.bad_values = {-98765.0};
  return layout;
}

bool IsPlain(const TableLayout& layout, const std::string& line) {
  std::vector<double> values(3);
  Stamp stamp;
  std::size_t length = 0;
  return PlainRows(layout).Read(line, values, &stamp, &length);
}

void ExpectSameAsOfAnyRow(const TableLayout& layout, const std::string& line) {
  const ReadRow plain = ReadBy(layout, line);
  const ReadRow any = ReadBy(WithoutPlainRows(layout), line);
  EXPECT_EQ(plain.problem, any.problem) << line;
  EXPECT_EQ(plain.columns, any.columns) << line;
  EXPECT_EQ(plain.last_length, any.last_length) << line;
  if (!plain.problem.empty()) return;
  EXPECT_EQ(plain.stamp.seconds, any.stamp.seconds) << line;
  EXPECT_EQ(plain.stamp.fraction, any.stamp.fraction) << line;
  EXPECT_EQ(plain.values[0], any.values[0]) << line;
  EXPECT_EQ(std::signbit(plain.values[0]), std::signbit(any.values[0])) << line;
  EXPECT_TRUE(std::isnan(plain.values[1])) << line;
  EXPECT_EQ(plain.values[2], any.values[2]) << line;
}

const std::vector<std::string> kStamps = {"0",
                                          "0.005",
                                          "-3.25",
                                          "123456789.5",
                                          "1234567890.5",
                                          "0000000012",
                                          "000.5",
                                          "0000000.125",
                                          "1e3",
                                          "12345678901e-5",
                                          "1e30",
                                          "+4",
                                          "nan",
                                          "1700000000000",
                                          "1e-320",
                                          ""};
const std::vector<std::string> kNumbers = {
    "1",   "-2.5e-6", "1E5",   "+3",      " 4", "5 ",  "\t6", "1e400",
    "inf", "nan",     "\"7\"", "8x",      "1.", ".5",  "",    "0x1",
    "-",   "1e-400",  "1,5",   "1e",      "-0", "-.5", "--2", "-+2",
    "- 2", "-inf",    "-nan",  "-1e-400", "-1."};

TEST(PlainRows, ReadWhatIsReadOfAnyRow) {
  for (const char delimiter : {',', ';', ' '}) {
    for (const bool skips : {false, true}) {
      for (const std::int64_t ticks : {std::int64_t{1}, std::int64_t{1'000}}) {
        TableLayout layout = PlainLayout(delimiter, skips);
        layout.ticks_per_second = ticks;
        const std::string comma(1, delimiter);
        for (const std::string& t : kStamps) {
          for (const std::string& x : kNumbers) {
            std::string row = t + comma + x + comma;
            if (skips) row += "\"a b\"" + comma;
            for (const char* y : {"9.75", "1e-3 ", "", "9", "9,1", "-.5e+2"}) {
              ExpectSameAsOfAnyRow(layout, row + y);
            }
            if (skips) {
              ExpectSameAsOfAnyRow(
                  layout, t + comma + x + comma + "a\tb" + comma + "2");
            }
          }
        }
      }
    }
  }
}

TEST(PlainRows, AreThoseOfNumbersBetweenDelimiters) {
  const TableLayout layout = PlainLayout(',', true);
  EXPECT_TRUE(IsPlain(layout, "0.005,-1.5e-06,word,3"));
  EXPECT_TRUE(IsPlain(layout, "-0.005,-0,word,-.5"));
  EXPECT_FALSE(IsPlain(layout, "0.005, 1,word,3"));
  EXPECT_FALSE(IsPlain(layout, "0.005,--1,word,3"));
  EXPECT_FALSE(IsPlain(layout, "0.005,1,word,-"));
  EXPECT_FALSE(IsPlain(layout, "0.005,1,word,3,4"));
  EXPECT_FALSE(IsPlain(layout, "0.005,1,word"));
  EXPECT_FALSE(IsPlain(layout, "0.005,1,\"word\",3"));
  EXPECT_TRUE(IsPlain(PlainLayout(' ', false), "0.005 1 2"));
  EXPECT_FALSE(IsPlain(PlainLayout(' ', false), "0.005  1 2"));
}

TEST(PlainRows, AreNoneOfALayoutThatAsksForMore) {
  const std::string row = "0.005,1,word,3";
  TableLayout layout = PlainLayout(',', true);
  layout.fields[0].has_minutes = true;
  EXPECT_FALSE(IsPlain(layout, row));
  layout = PlainLayout(',', true);
  layout.fields[2].is_place = true;
  EXPECT_FALSE(IsPlain(layout, row));
  layout = PlainLayout(',', true);
  layout.fields[2].column = layout.fields[0].column;
  EXPECT_FALSE(IsPlain(layout, row));
  layout = PlainLayout(',', true);
  layout.clock = TableLayout::Clock::kIso;
  EXPECT_FALSE(IsPlain(layout, row));
  layout = PlainLayout(',', true);
  layout.column_count = 0;
  EXPECT_FALSE(IsPlain(layout, row));
}

}  // namespace
}  // namespace hindsight
