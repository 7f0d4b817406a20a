#include "io/read/joined_columns.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace hindsight {
namespace {

bool IsTitled(const FileColumns& file) {
  return std::any_of(file.columns.begin(), file.columns.end(),
                     [](const FileColumn& c) { return !c.title.empty(); });
}

/// But for what stands above the numbers.
bool HasSameNumbers(const FileColumns& a, const FileColumns& b) {
  return a.format == b.format && a.delimiter == b.delimiter &&
         std::equal(a.columns.begin(), a.columns.end(), b.columns.begin(),
                    b.columns.end(),
                    [](const FileColumn& one, const FileColumn& other) {
                      return one.reference == other.reference &&
                             one.holds == other.holds;
                    });
}

bool HasSameColumns(const FileColumns& a, const FileColumns& b) {
  return a.skip_lines == b.skip_lines && HasSameNumbers(a, b) &&
         std::equal(a.columns.begin(), a.columns.end(), b.columns.begin(),
                    [](const FileColumn& one, const FileColumn& other) {
                      return one.title == other.title;
                    });
}

}  // namespace

bool LacksTitles(const FileColumns& part, const FileColumns& titled) {
  return HasSameNumbers(part, titled) && part.skip_lines == 0 &&
         titled.skip_lines == 1 && IsTitled(titled) && !IsTitled(part);
}

std::optional<FileColumns> ReadJoined(const std::vector<std::string>& paths) {
  std::optional<FileColumns> joined;
  bool untitled = false;
  for (const std::string& path : paths) {
    auto part = ReadTextColumns(path);
    if (!part) return std::nullopt;
    if (!joined) {
      joined = std::move(part);
      continue;
    }
    if (LacksTitles(*part, *joined)) {
      // Skipped in each file, a line of numbers would go here.
      joined->skip_lines = 0;
      joined->text_rows += 1;
      untitled = true;
    } else if (!(untitled ? HasSameNumbers(*joined, *part)
                          : HasSameColumns(*joined, *part))) {
      return std::nullopt;
    }
    joined->cut_tail = joined->cut_tail || part->cut_tail;
    joined->text_rows += part->text_rows;
    for (const std::string& remark : part->remarks) {
      const std::string name = std::filesystem::path(path).filename().string();
      joined->remarks.push_back(name + ": " + remark);
    }
    joined->complete =
        joined->complete && part->complete &&
        joined->rows * joined->columns.size() < kMostProbedNumbers;
    if (!joined->complete) continue;
    for (std::size_t i = 0; i < part->columns.size(); ++i) {
      std::vector<double>& values = joined->columns[i].values;
      values.insert(values.end(), part->columns[i].values.begin(),
                    part->columns[i].values.end());
    }
    joined->rows += part->rows;
  }
  return joined;
}

}  // namespace hindsight
