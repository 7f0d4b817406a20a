#include "app/draft_file.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <system_error>

#include "app/flags.h"
#include "app/interrupt.h"
#include "io/write/atomic_file.h"
#include "io/write/output_error.h"
#include "io/write/unpublished.h"

namespace hindsight {

void WriteDraft(const std::string& path, const std::string& text) {
  std::mutex writing;
  // A signal ends the process when all is done, so that no half is left.
  bool written = false;
  const StopWatch watch([&] {
    // For good: who waits for it from now on waits for the end of the process.
    writing.lock();
    return "interrupted; " +
           (written ? path + " is in place" : "nothing is left");
  });
  const std::lock_guard lock(writing);
  AtomicFile file(path);
  file.Write(text);
  file.Commit(FLAGS_force);
  written = true;
  if (const std::error_code error =
          SyncFolder(std::filesystem::absolute(path).parent_path())) {
    throw OutputError(
        "output file " + path +
        " is in place, but may be lost with the power: " + error.message());
  }
}

void PrintLeftOut(const RecordingDraft& draft) {
  constexpr std::size_t kMost = 10;
  for (std::size_t i = 0; i < std::min(kMost, draft.unknown.size()); ++i) {
    std::cout << "not recognised: " << draft.unknown[i] << "\n";
  }
  if (draft.unknown.size() > kMost) {
    std::cout << "not recognised: " << draft.unknown.size() - kMost
              << " more, which the configuration names\n";
  }
}

void RequireRoomFor(const std::string& path) {
  // Its temporary file goes with it.
  const AtomicFile probe(path);
}

}  // namespace hindsight
