#ifndef HINDSIGHT_IO_READ_TEXT_LINES_H_
#define HINDSIGHT_IO_READ_TEXT_LINES_H_

#include <cstddef>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "io/read/file_digest.h"
#include "io/read/gzip_reader.h"
#include "io/read/input_file.h"

namespace hindsight {

/// The lines of a text file, plain or gzip, read piece by piece: a file of any
/// size needs 2 MB. A byte-order mark and carriage returns before line feeds
/// are left out.
class TextLines {
 public:
  /// Bytes of a line, without its end.
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;

  /// Throws InputError if the file is missing, cannot be read, is no regular
  /// file, is empty, or begins as UTF-16 or as gzip within gzip do.
  /// Read to its end, a plain file's digest goes to `digests` if that is given, which
  /// must outlive the object.
  explicit TextLines(const std::string& path, ReadDigests* digests = nullptr);
  TextLines(const TextLines&) = delete;
  TextLines& operator=(const TextLines&) = delete;

  /// Advances to the next line, valid until the next call. False at the end.
  /// Throws InputError for a line that is longer than kLongestLine or holds a
  /// NUL byte or a carriage return of its own, if gzip data are damaged, cut
  /// off or followed by anything else, and if the file becomes shorter
  /// meanwhile.
  bool Next(std::string_view* line);

  /// Number of the line last returned, from 1.
  long number() const { return number_; }
  /// False if the line last returned ended with the file, without line feed.
  bool terminated() const { return terminated_; }
  const std::string& path() const { return file_.path(); }
  /// Bytes of text in the whole file, as the file itself says: exact for a
  /// plain file, a hint for gzip.
  std::size_t size_hint() const { return size_hint_; }

 private:
  /// Moves what is left to the front and puts a piece behind it; false if there
  /// is none.
  bool Fill();
  void Check(std::string_view line) const;
  /// Adds a piece to the digest, beside what is done with its lines.
  void Digest(std::string_view piece);

  InputFile file_;
  std::unique_ptr<GzipReader> gzip_;  ///< null: plain text
  std::unique_ptr<char[]> buffer_;
  /// That of the piece before where a digest is made, which may be at work in it still.
  std::unique_ptr<char[]> other_;
  std::size_t offset_ = 0;  ///< of the next piece in a plain file
  std::string_view window_;
  bool odd_ = false;  ///< the window may hold NUL bytes or carriage returns
  std::size_t size_hint_ = 0;
  long number_ = 0;
  bool terminated_ = true;
  ReadDigests* digests_;         ///< null: none is made, or all is done
  std::optional<Sha256> sum_;    ///< if one is made
  std::future<void> digesting_;  ///< the last member: it waits
};

/// Whether it begins as UTF-16 does.
bool IsUtf16(const InputFile& file);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TEXT_LINES_H_
