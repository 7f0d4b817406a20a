#include "io/read/text_tokens.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "io/read/units.h"

namespace hindsight {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

TextTokens::TextTokens(std::string_view line, char delimiter,
                       bool comma_is_blank)
    : p_(line.data()),
      end_(line.data() + line.size()),
      delimiter_(delimiter),
      comma_is_blank_(comma_is_blank) {
  if (delimiter_ == ' ') SkipSeparators();
}

void TextTokens::Advance() {
  if (delimiter_ == ' ') {
    SkipSeparators();
  } else if (p_ == end_) {
    finished_ = true;
  } else {
    ++p_;
  }
}

std::string_view TextTokens::Next() {
  const char* begin = p_;
  if (begin != end_ && *begin == '"') {
    const std::string_view rest(begin + 1,
                                static_cast<std::size_t>(end_ - begin - 1));
    const std::size_t close = rest.find('"');
    const std::string_view behind =
        close == rest.npos ? rest : rest.substr(close + 1);
    if (close != rest.npos && (behind.empty() || IsSeparator(behind[0]))) {
      p_ = behind.data();
      Advance();
      return rest.substr(0, close);
    }
  }
  while (p_ != end_ && !IsSeparator(*p_)) ++p_;
  const std::string_view token(begin, static_cast<std::size_t>(p_ - begin));
  Advance();
  return delimiter_ == ' ' ? token : Trim(token);
}

bool TextTokens::NextNumber(double* value) {
  const char* p = p_;
  while (p != end_ && IsBlank(*p) && *p != delimiter_) ++p;
  const auto result = fast_float::from_chars(p, end_, *value);
  if (result.ec != std::errc() || !std::isfinite(*value)) return false;
  p = result.ptr;
  if (delimiter_ != ' ') {
    while (p != end_ && IsBlank(*p) && *p != delimiter_) ++p;
  }
  if (p != end_ && !IsSeparator(*p)) return false;
  p_ = p;
  Advance();
  return true;
}

char GuessDelimiter(std::string_view line) {
  for (const char candidate : {';', ','}) {
    if (line.find(candidate) != line.npos) return candidate;
  }
  return ' ';
}

char GuessDecimal(std::string_view line, char delimiter) {
  if (delimiter == ',') return '.';
  for (const std::string_view token : SplitLine(line, delimiter)) {
    const std::size_t comma = token.find(',');
    if (comma == token.npos || comma == 0 || !IsDigit(token[comma - 1]))
      continue;
    std::string pointed(token);
    pointed[comma] = '.';
    if (ParseNumber(pointed)) return ',';
  }
  return '.';
}

std::vector<std::string_view> SplitLine(std::string_view line, char delimiter,
                                        bool comma_is_blank) {
  std::vector<std::string_view> tokens;
  TextTokens walk(line, delimiter, comma_is_blank);
  while (!walk.AtEnd()) tokens.push_back(walk.Next());
  return tokens;
}

bool IsAbsentWord(std::string_view token) {
  constexpr std::array<std::string_view, 15> kAbsent = {
      "",     "nan",  "NaN",  "NAN",  "-nan", "NA", "N/A", "n/a",
      "#N/A", "null", "NULL", "None", "none", "-",  "--"};
  return std::find(kAbsent.begin(), kAbsent.end(), token) != kAbsent.end();
}

bool HoldsNoNumber(std::string_view line, char delimiter) {
  const std::vector<std::string_view> words = SplitLine(line, delimiter);
  return std::none_of(words.begin(), words.end(), [](std::string_view word) {
    return ParseNumber(word).has_value();
  });
}

bool IsComment(std::string_view line) {
  if (!line.empty() && (IsDigit(line.front()) || line.front() == '-')) {
    return false;
  }
  const std::string_view text = Trim(line);
  return text.empty() || text.front() == '#' || text.front() == '%' ||
         text.starts_with("//");
}

}  // namespace hindsight
