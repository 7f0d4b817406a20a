#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "fuzz/fuzz_input.h"

namespace hindsight {
namespace {

/// Each file is read or refused; a crash, another exception or, under the
/// sanitizers, undefined behaviour fails.
void ReadCases(const std::string& name, int least,
               void (*fuzz)(const std::uint8_t*, std::size_t)) {
  int count = 0;
  const std::filesystem::path folder =
      std::string(HINDSIGHT_SOURCE_DIR) + "/tests/data/fuzz/" + name;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().string());
    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    EXPECT_NO_THROW(fuzz(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                         bytes.size()));
    ++count;
  }
  EXPECT_GE(count, least);
}

TEST(FuzzCases, EachTextIsReadOrRefused) {
  ReadCases("reader", 15, FuzzReaders);
}

TEST(FuzzCases, EachBinaryFileIsReadOrRefused) {
  ReadCases("array", 10, FuzzArrays);
}

TEST(FuzzCases, EachConfigurationIsReadOrRefused) {
  ReadCases("config", 5, FuzzConfigurations);
}

}  // namespace
}  // namespace hindsight
