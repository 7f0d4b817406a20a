#include "io/read/npz.h"

#include <archive.h>
#include <archive_entry.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <memory>

#include "base/error.h"
#include "io/read/input_file.h"
#include "io/read/numeric_array.h"

namespace hindsight {
namespace {

constexpr std::string_view kNpzEnding = ".npz";
constexpr std::string_view kNpyEnding = ".npy";

/// Feeds the archive's library. No exception may pass through it.
struct ArchiveSource {
  InputFile file;
  std::size_t offset = 0;
  std::array<char, 1 << 18> buffer = {};
  std::exception_ptr error = nullptr;
};

la_ssize_t ReadSource(struct archive* archive, void* data, const void** bytes) {
  auto* source = static_cast<ArchiveSource*>(data);
  try {
    const std::size_t count = source->file.ReadAt(
        source->offset, source->buffer.data(), source->buffer.size());
    source->offset += count;
    *bytes = source->buffer.data();
    return static_cast<la_ssize_t>(count);
  } catch (const std::exception&) {
    source->error = std::current_exception();
    archive_set_error(archive, EIO, "it cannot be read");
    return ARCHIVE_FATAL;
  }
}

la_int64_t SeekSource(struct archive*, void* data, la_int64_t offset,
                      int whence) {
  auto* source = static_cast<ArchiveSource*>(data);
  const auto size = static_cast<la_int64_t>(source->file.size());
  la_int64_t to = offset;
  if (whence == SEEK_CUR) to += static_cast<la_int64_t>(source->offset);
  if (whence == SEEK_END) to += size;
  if (to < 0 || to > size) return ARCHIVE_FATAL;
  source->offset = static_cast<std::size_t>(to);
  return to;
}

[[noreturn]] void FailArchive(struct archive* archive,
                              const ArchiveSource& source) {
  if (source.error) std::rethrow_exception(source.error);
  const char* cause = archive_error_string(archive);
  throw InputError(source.file.path(), 0,
                   std::string("is no archive of NumPy arrays (.npz), or it "
                               "is damaged or cut off: ") +
                       (cause == nullptr ? "no cause given" : cause));
}

std::string ReadEntry(struct archive* archive, const ArchiveSource& source) {
  std::string bytes;
  std::array<char, 1 << 16> piece;
  while (true) {
    const la_ssize_t count =
        archive_read_data(archive, piece.data(), piece.size());
    if (count < 0) FailArchive(archive, source);
    if (count == 0) return bytes;
    bytes.append(piece.data(), static_cast<std::size_t>(count));
  }
}

std::vector<double> ReadColumn(const std::string& path, const std::string& name,
                               const std::string& bytes) {
  const NumericArray array = ReadNpy(path + ": " + name, bytes);
  if (array.columns != 1) {
    throw InputError(
        path, 0, name + " has two dimensions; expected a column of numbers");
  }
  std::vector<double> values(array.rows);
  for (std::size_t k = 0; k < array.rows; ++k) values[k] = array.at(k, 0);
  return values;
}

}  // namespace

bool IsNpz(std::string_view path) { return path.ends_with(kNpzEnding); }

NamedColumns ReadNpz(const std::string& path) {
  ArchiveSource source = {.file = InputFile(path)};
  const std::unique_ptr<struct archive, decltype(&archive_read_free)> archive(
      archive_read_new(), archive_read_free);
  archive_read_support_format_zip_seekable(archive.get());
  archive_read_set_callback_data(archive.get(), &source);
  archive_read_set_read_callback(archive.get(), ReadSource);
  archive_read_set_seek_callback(archive.get(), SeekSource);
  if (archive_read_open1(archive.get()) != ARCHIVE_OK) {
    FailArchive(archive.get(), source);
  }
  NamedColumns columns;
  struct archive_entry* entry = nullptr;
  while (true) {
    const int status = archive_read_next_header(archive.get(), &entry);
    if (status == ARCHIVE_EOF) break;
    if (status != ARCHIVE_OK) FailArchive(archive.get(), source);
    const char* pathname = archive_entry_pathname(entry);
    std::string name = pathname == nullptr ? "" : pathname;
    if (!name.ends_with(kNpyEnding)) continue;
    std::vector<double> values =
        ReadColumn(path, name, ReadEntry(archive.get(), source));
    name.resize(name.size() - kNpyEnding.size());
    if (!columns.empty() && columns.begin()->second.size() != values.size()) {
      throw InputError(path, 0,
                       name + ".npy has " + std::to_string(values.size()) +
                           " rows and " + columns.begin()->first + ".npy " +
                           std::to_string(columns.begin()->second.size()));
    }
    if (!columns.emplace(name, std::move(values)).second) {
      throw InputError(path, 0, name + ".npy is there twice");
    }
  }
  if (columns.empty()) throw InputError(path, 0, "holds no array (.npy)");
  return columns;
}

}  // namespace hindsight
