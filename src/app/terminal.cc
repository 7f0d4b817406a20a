#include "app/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <streambuf>
#include <string_view>

namespace hindsight {
namespace {

/// Of the environment; "" if it is not set.
std::string_view Variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::size_t WidthOfOutput(bool terminal) {
  const long columns = std::strtol(Variable("COLUMNS").data(), nullptr, 10);
  if (columns > 0) return static_cast<std::size_t>(columns);
  winsize size = {};
  if (!terminal || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return 0;
  return size.ws_col;
}

/// Takes everything and keeps nothing.
class Nowhere : public std::streambuf {
 protected:
  int_type overflow(int_type letter) override {
    return traits_type::not_eof(letter);
  }
};

}  // namespace

TableStyle StyleOfOutput() {
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  return {.width = WidthOfOutput(terminal),
          .colour = terminal && Variable("NO_COLOR").empty() &&
                    Variable("TERM") != "dumb"};
}

void SilenceOutput() {
  static Nowhere nowhere;
  std::cout.rdbuf(&nowhere);
}

}  // namespace hindsight
