#include "base/scratch_memory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/paged_rows.h"
#include "base/paged_vector.h"

namespace hindsight {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 20;

/// $TMPDIR set to another folder, for as long as it lives.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& folder) {
    if (const char* before = std::getenv("TMPDIR")) before_ = before;
    setenv("TMPDIR", folder.c_str(), 1);
  }
  ~TemporaryFolder() {
    if (before_) {
      setenv("TMPDIR", before_->c_str(), 1);
    } else {
      unsetenv("TMPDIR");
    }
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

 private:
  std::optional<std::string> before_;
};

/// A number in every block, which tells the blocks apart.
void Number(ScratchMemory* memory, std::size_t blocks) {
  for (std::size_t b = 0; b < blocks; ++b) {
    memory->BeforeWriting(b);
    memory->data()[b * kBlock + 7] = static_cast<std::byte>(b % 251 + 1);
  }
}

bool IsNumbered(const ScratchMemory& memory, std::size_t b) {
  memory.BeforeReading(b);
  return memory.data()[b * kBlock + 7] == static_cast<std::byte>(b % 251 + 1);
}

TEST(ScratchMemory, KeepsALargeOnesBytesAndHoldsFewOfItsBlocks) {
  const std::size_t blocks = 3 * ScratchMemory::kMostHeld / kBlock + 3;
  ScratchMemory memory(blocks * kBlock - 5, kBlock);
  ASSERT_TRUE(memory.is_file()) << "no file in $TMPDIR or /var/tmp";
  Number(&memory, blocks);
  EXPECT_LE(ScratchMemory::held(), ScratchMemory::kMostHeld);
  for (std::size_t b = blocks; b-- > 0;) EXPECT_TRUE(IsNumbered(memory, b));
  EXPECT_LE(ScratchMemory::held(), ScratchMemory::kMostHeld);
  EXPECT_EQ(memory.data()[blocks * kBlock - 6], std::byte{0});
  const ScratchMemory moved = std::move(memory);
  EXPECT_TRUE(IsNumbered(moved, 5));
}

TEST(ScratchMemory, KeepsTheBytesOfTwoThatAreReadInTurnAndBothWays) {
  const std::size_t blocks = 2 * ScratchMemory::kMostHeld / kBlock;
  ScratchMemory one(blocks * kBlock, kBlock);
  ScratchMemory other(blocks * kBlock - 5, kBlock);
  ASSERT_TRUE(one.is_file() && other.is_file());
  Number(&one, blocks);
  Number(&other, blocks);
  for (std::size_t b = 0; b < blocks; ++b) {
    ASSERT_TRUE(IsNumbered(one, b)) << b;
    ASSERT_TRUE(IsNumbered(other, blocks - 1 - b)) << b;
    ASSERT_TRUE(IsNumbered(one, 7 * b % blocks)) << b;
    ASSERT_LE(ScratchMemory::held(), ScratchMemory::kMostHeld);
    // Written anew where it had been let go.
    other.BeforeWriting(blocks - 1 - b);
    other.data()[(blocks - 1 - b) * kBlock + 9] = std::byte{1};
  }
  for (std::size_t b = 0; b < blocks; ++b) {
    ASSERT_TRUE(IsNumbered(other, b));
    ASSERT_EQ(other.data()[b * kBlock + 9], std::byte{1});
  }
}

/// Bytes on the disk of the files without a name in a folder that are open.
std::uintmax_t BytesOfOpenFilesIn(const std::string& folder) {
  std::uintmax_t bytes = 0;
  for (const auto& one : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code gone;
    const std::filesystem::path target =
        std::filesystem::read_symlink(one.path(), gone);
    if (!target.string().starts_with(folder)) continue;
    bytes += std::filesystem::file_size(one.path(), gone);
  }
  return bytes;
}

