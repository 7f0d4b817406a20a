#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size);

namespace hindsight {
namespace {

/// Each file is read or refused; a crash, another exception or, under the
/// sanitizers, undefined behaviour fails.
TEST(FuzzCases, EachIsReadOrRefused) {
  int count = 0;
  const std::filesystem::path folder =
      std::string(HINDSIGHT_SOURCE_DIR) + "/tests/data/fuzz";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().string());
    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    EXPECT_NO_THROW(LLVMFuzzerTestOneInput(
        reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
    ++count;
  }
  EXPECT_GE(count, 15);
}

}  // namespace
}  // namespace hindsight
