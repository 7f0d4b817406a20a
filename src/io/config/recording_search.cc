#include "io/config/recording_search.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "io/config/recording_groups.h"
#include "io/read/column_choice.h"
#include "io/read/file_columns.h"
#include "io/read/file_format.h"
#include "io/read/imu_pair_guess.h"
#include "io/read/paths.h"
#include "io/read/recognise_format.h"
#include "io/read/split_files.h"
#include "io/read/text_lines.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 6;

bool HoldsImu(const std::vector<FoundStream>& found) {
  return std::any_of(found.begin(), found.end(),
                     [](const FoundStream& f) { return f.imu; });
}

/// A file or folder that is a recording by itself.
bool IsWhole(const FoundStream& found) {
  return found.format->whole_recordings;
}

/// Puts the names of files below `below`.
void MoveBelow(const fs::path& below, RecordingFiles* files) {
  for (auto* list : {&files->imus, &files->others}) {
    for (FoundStream& found : *list) {
      found.file = (below / found.file).string();
      for (std::string& more : found.more_files) {
        more = (below / more).string();
      }
      for (KeyLine& line : found.lines) {
        // Of the accelerometers of a pair; it is in quotes.
        if (line.key == "  file") line.value.insert(1, below.string() + "/");
      }
    }
  }
  for (std::string& name : files->unknown) name = (below / name).string();
  for (std::string& copy : files->copies) copy = (below / copy).string();
}

void Append(RecordingFiles from, RecordingFiles* to) {
  const auto move = [](auto& a, auto* b) {
    b->insert(b->end(), std::make_move_iterator(a.begin()),
              std::make_move_iterator(a.end()));
  };
  move(from.imus, &to->imus);
  move(from.others, &to->others);
  move(from.unknown, &to->unknown);
  move(from.copies, &to->copies);
  if (to->apart.empty()) to->apart = std::move(from.apart);
}

/// What tells the text of one sensor from another's; two do not read the same in
/// two thousand rows.
struct Beginning {
  std::string text;  ///< "" of what is no text
  std::size_t size = 0;
};

Beginning BeginningOf(const std::string& path) {
  constexpr int kLines = 2000;
  try {
    TextLines lines(path);
    Beginning beginning = {"", lines.size_hint()};
    std::string_view line;
    for (int i = 0; i < kLines && lines.Next(&line); ++i) {
      beginning.text.append(line).append("\n");
    }
    return beginning;
  } catch (const InputError&) {
    return {};
  }
}

/// Of files that begin with the same lines the largest is kept, of equal ones the
/// first.
void DropCopies(const fs::path& folder, std::vector<RecognisedFile>* files,
                std::vector<std::string>* copies) {
  std::map<std::string, std::pair<std::string, std::size_t>> kept;  // by text
  std::map<std::string, Beginning> beginnings;                      // by name
  for (const RecognisedFile& file : *files) {
    const fs::path path = folder / file.name;
    if (file.streams.empty() || !IsFile(path)) continue;
    Beginning beginning = BeginningOf(path.string());
    if (beginning.text.empty()) continue;
    const auto [at, is_new] =
        kept.emplace(beginning.text, std::pair(file.name, beginning.size));
    if (!is_new && beginning.size > at->second.second) {
      at->second = {file.name, beginning.size};
    }
    beginnings.emplace(file.name, std::move(beginning));
  }
  std::erase_if(*files, [&](const RecognisedFile& file) {
    const auto at = beginnings.find(file.name);
    if (at == beginnings.end()) return false;
    const std::string& other = kept.at(at->second.text).first;
    if (other == file.name) return false;
    copies->push_back(file.name + ", which begins with the rows of " + other);
    return true;
  });
}

/// Files that are known to hold no stream of a recording.
bool IsAside(const fs::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".tag" || extension == ".yaml" || extension == ".yml";
}

class Search {
 public:
  struct Result {
    std::vector<RecordingFiles> recordings;
    RecordingFiles rest;
  };

  Result Visit(const fs::path& folder, int depth) {
    Result result;
    result.rest.folder = folder;
    std::vector<fs::path> leaves;
    LookAtFiles(folder, depth, &result, &leaves);
    ComposeImu(folder, leaves, &result.rest);
    return Settle(folder, std::move(result));
  }

 private:
  void LookAtFiles(const fs::path& folder, int depth, Result* result,
                   std::vector<fs::path>* leaves) {
    if (auto arrays = ReadNpyColumns(folder.string())) {
      AddArrays(*arrays, folder, &result->rest);
      return;
    }
    std::vector<RecognisedFile> files;
    for (const fs::path& entry : FolderEntries(folder.string())) {
      const std::string name = entry.filename().string();
      if (name.starts_with('.')) continue;
      if (IsFile(entry) || PathExists(entry / "timestamps.txt")) {
        if (IsAside(entry)) continue;
        files.push_back({name, RecogniseFormat(entry.string())});
      } else if (IsFolder(entry) && depth < kDeepest) {
        Result below = Visit(entry, depth + 1);
        if (below.recordings.empty()) leaves->push_back(entry);
        MoveBelow(name, &below.rest);
        Append(std::move(below.rest), &result->rest);
        for (RecordingFiles& recording : below.recordings) {
          result->recordings.push_back(std::move(recording));
        }
      }
    }
    DropCopies(folder, &files, &result->rest.copies);
    JoinSplitFiles(folder, &files);
    result->rest.apart = TakePair(folder, &files);
    for (RecognisedFile& file : files) {
      Take(std::move(file.streams), file.name, folder, result);
    }
  }

