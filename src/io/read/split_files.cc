#include "io/read/split_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <utility>

#include "base/error.h"
#include "io/read/file_formats.h"
#include "io/read/joined_columns.h"
#include "io/read/paths.h"
#include "io/read/text_format.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

/// The name without numbers, what separates them, and `.gz`.
std::string NamePattern(std::string name) {
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  std::string pattern;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (std::isdigit(static_cast<unsigned char>(name[i])) == 0) {
      pattern += name[i];
      continue;
    }
    while (!pattern.empty() &&
           std::string(" _.-(").find(pattern.back()) != std::string::npos) {
      pattern.pop_back();
    }
    if (i + 1 < name.size() && name[i + 1] == ')') ++i;
  }
  return pattern;
}

/// By reading a file of a format that needs no columns.
std::optional<StampSpan> ReadSpan(const std::string& path,
                                  const FoundStream& found) {
  if (found.format->takes_columns || found.format->whole_recordings) {
    return std::nullopt;
  }
  TextFormat format;
  format.kind = found.format;
  try {
    const OpenedTable opened = OpenTable(path, format, FieldsOf(found),
                                         {.allow_truncated_tail = true,
                                          .allow_absent = true,
                                          .drop_text = true});
    std::optional<Stamp> first;
    StampSpan span;
    long rows = 0;
    for (; opened.table->Next(); ++rows) {
      const Stamp& stamp = opened.table->stamp();
      if (!first) first = stamp;
      const double t = stamp.Since(*first);
      if (rows > 0) span.gap = std::max(span.gap, t - span.last);
      span.last = t;
    }
    if (rows < 2) return std::nullopt;
    span.step = span.last / static_cast<double>(rows - 1);
    span.first = first->Since({});
    span.last += span.first;
    return span;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Whether they may be parts of one stream, but for their times.
bool IsAlike(const FoundStream& a, const FoundStream& b) {
  const auto column = [](const FoundStream& found) {
    return found.stamps ? std::pair(found.stamps->column, found.stamps->unit)
                        : std::pair(-1, std::string());
  };
  return a.format == b.format && a.imu == b.imu && a.truth == b.truth &&
         a.kinds == b.kinds && column(a) == column(b);
}

struct Part {
  RecognisedFile* file = nullptr;
  StampSpan span;
};

class Joiner {
 public:
  explicit Joiner(fs::path folder) : folder_(std::move(folder)) {}

  /// Of files whose names differ by numbers: empties those that are joined to
  /// the first.
  void Join(const std::vector<RecognisedFile*>& files) const {
    std::vector<Part> parts;
    for (RecognisedFile* file : files) {
      if (file->streams.empty()) continue;
      const FoundStream& found = file->streams.front();
      const auto span = SpanOf(folder_ / file->name, found);
      if (!span) continue;
      if (!parts.empty() &&
          (parts.front().file->streams.size() != file->streams.size() ||
           !IsAlike(parts.front().file->streams.front(), found))) {
        return;
      }
      parts.push_back({file, *span});
    }
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& a, const Part& b) {
                       return a.span.first < b.span.first;
                     });
    for (std::size_t begin = 0; begin < parts.size();) {
      std::size_t end = begin + 1;
      while (end < parts.size() && GoesOn(parts[end - 1], parts[end])) ++end;
      if (end - begin > 1) {
        JoinParts({parts.begin() + static_cast<std::ptrdiff_t>(begin),
                   parts.begin() + static_cast<std::ptrdiff_t>(end)});
      }
      begin = end;
    }
  }

 private:
  static bool GoesOn(const Part& a, const Part& b) {
    constexpr double kUsualGap = 0.5;  // s
    constexpr double kRows = 5.0;
    const double gap = b.span.first - a.span.last;
    return gap > 0.0 && gap <= std::max({kUsualGap, kRows * a.span.step,
                                         a.span.gap, b.span.gap});
  }

  void JoinParts(const std::vector<Part>& parts) const {
    std::vector<std::string> paths;
    for (const Part& part : parts) {
      paths.push_back((folder_ / part.file->name).string());
    }
    std::vector<FoundStream> streams = RecogniseParts(paths, {});
    if (streams.empty()) return;
    double gap = 0.0;
    for (std::size_t i = 1; i < parts.size(); ++i) {
      gap = std::max(gap, parts[i].span.first - parts[i - 1].span.last);
    }
    for (FoundStream& stream : streams) {
      for (std::size_t i = 1; i < parts.size(); ++i) {
        stream.more_files.push_back(parts[i].file->name);
      }
      stream.joined_by = fmt::format(
          "parts of one stream: the same columns, names that differ by a "
          "number, and stamps that go on within {:.3g} s",
          gap);
    }
    for (const Part& part : parts) part.file->streams.clear();
    parts.front().file->streams = std::move(streams);
    for (std::size_t i = 1; i < parts.size(); ++i) parts[i].file->name.clear();
  }

  const fs::path folder_;
};

