#ifndef HINDSIGHT_IO_READ_RECOGNISE_FORMAT_H_
#define HINDSIGHT_IO_READ_RECOGNISE_FORMAT_H_

#include <string>
#include <vector>

#include "io/read/found_stream.h"
#include "io/read/recognise_columns.h"

namespace hindsight {

/// The streams of a file, by the list of formats (FileFormats): a bag or an OXTS
/// folder by its name; else by its content if it is in a format of its own; else
/// by its columns' titles and numbers; and where those hold no IMU, as bare
/// numbers in a fixed order. A file of columns is a truth only by its name.
/// Empty if it is none that is known.
std::vector<FoundStream> RecogniseFormat(const std::string& path,
                                         const RecogniseHints& hints = {});

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_RECOGNISE_FORMAT_H_
