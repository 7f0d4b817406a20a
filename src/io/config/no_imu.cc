#include "io/config/no_imu.h"

#include <filesystem>
#include <vector>

#include "base/error.h"
#include "io/read/gzip_reader.h"
#include "io/read/input_file.h"
#include "io/read/paths.h"
#include "io/read/text_lines.h"
#include "io/read/unread_content.h"

namespace hindsight {
namespace {

/// Throws InputError for gzip data that are damaged or cut off, and for UTF-16.
void RequireReadable(const std::string& path) {
  if (!IsFile(path)) return;
  const InputFile file(path);
  if (IsUtf16(file)) TextLines lines(path);
  if (!path.ends_with(".gz")) return;
  if (!GzipReader::IsGzip(file)) return;
  GzipReader reader(file);
  std::vector<char> piece(std::size_t{1} << 20);
  while (reader.Read(piece.data(), piece.size()) > 0) continue;
}

}  // namespace

void FailWithoutImu(const std::string& folder, const RecordingFiles& rest) {
  std::string found;
  const auto name = [&](const std::string& what) {
    constexpr std::size_t kMost = 160;
    if (found.size() > kMost) return;
    found += (found.empty() ? "" : ", ") + what;
  };
  for (const FoundStream& other : rest.others) {
    const std::string kind = other.truth || other.pose ? "a reference"
                             : other.kinds.empty()
                                 ? "a stream"
                                 : std::string(other.kinds.front()->name);
    name(other.file + " (" + kind + ")");
  }
  std::string advice;
  for (const std::string& file : rest.unknown) {
    const std::string path = (rest.folder / file).string();
    RequireReadable(path);
    name(file);
    const std::string why = advice.empty() ? WhyNotRead(path) : "";
    if (!why.empty()) advice = file + " " + why;
  }
  if (advice.empty()) {
    advice =
        "expected columns of three gyros and three accelerometers: name them "
        "under `imu` with `format: columns`";
  }
  throw InputError(
      folder, 0,
      found.empty() ? "holds no files; expected an IMU's"
                    : "no IMU was recognised among " + found + "; " + advice +
                          (rest.apart.empty() ? "" : "; ") + rest.apart);
}

}  // namespace hindsight
