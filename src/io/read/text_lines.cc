#include "io/read/text_lines.h"

#include <array>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"

namespace hindsight {
namespace {

constexpr std::size_t kLinePiece = std::size_t{1} << 20;

bool Holds(std::string_view text, char c) {
  return !text.empty() && std::memchr(text.data(), c, text.size()) != nullptr;
}

bool IsUtf16Start(std::string_view text) {
  return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
}

}  // namespace

bool IsUtf16(const InputFile& file) {
  constexpr std::size_t kMark = 2;
  std::array<char, kMark> begin = {};
  if (file.size() < kMark) return false;
  file.ReadAt(0, begin.data(), kMark);
  return IsUtf16Start({begin.data(), kMark});
}

TextLines::TextLines(const std::string& path, ReadDigests* digests)
    : file_(path), size_hint_(file_.size()), digests_(digests) {
  if (GzipReader::IsGzip(file_)) {
    gzip_ = std::make_unique<GzipReader>(file_);
    size_hint_ = gzip_->size_hint();
    digests_ = nullptr;
  }
  if (digests_ != nullptr && !digests_->Claim(path)) digests_ = nullptr;
  buffer_.reset(new char[kLongestLine + kLinePiece]);
  if (digests_ != nullptr) {
    other_.reset(new char[kLongestLine + kLinePiece]);
    sum_.emplace();
  }
  if (!Fill()) throw InputError(path, 0, "the file is empty");
  if (IsUtf16Start(window_)) {
    throw InputError(path, 0,
                     "is UTF-16 text; expected UTF-8 or ASCII, to which `iconv "
                     "-f UTF-16 -t UTF-8` brings it");
  }
  if (gzip_ && window_.starts_with("\x1F\x8B")) {
    throw InputError(path, 0, "is gzip within gzip; expected text in it");
  }
  if (window_.starts_with("\xEF\xBB\xBF")) window_.remove_prefix(3);
}

bool TextLines::Fill() {
  if (digests_ != nullptr) buffer_.swap(other_);
  if (!window_.empty()) {
    std::memmove(buffer_.get(), window_.data(), window_.size());
  }
  char* end = buffer_.get() + window_.size();
  const std::size_t count = gzip_ ? gzip_->Read(end, kLinePiece)
                                  : file_.ReadAt(offset_, end, kLinePiece);
  offset_ += count;
  const std::string_view piece(end, count);
  odd_ = Holds(piece, '\0') || Holds(piece, '\r') || (odd_ && !window_.empty());
  window_ = {buffer_.get(), window_.size() + count};
  if (digests_ != nullptr) Digest(piece);
  return count > 0;
}

void TextLines::Digest(std::string_view piece) {
  if (digesting_.valid()) digesting_.get();
  if (!piece.empty()) {
    digesting_ = InBackground([this, piece] { sum_->Add(piece); });
    return;
  }
  std::exchange(digests_, nullptr)
      ->Add({path(), file_.size(), sum_->Hexadecimal()});
}

void TextLines::Check(std::string_view line) const {
  if (line.size() > kLongestLine) {
    throw InputError(path(), number_,
                     "the line is longer than " + std::to_string(kLongestLine) +
                         " bytes; expected lines of text");
  }
  if (!odd_) return;
  if (Holds(line, '\0')) {
    throw InputError(path(), number_, "holds a NUL byte; expected text");
  }
  if (Holds(line, '\r')) {
    throw InputError(path(), number_,
                     "holds a carriage return within the line; expected line "
                     "feeds, with or without one before, as line ends");
  }
}

bool TextLines::Next(std::string_view* line) {
  std::size_t searched = 0;
  while (true) {
    const void* found = searched == window_.size()
                            ? nullptr
                            : std::memchr(window_.data() + searched, '\n',
                                          window_.size() - searched);
    if (found != nullptr) {
      const auto length = static_cast<std::size_t>(
          static_cast<const char*>(found) - window_.data());
      *line = window_.substr(0, length);
      window_.remove_prefix(length + 1);
      terminated_ = true;
      break;
    }
    searched = window_.size();
    if (searched <= kLongestLine && Fill()) continue;
    if (window_.empty()) return false;
    *line = window_;
    window_ = {};
    terminated_ = false;
    break;
  }
  ++number_;
  if (line->ends_with('\r')) line->remove_suffix(1);
  Check(*line);
  return true;
}

}  // namespace hindsight
