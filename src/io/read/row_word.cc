#include "io/read/row_word.h"

#include <fmt/core.h>

#include "io/read/text_tokens.h"

namespace hindsight {

std::string_view WordAt(std::string_view line, char delimiter, int column) {
  TextTokens tokens(line, delimiter, false);
  for (int i = 0; i < column && !tokens.AtEnd(); ++i) tokens.Next();
  return tokens.AtEnd() ? std::string_view() : tokens.Next();
}

std::string RowWord::Name() const {
  return device_column < 0 ? word : word + " " + device;
}

std::string RowWord::Yaml() const {
  std::string text =
      fmt::format("{{column: {}, word: \"{}\"", column + 1, word);
  if (device_column >= 0) {
    text += fmt::format(", device_column: {}, device: \"{}\"",
                        device_column + 1, device);
  }
  return text + "}";
}

bool RowWord::IsIn(std::string_view line, char delimiter) const {
  if (column < 0) return true;
  if (delimiter == '\0') delimiter = GuessDelimiter(line);
  return WordAt(line, delimiter, column) == word &&
         (device_column < 0 ||
          WordAt(line, delimiter, device_column) == device);
}

}  // namespace hindsight
