#include "io/write/npz.h"

#include <archive.h>
#include <archive_entry.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <exception>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>

#include "base/file_piece.h"
#include "io/write/output_error.h"

namespace hindsight {
namespace {

static_assert(std::endian::native == std::endian::little,
              "arrays are written as they stand in memory");

constexpr auto kValueBytes = static_cast<std::int64_t>(sizeof(double));

[[noreturn]] void Fail(const std::string& path, int cause) {
  throw OutputError(std::filesystem::path(path),
                    std::error_code(cause, std::system_category()).message());
}

/// A file to write and read of which nothing stays when it is closed.
Descriptor NamelessFile(const std::string& beside) {
  std::error_code error;
  Unpublished file = CreateUnpublishedFile(beside, &error);
  if (error) Fail(beside, error.value());
  unlink(file.path.c_str());
  return std::move(file.descriptor);
}

/// The start of a .npy of version 1: its data begin at a multiple of 64 bytes.
std::string NpyHeader(std::int64_t size) {
  constexpr std::size_t kStart = 10;
  constexpr std::size_t kAlignment = 64;
  std::string text = "{'descr': '<f8', 'fortran_order': False, 'shape': (" +
                     std::to_string(size) + ",), }";
  while ((kStart + text.size() + 1) % kAlignment != 0) text += ' ';
  text += '\n';
  const std::size_t length = text.size();
  return std::string("\x93NUMPY\x01\x00", 8) +
         static_cast<char>(length & 0xff) + static_cast<char>(length >> 8) +
         text;
}

/// Takes what the archive's library writes. No exception may pass through it.
struct ArchiveSink {
  AtomicFile* file;
  std::exception_ptr error;
};

la_ssize_t WriteToSink(struct archive* archive, void* data, const void* bytes,
                       std::size_t count) {
  auto* sink = static_cast<ArchiveSink*>(data);
  try {
    sink->file->Write({static_cast<const char*>(bytes), count});
    return static_cast<la_ssize_t>(count);
  } catch (const std::exception&) {
    sink->error = std::current_exception();
    archive_set_error(archive, EIO, "the file cannot be written");
    return -1;
  }
}

}  // namespace

Npz::Npz(const std::string& path, const std::vector<SolutionColumn>& columns)
    : path_(path), file_(path), rows_(NamelessFile(path)) {
  for (const SolutionColumn& column : columns) names_.push_back(column.name);
}

void Npz::Append(const Eigen::MatrixXd& rows) {
  std::string_view rest(
      static_cast<const char*>(static_cast<const void*>(rows.data())),
      static_cast<std::size_t>(rows.size() * kValueBytes));
  while (!rest.empty()) {
    const ssize_t written =
        write(rows_.get(), rest.data(), std::min(rest.size(), kFilePiece));
    if (written < 0) {
      if (errno == EINTR) continue;
      Fail(path_, errno);
    }
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  piece_sizes_.push_back(rows.rows());
  row_count_ += rows.rows();
}

void Npz::WriteArray(std::size_t column, ::archive* archive) {
  const std::string header = NpyHeader(row_count_);
  archive_write_data(archive, header.data(), header.size());
  const auto columns = static_cast<std::int64_t>(names_.size());
  std::vector<char> values;
  std::int64_t begin = 0;
  for (const std::int64_t rows : piece_sizes_) {
    values.resize(static_cast<std::size_t>(rows * kValueBytes));
    const std::int64_t offset =
        begin + static_cast<std::int64_t>(column) * rows * kValueBytes;
    std::size_t count = 0;
    while (count < values.size()) {
      const ssize_t got =
          pread(rows_.get(), values.data() + count, values.size() - count,
                offset + static_cast<std::int64_t>(count));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) Fail(path_, got < 0 ? errno : EIO);
      count += static_cast<std::size_t>(got);
    }
    if (archive_write_data(archive, values.data(), values.size()) < 0) return;
    begin += columns * rows * kValueBytes;
  }
}

void Npz::Commit() {
  ArchiveSink sink = {&file_, nullptr};
  const std::unique_ptr<struct archive, decltype(&archive_write_free)> archive(
      archive_write_new(), archive_write_free);
  archive_write_set_format_zip(archive.get());
  archive_write_zip_set_compression_store(archive.get());
  archive_write_set_bytes_per_block(archive.get(), 0);
  archive_write_open(archive.get(), &sink, nullptr, WriteToSink, nullptr);
  const std::unique_ptr<struct archive_entry, decltype(&archive_entry_free)>
      entry(archive_entry_new(), archive_entry_free);
  const std::int64_t bytes =
      static_cast<std::int64_t>(NpyHeader(row_count_).size()) +
      row_count_ * kValueBytes;
  for (std::size_t i = 0; i < names_.size() && !sink.error; ++i) {
    archive_entry_clear(entry.get());
    archive_entry_set_pathname(entry.get(), (names_[i] + ".npy").c_str());
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    archive_entry_set_perm(entry.get(), 0644);
    archive_entry_set_size(entry.get(), bytes);
    archive_write_header(archive.get(), entry.get());
    WriteArray(i, archive.get());
  }
  const int closed = archive_write_close(archive.get());
  if (sink.error) std::rethrow_exception(sink.error);
  if (closed != ARCHIVE_OK) {
    const char* cause = archive_error_string(archive.get());
    throw OutputError(std::filesystem::path(path_),
                      cause == nullptr ? "the archive failed" : cause);
  }
  file_.Commit();
}

}  // namespace hindsight
