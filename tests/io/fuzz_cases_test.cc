#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "fuzz/fuzz_input.h"
#include "io/read/file_formats.h"

namespace hindsight {
namespace {

std::filesystem::path Folder(const std::string& name) {
  return std::string(HINDSIGHT_SOURCE_DIR) + "/tests/data/fuzz/" + name;
}

std::vector<char> BytesOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Each file is read or refused; a crash, another exception or, under the
/// sanitizers, undefined behaviour fails.
void ReadCases(const std::string& name, int least,
               void (*fuzz)(const std::uint8_t*, std::size_t)) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(Folder(name))) {
    SCOPED_TRACE(entry.path().string());
    const std::vector<char> bytes = BytesOf(entry.path());
    EXPECT_NO_THROW(fuzz(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                         bytes.size()));
    ++count;
  }
  EXPECT_GE(count, least);
}

TEST(FuzzCases, EachTextIsReadOrRefused) {
  ReadCases("reader", 15, FuzzReaders);
}

/// The second byte chooses the format by its place in the list of them.
TEST(FuzzCases, EachTextIsReadAsTheFormatOfItsName) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(Folder("reader"))) {
    const std::string name = entry.path().filename().string();
    const std::vector<char> bytes = BytesOf(entry.path());
    ASSERT_GE(bytes.size(), 2u);
    const auto chosen = static_cast<unsigned char>(bytes[1]) / 16u;
    const bool is_stream = (bytes[0] & 0xf) >= 6;
    for (std::size_t i = 0; i < FileFormats().size(); ++i) {
      if (!is_stream || !name.starts_with(FileFormats()[i]->name)) continue;
      EXPECT_EQ(chosen, i) << name;
      ++count;
    }
  }
  EXPECT_GE(count, 10);
}

TEST(FuzzCases, EachBinaryFileIsReadOrRefused) {
  ReadCases("array", 10, FuzzArrays);
}

TEST(FuzzCases, EachConfigurationIsReadOrRefused) {
  ReadCases("config", 5, FuzzConfigurations);
}

}  // namespace
}  // namespace hindsight
