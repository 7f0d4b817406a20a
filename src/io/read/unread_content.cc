#include "io/read/unread_content.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "io/read/paths.h"

namespace hindsight {
namespace {

using namespace std::string_view_literals;

struct Signature {
  std::size_t at;
  std::string_view bytes;
  const char* why;  ///< "" of what holds no measurements
};

constexpr char kUnpack[] = "is packed: unpack it";

constexpr std::array kSignatures = {Signature{0, "PK\x03\x04"sv, kUnpack},
                                    Signature{0, "7z\xbc\xaf"sv, kUnpack},
                                    Signature{0, "Rar!"sv, kUnpack},
                                    Signature{0,
                                              "\xfd"
                                              "7zXZ"sv,
                                              kUnpack},
                                    Signature{0, "BZh"sv, kUnpack},
                                    Signature{0, "\x28\xb5\x2f\xfd"sv, kUnpack},
                                    Signature{257, "ustar"sv, kUnpack},
                                    Signature{0, "\xff\xd8\xff"sv, ""},
                                    Signature{0, "\x89PNG"sv, ""},
                                    Signature{0, "GIF8"sv, ""},
                                    Signature{0, "RIFF"sv, ""},
                                    Signature{4, "ftyp"sv, ""},
                                    Signature{0, "%PDF"sv, ""}};

/// Enough for every signature, and for rows of numbers to show that they are text.
std::string FirstBytes(const std::string& path) {
  constexpr std::streamsize kBytes = 4096;
  std::string bytes(kBytes, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), kBytes);
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

bool IsJson(const std::string& bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == bytes.npos) return false;
  const std::size_t next = bytes.find_first_not_of(" \t\r\n", first + 1);
  if (next == bytes.npos) return false;
  return (bytes[first] == '{' && bytes[next] == '"') ||
         (bytes[first] == '[' && (bytes[next] == '{' || bytes[next] == '['));
}

}  // namespace

std::string WhyNotRead(const std::string& path) {
  if (!IsFile(path)) return "";
  const std::filesystem::path name(path);
  const std::string bytes = FirstBytes(path);
  if (IsJson(bytes)) {
    return "is JSON, which is not read: convert it to columns (CSV)";
  }
  for (const char* spreadsheet : {".xlsx", ".xls", ".ods"}) {
    if (name.extension() == spreadsheet) {
      return "is a spreadsheet, which is not read: save it as CSV";
    }
  }
  for (const Signature& signature : kSignatures) {
    if (bytes.size() > signature.at && std::string_view(bytes)
                                           .substr(signature.at)
                                           .starts_with(signature.bytes)) {
      return signature.why;
    }
  }
  const bool gzip = bytes.starts_with("\x1f\x8b");
  if (gzip &&
      (name.extension() == ".tgz" || name.stem().extension() == ".tar")) {
    return kUnpack;
  }
  const bool utf16 =
      bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff");
  if (!gzip && !utf16 && bytes.find('\0') != bytes.npos) {
    return "is binary, in no format that is read: convert it to columns (CSV)";
  }
  return "";
}

}  // namespace hindsight
