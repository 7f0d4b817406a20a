#include "io/write/csv_line.h"

namespace hindsight {

std::string CsvLine(const std::vector<std::string>& fields) {
  std::string text;
  for (const std::string& field : fields) {
    if (&field != &fields.front()) text += ',';
    if (field.find_first_of(",\"\n#") == field.npos) {
      text += field;
      continue;
    }
    text += '"';
    for (const char letter : field) {
      if (letter == '"') text += '"';
      text += letter;
    }
    text += '"';
  }
  return text + '\n';
}

}  // namespace hindsight
