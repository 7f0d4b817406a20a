#ifndef HINDSIGHT_IO_READ_UNREAD_CONTENT_H_
#define HINDSIGHT_IO_READ_UNREAD_CONTENT_H_

#include <string>

namespace hindsight {

/// What a file is that no reader takes, and what to do with it, by its first
/// bytes: "is JSON, which is not read: convert it to columns (CSV)". "" of text
/// that may hold columns, of pictures and films, and of what cannot be read.
std::string WhyNotRead(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_UNREAD_CONTENT_H_
