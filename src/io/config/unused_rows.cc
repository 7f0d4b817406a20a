#include "io/config/unused_rows.h"

#include <filesystem>
#include <map>
#include <set>

#include "io/read/file_columns.h"

namespace hindsight {
namespace {

/// Without its quotation marks.
std::string Unquoted(const std::string& text) {
  return text.substr(1, text.rfind('"') - 1);
}

/// RowWord::Yaml().
using WordsOfFiles = std::map<std::string, std::set<std::string>>;

/// Those of the accelerometers' own file stand below it.
void AddWords(const FoundStream& found, WordsOfFiles* used) {
  std::string file = found.file;
  for (const KeyLine& line : found.lines) {
    if (line.key == "  file") file = Unquoted(line.value);
    if (line.key == "rows" || line.key == "  rows") {
      (*used)[file].insert(line.value);
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
      if (words.contains(table.row_word.Yaml())) continue;
      left += (left.empty() ? "" : ", ") + table.row_word.Name();
    }
    if (!left.empty()) unused.push_back(file + ", rows of " + left);
  }
  return unused;
}

}  // namespace hindsight
