#include "app/error_line.h"

#include <algorithm>
#include <cstdio>

namespace hindsight {
namespace {

void Print(const char* kind, std::string message) {
  // A message may quote what a damaged file holds.
  constexpr std::size_t kLongest = 500;
  std::replace_if(
      message.begin(), message.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; },
      ' ');
  if (message.size() > kLongest) message = message.substr(0, kLongest) + "...";
  std::fprintf(stderr, "hindsight: %s: %s\n", kind, message.c_str());
}

}  // namespace

void PrintError(const std::string& message) { Print("error", message); }

void PrintNote(const std::string& message) { Print("note", message); }

}  // namespace hindsight
