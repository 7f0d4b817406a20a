#ifndef HINDSIGHT_IO_READ_TEXT_FILE_H_
#define HINDSIGHT_IO_READ_TEXT_FILE_H_

#include <string>

namespace hindsight {

/// The bytes of a file. Throws InputError if it is missing, cannot be read or
/// is no regular file.
std::string ReadTextFile(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TEXT_FILE_H_
