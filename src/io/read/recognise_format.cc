#include "io/read/recognise_format.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "io/read/column_meaning.h"
#include "io/read/file_formats.h"
#include "io/read/paths.h"
#include "io/read/text_lines.h"
#include "io/read/text_tokens.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

/// Lines enough to tell formats and rates apart.
constexpr int kProbeLines = 60;

/// Empty if it cannot be read.
TextProbe ReadProbe(const std::string& path) {
  TextProbe probe{path, {}, {}};
  try {
    TextLines lines(path);
    std::string_view line;
    while (static_cast<int>(probe.lines.size()) < kProbeLines &&
           lines.Next(&line)) {
      (IsComment(line) ? probe.comments : probe.lines).emplace_back(line);
    }
  } catch (const InputError&) {
    return {};
  }
  return probe;
}

/// By the first format whose `member` recognises it.
template <typename Member, typename Argument>
std::optional<FoundStream> FirstOf(Member member, const Argument& argument) {
  for (const FileFormat* format : FileFormats()) {
    if (format->*member == nullptr) continue;
    if (auto found = (format->*member)(argument)) {
      found->format = format;
      return found;
    }
  }
  return std::nullopt;
}

std::optional<FileColumns> ProbeColumns(const std::string& path) {
  for (const FileFormat* format : FileFormats()) {
    if (format->read_columns == nullptr) continue;
    if (auto columns = format->read_columns(path)) return columns;
  }
  return std::nullopt;
}

/// Whether titles say what stands in at least two columns.
bool IsTitled(const FileColumns& file) {
  constexpr std::ptrdiff_t kEnough = 2;
  return std::count_if(file.columns.begin(), file.columns.end(),
                       [](const FileColumn& column) {
                         return !column.title.empty() &&
                                !MeaningOfTitle(column.title).quantity.empty();
                       }) >= kEnough;
}

/// The streams of a text that holds those of several sensors row by row.
std::vector<FoundStream> RecogniseTyped(const std::string& path,
                                        const RecogniseHints& hints) {
  std::vector<FoundStream> found;
  for (const FileColumns& table : ReadTypedColumns(path)) {
    for (FoundStream& stream :
         RecogniseColumns(table, table.row_word.Name(), hints)) {
      found.push_back(std::move(stream));
    }
  }
  return found;
}

}  // namespace

std::vector<FoundStream> RecogniseFormat(const std::string& path,
                                         const RecogniseHints& hints) {
  if (auto found = FirstOf(&FileFormat::recognise_name, fs::path(path))) {
    return {*found};
  }
  if (IsFolder(path)) return {};
  const TextProbe probe = ReadProbe(path);
  if (!probe.lines.empty()) {
    if (auto found = FirstOf(&FileFormat::recognise_text, probe)) {
      return {*found};
    }
  }
  try {
    if (!probe.lines.empty()) {
      auto streams = RecogniseTyped(path, hints);
      if (!streams.empty()) return streams;
    }
    const auto columns = ProbeColumns(path);
    std::vector<FoundStream> found;
    if (columns) {
      const std::string name = fs::path(path).filename().string();
      found = RecogniseColumns(*columns, name, hints);
    }
    // Increments have no gravity to be known by, fixes of a fixed order no
    // titles.
    const bool imu = std::any_of(found.begin(), found.end(),
                                 [](const FoundStream& f) { return f.imu; });
    const bool bare = !columns || (columns->format == &ColumnsFormat() &&
                                   !IsTitled(*columns));
    if (!imu && bare && !probe.lines.empty()) {
      if (auto ordered = FirstOf(&FileFormat::recognise_bare, probe)) {
        return {*ordered};
      }
    }
    return found;
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace hindsight
