#ifndef HINDSIGHT_IO_READ_FILE_FORMAT_H_
#define HINDSIGHT_IO_READ_FILE_FORMAT_H_

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/read/fields.h"
#include "io/read/file_columns.h"
#include "io/read/found_stream.h"
#include "io/read/text_format.h"
#include "io/read/text_table.h"

namespace hindsight {

struct SensorKind;

/// What is to be opened, and as what.
struct TableRequest {
  const std::string& path;
  const TextFormat& format;
  const std::vector<FieldName>& fields;  ///< of the stream, all of them
  TextTable::Options options;

  /// Whether the stream is an IMU, a reference trajectory, or one of `kind`.
  bool IsImu() const { return &fields == &ImuFields(); }
  bool IsTruth() const { return &fields == &TruthFields(); }
  bool Is(const SensorKind& kind) const;
};

/// The beginning of a text whose format is not known.
struct TextProbe {
  std::string path;
  std::vector<std::string> comments;
  std::vector<std::string> lines;  ///< others; at least one
};

/// A key of the configuration that streams of one format have: a text.
struct FormatKey {
  std::string_view name;
  std::string_view help;
  std::string_view fallback;  ///< what its absence means, in words
};

/// A format of files, all of it: reader, configuration, `init`, help and
/// documentation walk the list of them (FileFormats). An entry is declared with
/// what the format says in io/read/file_formats.h.
struct FileFormat {
  std::string_view name;          ///< `format` in configurations
  std::string_view help;          ///< one line
  std::string_view streams;       ///< that it can hold, in words
  bool takes_columns = false;     ///< the configuration lists the columns
  bool counts_from_1970 = false;  ///< unless the configuration says otherwise
  bool dated = false;  ///< stamps of fixes are dates, GPS time or UTC
  bool whole_recordings = false;  ///< one that holds an IMU is a recording
  /// Velocities that are all zero with zero standard deviations are absent.
  bool zeros_are_absent = false;
  std::vector<FormatKey> keys = {};

  /// Of delimited text the columns, none for a stream that it cannot hold; of
  /// other formats nullptr, and the function that opens them.
  std::vector<ColumnMapping> (*columns)(const TableRequest&) = nullptr;
  OpenedTable (*open)(const TableRequest&) = nullptr;

  /// How RecogniseFormat knows a file or folder, in this order; nullptr: not so.
  /// By its name, of what is no text; by its beginning, of text that says what
  /// it is; by its numbers, which are read here (none if it is not the format's)
  /// and told by RecogniseColumns; by the beginning of bare numbers in a fixed
  /// order.
  std::optional<FoundStream> (*recognise_name)(const std::filesystem::path&) =
      nullptr;
  std::optional<FoundStream> (*recognise_text)(const TextProbe&) = nullptr;
  std::optional<FileColumns> (*read_columns)(const std::string& path) = nullptr;
  std::optional<FoundStream> (*recognise_bare)(const TextProbe&) = nullptr;

  bool recognised() const {
    return recognise_name != nullptr || recognise_text != nullptr ||
           read_columns != nullptr || recognise_bare != nullptr;
  }
};

/// The list of all formats, in the order of documentation. The first that
/// recognises a file has it, so that those told by less come later.
const std::vector<const FileFormat*>& FileFormats();

/// Adds a format that a program brings; it must outlive the use of the list.
/// Throws std::invalid_argument if the name is taken.
void AddFileFormat(const FileFormat& format);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_FILE_FORMAT_H_
