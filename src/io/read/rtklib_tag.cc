#include "io/read/rtklib_tag.h"

#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "io/read/input_file.h"

namespace hindsight {
namespace {

constexpr std::size_t kTicks = 60;    // of the header: text, then a tick
constexpr std::size_t kSeconds = 64;  // since 1970, GPS time
constexpr std::size_t kFraction = 68;
constexpr std::size_t kFirstPair = 76;
constexpr std::size_t kPair = 8;  // milliseconds, bytes

template <class Value>
Value At(const char* data) {
  Value value{};
  std::memcpy(&value, data, sizeof(value));
  return value;
}

}  // namespace

std::optional<RtklibTag> ReadRtklibTag(const std::string& path) {
  static_assert(kTicks + sizeof(std::uint32_t) == kSeconds);
  const InputFile file(path);
  std::array<char, kFirstPair> header = {};
  if (file.size() < kFirstPair + kPair ||
      file.ReadAt(0, header.data(), header.size()) < header.size() ||
      !std::string_view(header.data(), header.size())
           .starts_with("TIMETAG RTKLIB")) {
    return std::nullopt;
  }
  const auto seconds = At<std::uint32_t>(header.data() + kSeconds);
  const auto fraction = At<double>(header.data() + kFraction);
  if (!(fraction >= 0.0 && fraction < 1.0) || seconds < kGpsEpochUnix) {
    return std::nullopt;
  }
  const std::size_t pairs = (file.size() - kFirstPair) / kPair;
  std::array<char, kPair> last = {};
  file.ReadAt(kFirstPair + (pairs - 1) * kPair, last.data(), last.size());
  RtklibTag tag;
  tag.opened = {static_cast<std::int64_t>(seconds) - kGpsEpochUnix, fraction};
  tag.duration = 1e-3 * At<std::uint32_t>(last.data());
  tag.bytes = At<std::uint32_t>(last.data() + 4);
  return tag;
}

}  // namespace hindsight
