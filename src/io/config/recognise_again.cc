#include "io/config/recognise_again.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "io/read/file_formats.h"
#include "io/read/split_files.h"

namespace hindsight {
namespace {

/// Every part of a table, as that of the stream that was found in it.
std::vector<FoundStream> RecogniseTable(const FoundStream& found,
                                        const std::filesystem::path& folder,
                                        const RecogniseHints& hints) {
  std::vector<std::string> paths = {(folder / found.file).string()};
  for (const std::string& more : found.more_files) {
    paths.push_back((folder / more).string());
  }
  std::vector<FoundStream> streams = RecogniseParts(paths, hints);
  std::erase_if(streams, [](const FoundStream& stream) { return stream.imu; });
  for (FoundStream& stream : streams) {
    stream.file = found.file;
    stream.more_files = found.more_files;
    stream.joined_by = found.joined_by;
  }
  return streams;
}

}  // namespace

void RecogniseAgain(const FoundStream& imu, const std::filesystem::path& folder,
                    std::vector<FoundStream>* others,
                    std::vector<std::string>* unknown) {
  RecogniseHints hints;
  if (imu.stamps) {
    hints.imu_span = imu.stamps->span;
    hints.count_rate = imu.stamps->rate;
  }
  std::set<std::string> done;
  std::vector<FoundStream> again;
  for (FoundStream& found : *others) {
    const bool table = found.format == &ColumnsFormat() && !found.spin_axis &&
                       found.file != imu.file;
    if (!table) {
      again.push_back(std::move(found));
    } else if (done.insert(found.file).second) {
      std::ranges::move(RecogniseTable(found, folder, hints),
                        std::back_inserter(again));
    }
  }
  *others = std::move(again);
  // Counted rows that no stamp made a stream of.
  if (!hints.count_rate) return;
  std::erase_if(*unknown, [&](const std::string& name) {
    std::vector<FoundStream> streams =
        RecogniseFormat((folder / name).string(), hints);
    for (FoundStream& stream : streams) {
      stream.file = name;
      others->push_back(std::move(stream));
    }
    return !streams.empty();
  });
}

}  // namespace hindsight
