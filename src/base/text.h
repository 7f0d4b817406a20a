#ifndef HINDSIGHT_BASE_TEXT_H_
#define HINDSIGHT_BASE_TEXT_H_

#include <string>

namespace hindsight {

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string Format(const char* format, ...);

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_TEXT_H_