TEST(ScratchMemory, GivesItsPlaceToTheNextWhichIsZeroAsAtFirst) {
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / "scratch_memory_again";
  std::filesystem::create_directories(folder);
  const TemporaryFolder set(folder);
  const std::size_t blocks = ScratchMemory::kSmallest / kBlock + 1;
  ScratchMemory stays(blocks * kBlock, kBlock);
  ASSERT_TRUE(stays.is_file());
  Number(&stays, blocks);
  std::uintmax_t bytes = 0;
  for (int i = 0; i < 3; ++i) {
    ScratchMemory comes(blocks * kBlock, kBlock);
    for (std::size_t b = 0; b < blocks; ++b) {
      comes.BeforeReading(b);
      ASSERT_EQ(comes.data()[b * kBlock + 7], std::byte{0}) << b;
    }
    Number(&comes, blocks);
    for (std::size_t b = 0; b < blocks; ++b) EXPECT_TRUE(IsNumbered(comes, b));
    const std::uintmax_t now = BytesOfOpenFilesIn(folder.string());
    EXPECT_EQ(i == 0 ? now : bytes, now);
    EXPECT_GT(now, 2 * ScratchMemory::kSmallest);
    bytes = now;
  }
  for (std::size_t b = 0; b < blocks; ++b) EXPECT_TRUE(IsNumbered(stays, b));
  std::filesystem::remove_all(folder);
}

TEST(ScratchMemory, KeepsWhatIsWrittenToABlockWhoseFillingHasEnded) {
  const std::size_t blocks = ScratchMemory::kSmallest / kBlock;
  ScratchMemory memory(blocks * kBlock, kBlock);
  ASSERT_TRUE(memory.is_file());
  // Backwards, and a word of a block while the one before it is filled already.
  for (std::size_t b = blocks; b-- > 0;) {
    memory.BeforeWriting(b);
    memory.data()[b * kBlock] = std::byte{1};
    if (b + 1 < blocks) memory.data()[(b + 1) * kBlock + 9] = std::byte{2};
  }
  memory.EndFilling();
  memory.EndFilling();
  for (std::size_t b = 0; b < blocks; ++b) {
    memory.BeforeWriting(b);
    memory.data()[b * kBlock + 5] = std::byte{3};
  }
  for (std::size_t b = 0; b < blocks; ++b) {
    memory.BeforeReading(b);
    const std::byte* block = memory.data() + b * kBlock;
    ASSERT_EQ(block[0], std::byte{1}) << b;
    ASSERT_EQ(block[5], std::byte{3}) << b;
    ASSERT_EQ(block[9], b == 0 ? std::byte{0} : std::byte{2}) << b;
    ASSERT_EQ(block[kBlock - 1], std::byte{0}) << b;
  }
}

TEST(ScratchMemory, LeavesNoFileBehind) {
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / "scratch_memory";
  std::filesystem::create_directories(folder);
  const TemporaryFolder set(folder);
  const ScratchMemory memory(ScratchMemory::kSmallest, kBlock);
  EXPECT_TRUE(memory.is_file());
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  std::filesystem::remove_all(folder);
}

TEST(ScratchMemory, IsPlainMemoryWhereItIsSmallOrThereIsNoFile) {
  ScratchMemory small(3 * kBlock, kBlock);
  EXPECT_FALSE(small.is_file());
  Number(&small, 3);
  for (std::size_t b = 0; b < 3; ++b) EXPECT_TRUE(IsNumbered(small, b));
  const TemporaryFolder set("/nowhere/at/all");
  ScratchMemory large(ScratchMemory::kSmallest, kBlock);
  EXPECT_FALSE(large.is_file());
  EXPECT_EQ(large.data()[ScratchMemory::kSmallest - 1], std::byte{0});
  const std::size_t blocks = ScratchMemory::kSmallest / kBlock;
  Number(&large, blocks);
  for (std::size_t b = 0; b < blocks; ++b) EXPECT_TRUE(IsNumbered(large, b));
}

