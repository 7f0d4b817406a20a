#include "io/config/unused_rows.h"

#include <filesystem>
#include <map>
#include <set>

#include "io/read/file_columns.h"

namespace hindsight {
namespace {

/// What stands between the first quotation mark behind `from` and the last.
std::string Quoted(const std::string& text, std::size_t from) {
  const std::size_t begin = text.find('"', from) + 1;
  return text.substr(begin, text.rfind('"') - begin);
}

using WordsOfFiles = std::map<std::string, std::set<std::string>>;

/// Those of the accelerometers' own file stand below it.
void AddWords(const FoundStream& found, WordsOfFiles* used) {
  std::string file = found.file;
  for (const KeyLine& line : found.lines) {
    if (line.key == "  file") file = Quoted(line.value, 0);
    if (line.key == "rows" || line.key == "  rows") {
      (*used)[file].insert(Quoted(line.value, line.value.find("word:")));
    }
  }
}

}  // namespace

std::vector<std::string> UnusedRows(const RecordingDraft& draft) {
  WordsOfFiles used;
  if (draft.imu) AddWords(*draft.imu, &used);
  for (const auto* streams : {&draft.aiding, &draft.unused}) {
    for (const StreamDraft& stream : *streams) AddWords(stream.found, &used);
  }
  if (draft.truth) AddWords(*draft.truth, &used);
  std::vector<std::string> unused;
  for (const auto& [file, words] : used) {
    const std::filesystem::path path =
        std::filesystem::path(draft.folder) / file;
    std::string left;
    for (const FileColumns& table : ReadTypedColumns(path.string())) {
      const std::string& word = table.row_word.word;
      if (!words.contains(word)) left += (left.empty() ? "" : ", ") + word;
    }
    if (!left.empty()) unused.push_back(file + ", rows of " + left);
  }
  return unused;
}

}  // namespace hindsight
