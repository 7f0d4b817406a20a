#ifndef HINDSIGHT_IO_TEXT_LINES_H_
#define HINDSIGHT_IO_TEXT_LINES_H_

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace hindsight {

/// The lines of a text file, plain (mapped into memory) or gzip (inflated piece
/// by piece), so that a file of any size needs little memory. A byte-order mark
/// and carriage returns before line feeds are left out.
class TextLines {
 public:
  /// Throws InputError if the file is missing, cannot be read or is empty.
  explicit TextLines(const std::string& path);
  ~TextLines();
  TextLines(const TextLines&) = delete;
  TextLines& operator=(const TextLines&) = delete;

  /// Advances to the next line, valid until the next call. False at the end.
  /// Throws InputError if gzip data are damaged or cut off.
  bool Next(std::string_view* line);

  /// Number of the line last returned, from 1.
  long number() const { return number_; }
  /// False if the line last returned ended with the file, without line feed.
  bool terminated() const { return terminated_; }
  const std::string& path() const { return path_; }
  /// Bytes of text in the whole file, as the file itself says: exact for a
  /// plain file, a hint for gzip.
  std::size_t size_hint() const { return size_hint_; }

  /// Where the text comes from.
  class Source;

 private:
  std::string path_;
  std::unique_ptr<Source> source_;
  std::string_view window_;
  std::size_t size_hint_ = 0;
  long number_ = 0;
  bool terminated_ = true;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_TEXT_LINES_H_