/// Files as delimited text, of those that are.
std::vector<std::pair<RecognisedFile*, FileColumns>> Tables(
    const fs::path& folder, const std::vector<RecognisedFile*>& files) {
  std::vector<std::pair<RecognisedFile*, FileColumns>> tables;
  for (RecognisedFile* file : files) {
    const fs::path path = folder / file->name;
    if (!IsFile(path)) continue;
    try {
      auto table = ReadTextColumns(path.string());
      if (table) tables.emplace_back(file, std::move(*table));
    } catch (const InputError&) {
      continue;  // which is none of numbers
    }
  }
  return tables;
}

bool IsOfColumns(const RecognisedFile& file) {
  return !file.streams.empty() &&
         file.streams.front().format == &ColumnsFormat();
}

/// Has files without titles be what those of a file of the same columns say, or
/// nothing if its format needs titles; returns these files.
std::vector<RecognisedFile*> BorrowTitles(
    const fs::path& folder, const std::vector<RecognisedFile*>& files) {
  auto tables = Tables(folder, files);
  std::vector<RecognisedFile*> borrowed;
  for (auto& [file, table] : tables) {
    if (!file->streams.empty() && !IsOfColumns(*file)) continue;
    const auto titled = std::find_if(tables.begin(), tables.end(),
                                     [&table = table](const auto& other) {
                                       return LacksTitles(table, other.second);
                                     });
    if (titled == tables.end()) continue;
    file->streams.clear();
    borrowed.push_back(file);
    if (!IsOfColumns(*titled->first)) continue;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      table.columns[i].title = titled->second.columns[i].title;
    }
    file->streams = RecogniseColumns(table, titled->first->name, {});
  }
  return borrowed;
}

}  // namespace

std::optional<StampSpan> SpanOf(const fs::path& path,
                                const FoundStream& found) {
  if (!found.stamps) return ReadSpan(path.string(), found);
  const StampGuess& stamps = *found.stamps;
  if (stamps.column < 0 || stamps.rate) return std::nullopt;
  return StampSpan{stamps.first, stamps.first + stamps.span, stamps.step,
                   stamps.gap};
}

void JoinSplitFiles(const fs::path& folder,
                    std::vector<RecognisedFile>* files) {
  std::map<std::string, std::vector<RecognisedFile*>> alike;
  for (RecognisedFile& file : *files) {
    alike[NamePattern(file.name)].push_back(&file);
  }
  const Joiner joiner(folder);
  for (const auto& [pattern, group] : alike) {
    if (group.size() < 2) continue;
    const std::vector<RecognisedFile*> untitled = BorrowTitles(folder, group);
    joiner.Join(group);
    // By themselves their numbers could be anything.
    for (RecognisedFile* file : untitled) {
      if (!file->name.empty()) file->streams.clear();
    }
  }
  std::erase_if(*files,
                [](const RecognisedFile& file) { return file.name.empty(); });
}

std::vector<FoundStream> RecogniseParts(const std::vector<std::string>& paths,
                                        const RecogniseHints& hints) {
  std::vector<FoundStream> first = RecogniseFormat(paths.front(), hints);
  if (paths.size() == 1 || first.empty() ||
      first.front().format != &ColumnsFormat()) {
    return first;
  }
  try {
    const auto joined = ReadJoined(paths);
    if (!joined) return {};
    return RecogniseColumns(*joined,
                            fs::path(paths.front()).filename().string(), hints);
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace hindsight
