#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "base/error.h"
#include "io/read/file_columns.h"
#include "io/read/file_formats.h"
#include "io/read/input_file.h"
#include "io/read/mat_file.h"
#include "io/read/paths.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostColumns = 40;

void AddArray(const std::string& name, const NumericArray& array,
              FileColumns* found) {
  for (std::size_t j = 0; j < array.columns; ++j) {
    FileColumn column;
    column.reference =
        array.columns == 1 ? name : name + ":" + std::to_string(j + 1);
    column.title = name;
    column.values.resize(array.rows);
    for (std::size_t i = 0; i < array.rows; ++i) {
      column.values[i] = array.at(i, j);
    }
    found->columns.push_back(std::move(column));
  }
}

using NamedArray = std::pair<std::string, NumericArray>;

/// Those with as many rows as the most.
void Gather(const std::vector<NamedArray>& arrays, FileColumns* found) {
  for (const auto& [name, array] : arrays) {
    found->rows = std::max(found->rows, array.rows);
  }
  for (const auto& [name, array] : arrays) {
    if (array.rows == found->rows && array.columns <= kMostColumns) {
      AddArray(name, array, found);
    } else if (array.rows == 1 && array.columns == 1) {
      found->scalars[name] = array.at(0, 0);
    } else {
      found->remarks.push_back("the array " + name +
                               " has another number of rows and is not used");
    }
  }
}

bool IsNpy(const fs::path& path) {
  constexpr std::string_view kMagic = "\x93NUMPY";
  try {
    std::array<char, kMagic.size()> start = {};
    const InputFile file(path.string());
    return file.ReadAt(0, start.data(), start.size()) == start.size() &&
           std::string_view(start.data(), start.size()) == kMagic;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

std::optional<FileColumns> ReadNpyColumns(const std::string& folder) {
  std::vector<NamedArray> arrays;
  const std::string place = fs::path(folder).filename().string();
  for (const fs::path& entry : FolderEntries(folder)) {
    if (!IsFile(entry) || !IsNpy(entry)) continue;
    try {
      arrays.emplace_back(place + "/" + entry.filename().string(),
                          ReadNpy(entry.string()));
    } catch (const InputError&) {
      continue;
    }
  }
  if (arrays.empty()) return std::nullopt;
  FileColumns found;
  found.format = &NpyFormat();
  Gather(arrays, &found);
  return found;
}

FileColumns ReadMatColumns(const std::string& path) {
  std::vector<NamedArray> arrays;
  VisitMat(path, [&](const MatVariable& variable,
                     const std::function<NumericArray()>& values) {
    if (!variable.unfit.empty() || variable.shape.size() != 2) return;
    if (variable.shape[0] * variable.shape[1] > kMostProbedNumbers) return;
    arrays.emplace_back(variable.name, values());
  });
  FileColumns found;
  found.format = &MatFormat();
  Gather(arrays, &found);
  return found;
}

}  // namespace hindsight
