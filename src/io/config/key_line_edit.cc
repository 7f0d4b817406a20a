#include "io/config/key_line_edit.h"

namespace hindsight {

void AddToMap(const std::string& key, const std::string& entry,
              const std::string& comment, std::vector<KeyLine>* lines) {
  const KeyLine* line = FindLine(*lines, key);
  std::string value = "{" + entry + "}";
  std::string why = comment;
  if (line != nullptr) {
    value = line->value.substr(0, line->value.size() - 1) + ", " + entry + "}";
    why = line->comment + (line->comment.empty() ? "" : "; ") + comment;
  }
  SetLine({key, value, why}, lines);
}

void DropClockSigma(std::vector<KeyLine>* lines) {
  const KeyLine* line = FindLine(*lines, "estimate");
  if (line == nullptr) return;
  std::string value = line->value;
  const std::size_t at = value.find("time_offset");
  if (at == value.npos) return;
  std::size_t end = value.find_first_of(",}", at);
  std::size_t begin = at;
  if (value[end] == ',') {
    end = value.find_first_not_of(' ', end + 1);
  } else {
    begin = value.rfind(',', at);
  }
  if (begin == value.npos) {
    std::erase_if(*lines, [](const KeyLine& l) { return l.key == "estimate"; });
    return;
  }
  value.erase(begin, end - begin);
  SetLine({"estimate", value, line->comment}, lines);
}

}  // namespace hindsight