  /// Gyros and accelerometers in files side by side, where no file holds both;
  /// ImuPairSearch::apart if there are none.
  static std::string TakePair(const fs::path& folder,
                              std::vector<RecognisedFile>* files) {
    std::vector<std::string> names;
    for (const RecognisedFile& file : *files) {
      if (HoldsImu(file.streams)) return "";
      if (IsFile(folder / file.name)) names.push_back(file.name);
    }
    ImuPairSearch search = FindImuPair(folder, names);
    const std::optional<ImuPair>& pair = search.pair;
    if (!pair) return std::move(search.apart);
    const bool apart = pair->accelerometer != pair->imu.file;
    std::erase_if(*files, [&](const RecognisedFile& file) {
      return apart && file.name == pair->accelerometer;
    });
    for (RecognisedFile& file : *files) {
      if (file.name != pair->imu.file) continue;
      if (apart) file.streams.clear();
      file.streams.insert(file.streams.begin(), pair->imu);
    }
    return "";
  }

  static void Take(std::vector<FoundStream> found, const std::string& name,
                   const fs::path& folder, Result* result) {
    if (found.empty()) {
      result->rest.unknown.push_back(name);
      return;
    }
    RecordingFiles whole;
    const bool own = HoldsImu(found) && IsWhole(found.front());
    RecordingFiles* to = own ? &whole : &result->rest;
    for (FoundStream& stream : found) {
      stream.file = name;
      (stream.imu ? to->imus : to->others).push_back(std::move(stream));
    }
    if (!own) return;
    whole.folder = folder;
    whole.name = fs::path(name).stem().string();
    result->recordings.push_back(std::move(whole));
  }

  static void AddArrays(const FileColumns& arrays, const fs::path& folder,
                        RecordingFiles* rest) {
    const auto found = RecogniseColumns(arrays, folder.filename().string(), {});
    for (FoundStream stream : found) {
      // Arrays are named by their folder.
      stream.file = "..";
      (stream.imu ? rest->imus : rest->others).push_back(std::move(stream));
    }
  }

  /// Gyros and accelerometers in folders of arrays side by side.
  static void ComposeImu(const fs::path& folder,
                         const std::vector<fs::path>& leaves,
                         RecordingFiles* rest) {
    std::optional<FileColumns> gyro;
    std::optional<FileColumns> accel;
    for (const fs::path& leaf : leaves) {
      auto arrays = ReadNpyColumns(leaf.string());
      if (!arrays) continue;
      const auto meanings = ReadMeanings(*arrays);
      const auto holds = [&](const char* quantity) {
        return std::any_of(
            meanings.begin(), meanings.end(),
            [&](const ColumnMeaning& m) { return m.quantity == quantity; });
      };
      if (!gyro && holds("gyro_x"))
        gyro = std::move(arrays);
      else if (!accel && holds("accel_x"))
        accel = std::move(arrays);
    }
    if (!gyro || !accel || gyro->rows != accel->rows) return;
    for (FileColumn& column : accel->columns) {
      gyro->columns.push_back(std::move(column));
    }
    for (FoundStream stream :
         RecogniseColumns(*gyro, folder.filename().string(), {})) {
      if (!stream.imu) continue;
      stream.file = ".";
      rest->imus.push_back(std::move(stream));
    }
  }

  /// What belongs to whom.
  static Result Settle(const fs::path& folder, Result found) {
    if (!found.rest.imus.empty()) {
      found.rest.folder = folder;
      found.rest.name = folder.filename().string();
      for (RecordingFiles& one : GroupRecordings(std::move(found.rest))) {
        found.recordings.push_back(std::move(one));
      }
      found.rest = {};
    } else if (found.recordings.size() == 1 &&
               !(found.rest.others.empty() && found.rest.unknown.empty()) &&
               !IsWhole(found.recordings[0].imus[0])) {
      RecordingFiles& only = found.recordings[0];
      MoveBelow(only.folder.lexically_relative(folder), &only);
      only.folder = folder;
      only.name = folder.filename().string();
      Append(std::move(found.rest), &only);
      found.rest = {};
    }
    return found;
  }
};

}  // namespace

std::vector<RecordingFiles> FindRecordings(const fs::path& folder,
                                           RecordingFiles* rest) {
  Search::Result found = Search().Visit(folder, 0);
  *rest = std::move(found.rest);
  for (RecordingFiles& recording : found.recordings) {
    for (auto* list : {&recording.imus, &recording.others}) {
      for (FoundStream& stream : *list) {
        stream.file = fs::path(stream.file).lexically_normal().generic_string();
        if (stream.file.size() > 1 && stream.file.ends_with('/')) {
          stream.file.pop_back();
        }
      }
    }
  }
  return std::move(found.recordings);
}

}  // namespace hindsight
