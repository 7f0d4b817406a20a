#include "io/write/result_manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/write/unpublished.h"
#include "support/temporary_folder.h"

namespace hindsight {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

TEST(ResultManifest, ListsWhatMayBeRemoved) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.Path("out");
  std::filesystem::create_directory(path);
  EXPECT_FALSE(ReadManifest(path));
  folder.Write("out/a.csv", "1");
  EXPECT_EQ(FindForeign(path),
            "a.csv, which is not listed in its manifest.json");
  WriteManifest({.complete = true, .files = {"a.csv"}}, path);
  EXPECT_EQ(FindForeign(path), "");
  EXPECT_TRUE(ReadManifest(path)->complete);
  folder.Write("out/b.csv", "2");
  EXPECT_EQ(FindForeign(path),
            "b.csv, which is not listed in its manifest.json");
  EXPECT_FALSE(RemoveListed(path));
  EXPECT_TRUE(std::filesystem::exists(path / "b.csv"));
  EXPECT_FALSE(std::filesystem::exists(path / "a.csv"));
  std::filesystem::remove(path / "b.csv");
  EXPECT_TRUE(RemoveListed(path));
  EXPECT_THAT(folder.Entries(), IsEmpty());
}

TEST(ResultManifest, OfOthersOrLeadingElsewhereIsNone) {
  const TemporaryFolder folder;
  for (const char* text :
       {"{}", "[1]", "{\"complete\": true, \"files\": []}", "",
        R"({"program": "other", "complete": true, "files": []})",
        R"({"program": "hindsight", "complete": true, "files": ["../a"]})",
        R"({"program": "hindsight", "complete": true, "files": ["/a"]})",
        R"({"program": "hindsight", "complete": true, "files": [".."]})",
        R"({"program": "hindsight", "complete": 1, "files": []})"}) {
    folder.Write(kManifestName, text);
    EXPECT_FALSE(ReadManifest(folder.Path(""))) << text;
  }
}

TEST(Unpublished, AbandonedIsWhatNobodyHolds) {
  const TemporaryFolder folder;
  const std::filesystem::path target = folder.Path("out");
  std::error_code error;
  Unpublished held = CreateUnpublishedFolder(target, &error);
  ASSERT_FALSE(error) << error.message();
  std::filesystem::path left;
  {
    const Unpublished closed = CreateUnpublishedFile(target, &error);
    ASSERT_FALSE(error) << error.message();
    left = closed.path;
    EXPECT_THAT(FindAbandoned(target), IsEmpty());
  }
  // The names of others that look alike, and of other targets.
  folder.Write(".out.partial-mine", "");
  folder.Write(".out.partial-0123456789ABCDEF", "");
  folder.Write(".out2.partial-0123456789ab", "");
  EXPECT_THAT(FindAbandoned(target), ElementsAre(left));
  const std::filesystem::path was_held = held.path;
  held = Unpublished();
  EXPECT_THAT(FindAbandoned(target), UnorderedElementsAre(left, was_held));
}

TEST(Unpublished, ATakenNameIsNotReplaced) {
  const TemporaryFolder folder;
  folder.Write("a", "mine");
  folder.Write("b", "new");
  EXPECT_EQ(RenameToFree(folder.Path("b"), folder.Path("a")),
            std::errc::file_exists);
  EXPECT_EQ(folder.Read("a"), "mine");
  EXPECT_FALSE(RenameToFree(folder.Path("b"), folder.Path("c")));
  EXPECT_EQ(folder.Read("c"), "new");
}

}  // namespace
}  // namespace hindsight
