#include "io/config/unused_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "base/error.h"
#include "io/read/column_meaning.h"
#include "io/read/column_steps.h"
#include "io/read/file_columns.h"
#include "io/read/file_formats.h"

namespace hindsight {
namespace {

/// References of the columns in use, by file.
using UsedColumns = std::map<std::string, std::set<std::string>>;

/// Of `"-14 [m/s^2]"` or `{column: "5", unit: ...}`; "" of what names none.
std::string ReferenceIn(const std::string& value) {
  constexpr std::string_view kMap = "{column: ";
  std::string_view rest = value;
  if (rest.starts_with(kMap)) rest.remove_prefix(kMap.size());
  const std::size_t begin = rest.find_first_not_of("\"-");
  if (begin == rest.npos) return "";
  rest.remove_prefix(begin);
  return std::string(rest.substr(0, rest.find_first_of(" \"[,}")));
}

/// Those of the accelerometers' own file stand below it.
void AddColumns(const FoundStream& found, UsedColumns* used) {
  if (found.format != &ColumnsFormat() ||
      FindLine(found.lines, "rows") != nullptr) {
    return;
  }
  std::string file = found.file;
  for (const KeyLine& line : found.lines) {
    if (line.key == "  file") {
      file = line.value.substr(1, line.value.rfind('"') - 1);
    } else if (line.key.starts_with("  ")) {
      (*used)[file].insert(ReferenceIn(line.value));
    }
  }
}

bool IsNoMeasurement(const std::string& title) {
  constexpr std::array<std::string_view, 5> kNone = {"t", "week", "index",
                                                     "quality", "moving"};
  const std::string quantity = MeaningOfTitle(title).quantity;
  return std::find(kNone.begin(), kNone.end(), quantity) != kNone.end() ||
         quantity.starts_with("sigma") || quantity.starts_with("accuracy");
}

bool LooksMeasured(const FileColumn& column) {
  if (column.holds != FileColumn::Holds::kNumbers ||
      IsNoMeasurement(column.title)) {
    return false;
  }
  constexpr std::size_t kStates = 2;
  std::set<double> values;
  for (const double value : column.values) {
    if (std::isfinite(value) && values.size() <= kStates) values.insert(value);
  }
  if (values.size() <= kStates) return false;
  constexpr double kEven = 0.5;
  const Steps steps = StepsOf(column.values);
  return !Grows(column.values, steps) || steps.unevenness > kEven;
}

std::optional<FileColumns> FirstColumnsOf(const RecordingDraft& draft,
                                          const std::string& file) {
  constexpr long kMostLines = 200'000;
  try {
    return ReadTextBeginning(
        (std::filesystem::path(draft.folder) / file).string(), kMostLines);
  } catch (const InputError&) {
    return std::nullopt;  // which whoever loads it is told
  }
}

}  // namespace

std::vector<std::string> UnusedColumns(const RecordingDraft& draft) {
  UsedColumns used;
  if (draft.imu) AddColumns(*draft.imu, &used);
  for (const auto* streams : {&draft.aiding, &draft.unused}) {
    for (const StreamDraft& stream : *streams) AddColumns(stream.found, &used);
  }
  if (draft.truth) AddColumns(*draft.truth, &used);
  constexpr std::size_t kMostNames = 12;
  std::vector<std::string> unused;
  for (const auto& [file, references] : used) {
    const auto table = FirstColumnsOf(draft, file);
    if (!table) continue;
    std::size_t count = 0;
    std::string names;
    for (const FileColumn& column : table->columns) {
      if (references.contains(column.reference) || !LooksMeasured(column)) {
        continue;
      }
      if (++count > kMostNames) continue;
      names += (count == 1 ? "" : ", ") +
               (column.title.empty() ? column.reference : column.title);
    }
    if (count == 0) continue;
    if (count > kMostNames) {
      names += " and " + std::to_string(count - kMostNames) + " more";
    }
    unused.push_back(file + (count == 1 ? ", column " : ", columns ") + names);
  }
  return unused;
}

}  // namespace hindsight
