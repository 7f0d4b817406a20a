#ifndef HINDSIGHT_IO_READ_TEXT_TOKENS_H_
#define HINDSIGHT_IO_READ_TEXT_TOKENS_H_

#include <string_view>
#include <vector>

namespace hindsight {

/// Walks over the tokens of a line without copying them.
class TextTokens {
 public:
  /// A delimiter of ' ' is any run of blanks, and of commas if these are blank.
  TextTokens(std::string_view line, char delimiter, bool comma_is_blank);

  bool AtEnd() const { return finished_ || (delimiter_ == ' ' && p_ == end_); }
  /// Without blanks or quotation marks around it; separators within quotation
  /// marks belong to it.
  std::string_view Next();
  /// Reads the next token as a finite number. False, and stays, for anything
  /// else, and for some unusual spellings of numbers.
  bool NextNumber(double* value);

 private:
  bool IsSeparator(char c) const {
    return delimiter_ == ' ' ? IsBlank(c) || (comma_is_blank_ && c == ',')
                             : c == delimiter_;
  }
  static bool IsBlank(char c) { return c == ' ' || c == '\t'; }
  void SkipSeparators() {
    while (p_ != end_ && IsSeparator(*p_)) ++p_;
  }
  void Advance();

  const char* p_;
  const char* end_;
  char delimiter_;
  bool comma_is_blank_;
  bool finished_ = false;
};

/// The delimiter of a line's columns: ';' where one stands in it, else ',',
/// else blanks.
char GuessDelimiter(std::string_view line);
/// ',' where a column of the line is a number with a decimal comma ("0,5") and
/// the delimiter another, else '.'.
char GuessDecimal(std::string_view line, char delimiter);
std::vector<std::string_view> SplitLine(std::string_view line, char delimiter,
                                        bool comma_is_blank = false);

/// What stands where there is no value: nothing, "nan", "NA", "null", "--" and
/// the like.
bool IsAbsentWord(std::string_view token);

/// As a line of titles.
bool HoldsNoNumber(std::string_view line, char delimiter);

/// True for a line that is empty or starts with '#', '%' or "//".
bool IsComment(std::string_view line);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TEXT_TOKENS_H_
