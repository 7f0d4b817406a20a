#include "io/read/text_lines.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "base/error.h"
#include "base/parallel.h"
#include "io/binary_files.h"
#include "io/read/file_digest.h"
#include "support/temporary_folder.h"

namespace hindsight {
namespace {

std::string ErrorOfReading(const std::string& path) {
  try {
    TextLines lines(path);
    for (std::string_view line; lines.Next(&line);) {
    }
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(TextLines, SeveralGzipStreamsAreOneText) {
  const TemporaryFolder folder;
  TextLines lines(
      folder.Write("a", Gzipped("1\n2") + Gzipped("") + Gzipped("3\r\n4")));
  std::string text;
  for (std::string_view line; lines.Next(&line);)
    text += std::string(line) + ";";
  EXPECT_EQ(text, "1;23;4;");
  EXPECT_EQ(lines.number(), 3);
  EXPECT_FALSE(lines.terminated());
}

TEST(TextLines, TheLongestLineIsReadAndALongerOneRefused) {
  const TemporaryFolder folder;
  const std::string longest(TextLines::kLongestLine, 'x');
  for (const std::string end : {"", "\n", "\nshort\n"}) {
    EXPECT_EQ(ErrorOfReading(folder.Write("a", "1\n" + longest + end)), "");
    for (const bool packed : {false, true}) {
      const std::string text = "1\nx" + longest + end;
      const std::string path = folder.Write("b", packed ? Gzipped(text) : text);
      EXPECT_EQ(ErrorOfReading(path),
                path +
                    ":2: the line is longer than 1048576 bytes; expected "
                    "lines of text");
    }
  }
}

TEST(TextLines, AFileThatShrinksIsRefused) {
  const TemporaryFolder folder;
  std::string text;
  while (text.size() < (8u << 20)) text += "0.1,0.2,0.3\n";
  const std::string path = folder.Write("a", text);
  TextLines lines(path);
  std::string_view line;
  ASSERT_TRUE(lines.Next(&line));
  std::filesystem::resize_file(path, 3u << 20);
  try {
    while (lines.Next(&line)) {
    }
    FAIL() << "read to line " << lines.number();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("has become shorter"),
              std::string::npos)
        << error.what();
  }
}

TEST(TextLines, WhatIsAppendedMeanwhileIsNotSeen) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("a", "1\n2\n");
  TextLines lines(path);
  folder.Write("a", "1\n2\n3\n");
  int count = 0;
  for (std::string_view line; lines.Next(&line);) ++count;
  EXPECT_EQ(count, 2);
}

TEST(TextLines, GiveTheDigestOfWhatTheyRead) {
  const TemporaryFolder folder;
  std::string text = "\xEF\xBB\xBF";
  while (text.size() < (5u << 20)) text += "0.1,0.2,0.3\r\n";
  const std::string path = folder.Write("a", text + "4");
  for (const int threads : {1, 2}) {
    SetThreadCount(threads);
    ReadDigests digests;
    TextLines lines(path, &digests);
    TextLines second(path, &digests);
    std::string_view line;
    while (second.Next(&line)) {
    }
    EXPECT_FALSE(digests.Of(path)) << "made by the first alone";
    while (lines.Next(&line)) {
    }
    const auto digest = digests.Of(path);
    ASSERT_TRUE(digest);
    EXPECT_EQ(digest->sha256, DigestOf(path).sha256);
    EXPECT_EQ(digest->bytes, text.size() + 1);
  }
}

TEST(TextLines, GiveNoDigestOfWhatIsPackedOrLeft) {
  const TemporaryFolder folder;
  ReadDigests digests;
  std::string_view line;
  const std::string packed = folder.Write("a", Gzipped("1\n2\n"));
  TextLines lines(packed, &digests);
  while (lines.Next(&line)) {
  }
  EXPECT_FALSE(digests.Of(packed));
  const std::string left = folder.Write("b", "1\n2\n");
  {
    TextLines begun(left, &digests);
    ASSERT_TRUE(begun.Next(&line));
  }
  EXPECT_FALSE(digests.Of(left));
}

}  // namespace
}  // namespace hindsight
