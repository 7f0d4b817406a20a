#ifndef HINDSIGHT_IO_READ_GZIP_READER_H_
#define HINDSIGHT_IO_READ_GZIP_READER_H_

#include <zlib.h>

#include <cstddef>
#include <vector>

#include "io/read/input_file.h"

namespace hindsight {

/// Inflates a gzip file piece by piece; several gzip streams in a row read as
/// one text.
class GzipReader {
 public:
  /// True for a file that begins as gzip does.
  static bool IsGzip(const InputFile& file);

  /// `file` must outlive the reader.
  explicit GzipReader(const InputFile& file);
  ~GzipReader();
  GzipReader(const GzipReader&) = delete;
  GzipReader& operator=(const GzipReader&) = delete;

  /// Up to `count` bytes of text; 0 at the end. Throws InputError if the data
  /// are damaged or cut off and if other bytes follow them.
  std::size_t Read(char* data, std::size_t count);

  /// Bytes of text as the file's last bytes say it, at most what text is likely
  /// to inflate to: a hint.
  std::size_t size_hint() const;

 private:
  bool Refill();
  /// At the end of a stream: false if it is the end of the file too.
  bool NextStream();

  const InputFile& file_;
  z_stream stream_ = {};
  std::vector<char> packed_;
  std::size_t offset_ = 0;  ///< of the bytes behind packed_
  bool finished_ = false;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_GZIP_READER_H_
