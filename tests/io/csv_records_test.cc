#include "io/read/csv_records.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "io/write/csv_line.h"
#include "support/temporary_folder.h"

namespace hindsight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<CsvRecord> Read(const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = folder.Path("a.csv");
  std::ofstream(path) << text;
  return ReadCsvRecords(path);
}

TEST(CsvRecords, AreReadAsSpreadsheetsWriteThem) {
  const auto records =
      Read("\xEF\xBB\xBF# words\r\n\r\na , b\r\n\"x, \"\"y\"\"\nz\",\r\n1,2");
  ASSERT_EQ(records.size(), 3u);
  EXPECT_EQ(records[0].line, 3);
  EXPECT_THAT(records[0].fields, ElementsAre("a", "b"));
  EXPECT_THAT(records[1].fields, ElementsAre("x, \"y\"\nz", ""));
  EXPECT_EQ(records[2].line, 6);
  EXPECT_THAT(records[2].fields, ElementsAre("1", "2"));
}

TEST(CsvRecords, WhatIsWrittenIsRead) {
  const std::vector<std::string> fields = {"#1",         "a,b", "\"",
                                           "two\nlines", "",    "plain"};
  const auto records = Read(CsvLine(fields));
  ASSERT_EQ(records.size(), 1u);
  EXPECT_EQ(records[0].fields, fields);
}

TEST(CsvRecords, BadOnesAreNamedByTheirLine) {
  const auto error = [](const std::string& text) -> std::string {
    try {
      Read(text);
    } catch (const InputError& refused) {
      return refused.what();
    }
    return "";
  };
  EXPECT_THAT(error("a,b\n1,2,3\n"), HasSubstr("a.csv:2: 3 fields where"));
  EXPECT_THAT(error("a,b\n\n\"1,2\n"), HasSubstr("a.csv:3: expected a comma"));
  EXPECT_THAT(error("a,b\n\"1\"x,2\n"), HasSubstr("a.csv:2: expected a comma"));
}

}  // namespace
}  // namespace hindsight
