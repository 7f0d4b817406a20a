#ifndef HINDSIGHT_IO_READ_ROW_WORD_H_
#define HINDSIGHT_IO_READ_ROW_WORD_H_

#include <string>
#include <string_view>

namespace hindsight {

/// Which lines of a text are a stream's, where those of several sensors stand
/// between each other: those that have a word in a column, and where devices of a
/// kind are counted, that of one device in another.
struct RowWord {
  int column = -1;  ///< from 0; -1: all lines are
  std::string word = {};
  int device_column = -1;  ///< from 0; -1: there is one device
  std::string device = {};

  /// "IMU", or "IMU 1".
  std::string Name() const;
  /// As the key `rows` of a configuration.
  std::string Yaml() const;
  /// With '\0' for a delimiter, by that of the line (GuessDelimiter).
  bool IsIn(std::string_view line, char delimiter) const;
  friend bool operator==(const RowWord&, const RowWord&) = default;
};

/// The word of a line in a column; "" if it has none.
std::string_view WordAt(std::string_view line, char delimiter, int column);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_ROW_WORD_H_
