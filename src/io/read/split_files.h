#ifndef HINDSIGHT_IO_READ_SPLIT_FILES_H_
#define HINDSIGHT_IO_READ_SPLIT_FILES_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/read/found_stream.h"
#include "io/read/recognise_format.h"

namespace hindsight {

/// A file of a folder and what was found in it.
struct RecognisedFile {
  std::string name;
  std::vector<FoundStream> streams;  ///< empty: nothing
};

/// The stamps of a file [s], on whatever clock.
struct StampSpan {
  double first = 0.0;
  double last = 0.0;
  double step = 0.0;  ///< a usual one
  double gap = 0.0;   ///< the longest
};

/// Of a stream in the file `path`: as it was found, else by reading it where its
/// format needs no columns. Nothing if its rows are counted.
std::optional<StampSpan> SpanOf(const std::filesystem::path& path,
                                const FoundStream& found);

/// Joins the files of `folder` that are parts of one stream: of one format, with
/// the same columns, of names that differ by a number or a date alone, and of
/// which each begins where the one before ended: not before, and not later than
/// five rows, the longest gap within them or 0.5 s. The first takes the others'
/// place (FoundStream::more_files). Rows without stamps are never joined. A file
/// without titles beside one of the same columns that has them goes on where that
/// ended, or is left without streams.
void JoinSplitFiles(const std::filesystem::path& folder,
                    std::vector<RecognisedFile>* files);

/// RecogniseFormat of files that are one behind the other; tables are looked at
/// as a whole, of other formats the first file tells.
std::vector<FoundStream> RecogniseParts(const std::vector<std::string>& paths,
                                        const RecogniseHints& hints);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_SPLIT_FILES_H_
