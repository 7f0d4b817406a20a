#ifndef HINDSIGHT_IO_READ_SPLIT_FILES_H_
#define HINDSIGHT_IO_READ_SPLIT_FILES_H_

#include <filesystem>
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

/// Joins the files of `folder` that are parts of one stream: of one format, with
/// the same columns, of names that differ by a number or a date alone, and of
/// which each begins where the one before ended: not before, and not later than
/// five rows, the longest gap within them or 0.5 s. The first takes the others'
/// place (FoundStream::more_files). Rows without stamps are never joined.
void JoinSplitFiles(const std::filesystem::path& folder,
                    std::vector<RecognisedFile>* files);

/// RecogniseFormat of files that are one behind the other; tables are looked at
/// as a whole, of other formats the first file tells.
std::vector<FoundStream> RecogniseParts(const std::vector<std::string>& paths,
                                        const RecogniseHints& hints);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_SPLIT_FILES_H_
