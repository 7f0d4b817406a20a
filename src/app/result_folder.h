#ifndef HINDSIGHT_APP_RESULT_FOLDER_H_
#define HINDSIGHT_APP_RESULT_FOLDER_H_

#include <exception>
#include <filesystem>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/interrupt.h"
#include "app/placement.h"
#include "io/write/unpublished.h"

namespace hindsight {

/// One file of results.
struct OutputFile {
  std::string name;
  std::string text;
};

/// A folder of results. Files are written into a temporary folder beside it,
/// each listed in its manifest before, and get their place (app/placement.h)
/// when all of them are on the medium.
///
/// What ends before Commit(), by a signal as by an exception, leaves what
/// Keep() was last told to keep or KeepAtEnd() then gives, marked as
/// incomplete, where that does not replace complete results, and else beside
/// it; without either it leaves nothing. What others put into the temporary
/// folder is never listed nor removed.
class ResultFolder {
 public:
  using Paths = Placement::Paths;

  /// Throws InputError if the folder may not be made or replaced (Placement,
  /// TreatAbandoned) or cannot be, OutputError if the medium fails.
  ResultFolder(const OutputRequest& request,
               const std::function<Paths()>& inputs);
  /// Says on standard error what stays of results that were not committed.
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  /// Path at which the results' file `name` is to be written now. Throws
  /// OutputError if it cannot be listed.
  std::string Path(const std::string& name);
  void Write(const OutputFile& file);

  /// Writes `text`, which says that the results are not complete, as the file
  /// `name`. From now on an early end leaves what has been written so far.
  void Keep(const std::string& name, const std::string& text);

  /// From now on a signal lets `writing` come to its end first: files of what is
  /// done, that are written while the next is worked on.
  void WaitFor(std::shared_future<void> writing);

  /// From now on an early end leaves, of all files, those that `finished` gives
  /// then, from a thread of its own; the first says that the results are not
  /// complete. What does not fit on the medium is left out from the end of the
  /// list. Nothing stays if there is none.
  void KeepAtEnd(std::function<std::vector<OutputFile>()> finished);

  /// Writes `text` as the file `name` and puts the results in place. Throws
  /// OutputError telling where they are if that is not the folder asked for.
  void Commit(const std::string& name, const std::string& text);
  /// Puts the results in place without a further file; throws as above.
  void Commit();

  /// Ends without Commit(); what stays, in words, "" after Commit().
  std::string Abandon();

  /// What an error says; of a file of these results, under its place in the
  /// folder asked for.
  std::string Explain(const std::exception& error) const;

 private:
  /// What stays in the folder if the run ends early.
  struct Kept {
    OutputFile file;  ///< says that it is not all
    std::vector<std::string> files;
  };

  void MakeStaging();
  void List(const std::string& name);
  std::vector<std::string> Written() const;
  void CommitLocked();
  std::string AbandonLocked();
  void SetAside();
  void RemoveUnpublished();
  bool KeepWhatIsFinished(std::string* cause);
  std::string RemoveStaging();
  void RestoreKept();
  void KeepFinished(const std::vector<OutputFile>& files);
  std::string Stop();

  Placement placement_;
  Unpublished staging_;
  std::filesystem::path finished_;   ///< where the files are
  std::vector<std::string> listed_;  ///< in the manifest on the medium
  std::optional<Kept> kept_;
  bool is_left_ = false;    ///< what was to be removed is still there
  bool half_kept_ = false;  ///< the files on the medium are not those of kept_
  std::function<std::vector<OutputFile>()> at_end_;
  std::shared_future<void> writing_;
  std::mutex mutex_;
  StopWatch stop_watch_;  ///< the last: it uses the others
};

/// `work` with a folder of results, which it commits. An OutputError that comes
/// out of it names the file by its place in the folder asked for, and says
/// besides what stays.
int WithResultFolder(const OutputRequest& request,
                     const std::function<ResultFolder::Paths()>& inputs,
                     const std::function<int(ResultFolder*)>& work);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_RESULT_FOLDER_H_
