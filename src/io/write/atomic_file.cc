#include "io/write/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

#include "base/file_piece.h"
#include "base/parallel.h"
#include "io/write/output_error.h"

namespace hindsight {
namespace {

constexpr std::size_t kFileBuffer = 1 << 18;

std::error_code LastError() { return {errno, std::system_category()}; }

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path) {
  std::error_code error;
  file_ = CreateUnpublishedFile(path, &error);
  if (error) Fail(error);
  buffer_.reserve(kFileBuffer);
}

AtomicFile::~AtomicFile() {
  if (!committed_) unlink(file_.path.c_str());
}

void AtomicFile::Fail(const std::error_code& cause) const {
  throw OutputError(std::filesystem::path(path_), cause.message());
}

void AtomicFile::Put(std::string_view text) const {
  while (!text.empty()) {
    const ssize_t written = write(file_.descriptor.get(), text.data(),
                                  std::min(text.size(), kFilePiece));
    if (written < 0) {
      if (errno == EINTR) continue;
      Fail(LastError());
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::WaitForOthers() {
  if (writing_.valid()) writing_.get();
}

void AtomicFile::Flush() {
  WaitForOthers();
  Put(buffer_);
  buffer_.clear();
}

void AtomicFile::Write(std::string_view text) {
  if (buffer_.size() + text.size() > kFileBuffer) Flush();
  buffer_.append(text);
}

void AtomicFile::Commit(bool replace) {
  Flush();
  if (fsync(file_.descriptor.get()) != 0) Fail(LastError());
  // Named before it is closed, with which its lock ends.
  std::error_code error;
  if (replace) {
    std::filesystem::rename(file_.path, path_, error);
  } else {
    error = RenameToFree(file_.path, path_);
  }
  if (error) Fail(error);
  committed_ = true;
}

/// The first ones, which others take the place of.
void AtomicFile::WritePieces(std::size_t count) {
  std::size_t size = 0;
  for (std::size_t p = 0; p < count; ++p) size += pieces_[p].size();
  if (size < kFileBuffer) {
    for (std::size_t p = 0; p < count; ++p) Write(pieces_[p]);
    return;
  }
  Flush();
  pieces_.swap(written_);
  writing_ = InBackground([this, count] {
    for (std::size_t p = 0; p < count; ++p) Put(written_[p]);
#ifdef __linux__
    // Begins to put them on the medium, which Commit waits for. Not every file
    // system can.
    sync_file_range(file_.descriptor.get(), 0, 0, SYNC_FILE_RANGE_WRITE);
#endif
  });
}

void AtomicFile::WriteLines(
    std::size_t count,
    const std::function<void(std::size_t i, std::string* out)>& append,
    const Copy* copy) {
  constexpr std::size_t kLinesOfThread = 256;
  constexpr std::size_t kPiecesAtOnce = 16;
  for (std::size_t done = 0; done < count;) {
    const std::size_t left = count - done;
    const std::size_t now =
        std::min(kPiecesAtOnce, (left + kLinesOfThread - 1) / kLinesOfThread);
    pieces_.resize(kPiecesAtOnce);
    if (copy != nullptr) copy->file->pieces_.resize(kPiecesAtOnce);
    ForRanges(now, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        std::string& piece = pieces_[p];
        piece.clear();
        std::string* copies = nullptr;
        if (copy != nullptr) {
          copies = &copy->file->pieces_[p];
          copies->clear();
        }
        const std::size_t first = done + p * kLinesOfThread;
        const std::size_t last = std::min(first + kLinesOfThread, count);
        for (std::size_t i = first; i < last; ++i) {
          const std::size_t at = piece.size();
          append(i, &piece);
          if (copies != nullptr && copy->has(i)) copies->append(piece, at);
          // Lines are about as long as the first.
          if (i == first) piece.reserve(piece.size() * (last - first) * 9 / 8);
        }
      }
    });
    WritePieces(now);
    if (copy != nullptr) copy->file->WritePieces(now);
    done += now * kLinesOfThread;
  }
}

void WriteFileAtomically(const std::string& path, std::string_view text) {
  AtomicFile file(path);
  file.Write(text);
  file.Commit();
}

}  // namespace hindsight
