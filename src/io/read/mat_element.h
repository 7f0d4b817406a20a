#ifndef HINDSIGHT_IO_READ_MAT_ELEMENT_H_
#define HINDSIGHT_IO_READ_MAT_ELEMENT_H_

#include <zlib.h>

#include <cstddef>
#include <memory>
#include <string>

#include "io/read/input_file.h"

namespace hindsight {

/// The bytes of one element of a MATLAB file of version 5, inflated if it is
/// compressed. Every function throws InputError naming the variable if the
/// bytes are not there or damaged.
class MatElement {
 public:
  MatElement(const InputFile& file, std::size_t offset, std::size_t size,
             bool compressed);
  ~MatElement();
  MatElement(const MatElement&) = delete;
  MatElement& operator=(const MatElement&) = delete;

  void Read(char* data, std::size_t count);
  void Skip(std::size_t count);
  /// The bytes that follow, as the element's tag says it.
  void SetSize(std::size_t size) { left_ = size; }
  /// How many of those bytes were not read yet.
  std::size_t left() const { return left_; }
  /// The most bytes that the file can still hold of it.
  std::size_t Most() const;
  /// Compressed data must end here, with the right checksum.
  void Finish();
  void SetName(const std::string& name) { name_ = name; }

  [[noreturn]] void Fail(const std::string& what) const;

 private:
  /// Inflates up to `count` bytes, fewer only at the checked end of the data.
  std::size_t Inflate(char* data, std::size_t count);

  const InputFile& file_;
  std::size_t offset_;
  std::size_t end_;
  std::size_t left_ = 0;
  std::string name_;
  std::unique_ptr<z_stream> stream_;  ///< null: not compressed
  std::string packed_;
  bool finished_ = false;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_MAT_ELEMENT_H_
