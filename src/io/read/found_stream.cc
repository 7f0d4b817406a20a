#include "io/read/found_stream.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "io/read/fields.h"
#include "io/read/title_words.h"

namespace hindsight {

void SetLine(KeyLine line, std::vector<KeyLine>* lines) {
  const auto at =
      std::find_if(lines->begin(), lines->end(),
                   [&](const KeyLine& known) { return known.key == line.key; });
  if (at != lines->end()) {
    *at = std::move(line);
  } else {
    lines->push_back(std::move(line));
  }
}

const KeyLine* FindLine(const std::vector<KeyLine>& lines,
                        const std::string& key) {
  const auto at =
      std::find_if(lines.begin(), lines.end(),
                   [&](const KeyLine& line) { return line.key == key; });
  return at == lines.end() ? nullptr : &*at;
}

const std::vector<FieldName>& FieldsOf(const FoundStream& found) {
  if (found.imu) return ImuFields();
  return found.kinds.empty() ? TruthFields() : found.kinds.front()->columns;
}

FoundStream FoundImu() {
  FoundStream found;
  found.imu = true;
  return found;
}

FoundStream FoundTruth() {
  FoundStream found;
  found.truth = true;
  return found;
}

FoundStream FoundAiding(std::vector<const SensorKind*> kinds) {
  FoundStream found;
  found.kinds = std::move(kinds);
  return found;
}

bool IsNamedTruth(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  const std::vector<std::string> words = SplitWords(name);
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return word == "truth" || word == "groundtruth" || word == "reference" ||
           word == "gt" || word == "ref";
  });
}

}  // namespace hindsight
