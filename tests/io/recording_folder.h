#ifndef HINDSIGHT_TESTS_IO_RECORDING_FOLDER_H_
#define HINDSIGHT_TESTS_IO_RECORDING_FOLDER_H_

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "io/config/config.h"

namespace hindsight {

/// The words of which an error says that it expects one.
inline std::vector<std::string> Expected(const std::string& error) {
  const std::string head = "expected one of ";
  const std::size_t at = error.find(head);
  EXPECT_NE(at, std::string::npos) << error;
  std::vector<std::string> words;
  if (at == std::string::npos) return words;
  std::istringstream list(error.substr(at + head.size()));
  for (std::string word; list >> word;) {
    if (word.ends_with(',')) word.pop_back();
    words.push_back(word);
  }
  return words;
}

/// A folder of its own for each test, removed at the end.
class RecordingFolder : public ::testing::Test {
 protected:
  RecordingFolder() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("hindsight_") + info->name() + "_" +
               std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~RecordingFolder() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const {
    return (folder_ / name).string();
  }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(Path(name), std::ios::binary) << text;
  }
  void WriteGzip(const std::string& name, const std::string& text) const {
    gzFile file = gzopen(Path(name).c_str(), "wb");
    gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
    gzclose(file);
  }
  std::string Read(const std::string& name) const {
    std::ifstream in(Path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  /// What InputError says about the configuration "config.yaml", without the
  /// folder's path; "" if it loads.
  std::string LoadError() const {
    try {
      LoadDataset(Path("config.yaml"));
      return "";
    } catch (const InputError& error) {
      std::string text = error.what();
      const std::string prefix = folder_.string() + "/";
      for (std::size_t at; (at = text.find(prefix)) != std::string::npos;) {
        text.erase(at, prefix.size());
      }
      return text;
    }
  }
  Dataset Load(ResolvedConfig* resolved = nullptr) const {
    return LoadDataset(Path("config.yaml"), {}, resolved);
  }

  std::filesystem::path folder_;
};

inline std::string ReplacedOnce(std::string text, const std::string& from,
                                const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_IO_RECORDING_FOLDER_H_
