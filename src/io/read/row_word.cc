#include "io/read/row_word.h"

#include "io/read/text_tokens.h"

namespace hindsight {

std::string_view WordAt(std::string_view line, char delimiter, int column) {
  TextTokens tokens(line, delimiter, false);
  for (int i = 0; i < column && !tokens.AtEnd(); ++i) tokens.Next();
  return tokens.AtEnd() ? std::string_view() : tokens.Next();
}

bool RowWord::IsIn(std::string_view line, char delimiter) const {
  if (column < 0) return true;
  return WordAt(line, delimiter == '\0' ? GuessDelimiter(line) : delimiter,
                column) == word;
}

}  // namespace hindsight