TEST(ScratchMemory, IsReadByManyThreadsAtOnce) {
  const std::size_t blocks = ScratchMemory::kSmallest / kBlock;
  ScratchMemory memory(blocks * kBlock, kBlock);
  Number(&memory, blocks);
  std::vector<int> wrong(4, 0);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    threads.emplace_back([&, i] {
      for (std::size_t k = 0; k < 20 * blocks; ++k) {
        const std::size_t b = (k * (2 * i + 1) + 17 * i) % blocks;
        wrong[i] += IsNumbered(memory, b) ? 0 : 1;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

struct Entry {
  double t = 0.0;
  double value = 1.0;
};

TEST(PagedVector, IsAVectorBeyondWhatMemoryHolds) {
  const std::size_t count = ScratchMemory::kSmallest / 4 * 5 / sizeof(Entry);
  PagedVector<Entry> vector;
  for (std::size_t k = 0; k < count; ++k) {
    vector.push_back({static_cast<double>(k), 0.5});
  }
  ASSERT_EQ(vector.size(), count);
  EXPECT_EQ(vector.back().t, static_cast<double>(count - 1));
  const PagedVector<Entry> copy = vector;
  const auto found =
      std::lower_bound(copy.begin(), copy.end(), 1e6 - 0.5,
                       [](const Entry& e, double t) { return e.t < t; });
  EXPECT_EQ(found - copy.begin(), 1000000);
  EXPECT_EQ(found->t, 1e6);
  for (Entry& entry : vector) entry.t *= 2.0;
  const std::size_t half = count / 2;
  EXPECT_EQ(vector[half].t, 2.0 * static_cast<double>(half));
  EXPECT_EQ(copy[half].t, static_cast<double>(half));
  EraseIf([](const Entry& e) { return std::fmod(e.t, 4.0) != 0.0; }, &vector);
  ASSERT_EQ(vector.size(), half);
  const std::size_t third = count / 3;
  EXPECT_EQ(vector[third].t, 4.0 * static_cast<double>(third));
}

TEST(PagedVector, DoesWhatAStdVectorDoes) {
  PagedVector<Entry> vector = {{1.0, 2.0}, {3.0, 4.0}};
  EXPECT_FALSE(vector.empty());
  for (int i = 0; i < 100; ++i) vector.push_back(vector.front());
  EXPECT_EQ(vector.size(), 102u);
  EXPECT_EQ(vector.back().value, 2.0);
  vector.pop_back();
  vector.resize(200, {7.0, 8.0});
  EXPECT_EQ(vector[101].t, 7.0);
  EXPECT_EQ(vector.end() - vector.begin(), 200);
  vector.erase(vector.begin() + 1, vector.begin() + 101);
  EXPECT_EQ(vector.size(), 100u);
  EXPECT_EQ(vector[1].t, 7.0);
  PagedVector<Entry> part;
  part.assign(vector.begin() + 2, vector.end());
  EXPECT_EQ(part.size(), 98u);
  vector = std::move(part);
  EXPECT_EQ(vector.size(), 98u);
  vector.clear();
  EXPECT_TRUE(vector.empty());
}

TEST(PagedRows, AreZeroAtFirstAndTheirOwnAfterwards) {
  constexpr std::size_t kWidth = 123;
  const std::size_t count =
      2 * ScratchMemory::kSmallest / (kWidth * sizeof(double));
  PagedRows rows(count, kWidth);
  for (std::size_t k = 0; k < count; k += 2) {
    std::fill_n(rows.Row(k), kWidth, static_cast<double>(k));
  }
  const PagedRows copy = rows;
  rows.Row(4)[1] = -1.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double expected = k % 2 == 0 ? static_cast<double>(k) : 0.0;
    ASSERT_EQ(copy.Row(k)[0], expected) << k;
    ASSERT_EQ(copy.Row(k)[kWidth - 1], expected) << k;
  }
}

}  // namespace
}  // namespace hindsight
