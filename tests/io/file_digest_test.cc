#include "io/read/file_digest.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "support/temporary_folder.h"

namespace hindsight {
namespace {

// The examples of FIPS 180-4.
constexpr const char* kOfAbc =
    "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
constexpr const char* kOfMillionA =
    "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0";

TEST(FileDigest, IsTheSha256OfTheBytes) {
  const TemporaryFolder folder;
  const FileDigest digest = DigestOf(folder.Write("a", "abc"));
  EXPECT_EQ(digest.sha256, kOfAbc);
  EXPECT_EQ(digest.bytes, 3u);
  EXPECT_EQ(digest.files, 1);
  EXPECT_EQ(DigestOf(folder.Write("b", std::string(1000000, 'a'))).sha256,
            kOfMillionA);
}

TEST(FileDigest, OfAFolderIsThatOfItsListOfFiles) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.Path("in"));
  std::filesystem::create_directory(folder.Path("in/data"));
  folder.Write("in/b", "abc");
  folder.Write("in/data/a", "abc");
  std::filesystem::create_directory_symlink(folder.Path("in"),
                                            folder.Path("in/loop"));
  const FileDigest digest = DigestOf(folder.Path("in"));
  EXPECT_EQ(digest.files, 2);
  EXPECT_EQ(digest.bytes, 6u);
  const std::string list =
      std::string(kOfAbc) + "  b\n" + kOfAbc + "  data/a\n";
  EXPECT_EQ(digest.sha256, DigestOf(folder.Write("list", list)).sha256);
}

TEST(FileDigest, AFileThatIsNotThereIsAnInputError) {
  EXPECT_THROW(DigestOf("/nowhere/at/all"), InputError);
}

}  // namespace
}  // namespace hindsight
