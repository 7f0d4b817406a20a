#ifndef HINDSIGHT_APP_RESULT_FOLDER_H_
#define HINDSIGHT_APP_RESULT_FOLDER_H_

#include <sys/stat.h>

#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/interrupt.h"
#include "io/unpublished.h"

namespace hindsight {

/// What --out, --force and --clean say.
struct OutputRequest {
  std::string folder;
  bool force = false;
  bool clean = false;
};

/// Names on standard error what killed runs left beside `target`, a file or a
/// folder of results, or removes it with `clean`; complete results are only
/// named.
void TreatAbandoned(const std::filesystem::path& target, bool clean);

/// A folder of results. Files are written into a temporary folder beside it,
/// which gets the final name in one step when all of them are on the medium.
/// What is in the way then is never removed: the results stay beside it, as
/// FOLDER.1, FOLDER.2 and so on. With `force` a folder is replaced that was
/// there from the start and holds nothing but files that its manifest lists
/// (io/result_manifest.h), by exchanging the two in one step; where the file
/// system cannot, by two renames, and a kill between these leaves both folders
/// beside the name.
///
/// What ends before Commit(), by a signal as by an exception, leaves what
/// Keep() was last told to keep, marked as incomplete, where that does not
/// replace complete results, and else beside it; without Keep() it leaves
/// nothing.
class ResultFolder {
 public:
  using Paths = std::vector<std::filesystem::path>;

  /// `inputs` names what is read besides; it is asked only if the folder
  /// exists. Throws InputError if the folder exists and may not be replaced,
  /// holds an input, or cannot be made; OutputError if the medium fails. What
  /// killed runs left beside the folder is named on standard error, or removed
  /// with `clean`.
  ResultFolder(const OutputRequest& request,
               const std::function<Paths()>& inputs);
  /// Says on standard error what stays of results that were not committed.
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  /// Path at which the results' file `name` is to be written now.
  std::string Path(const std::string& name) const;
  /// The temporary folder.
  const std::filesystem::path& staging() const { return staging_.path; }

  /// Writes `text`, which says that the results are not complete, as the file
  /// `name`. From now on an early end leaves what has been written so far.
  void Keep(const std::string& name, const std::string& text);

  /// Writes `text` as the file `name` and puts the results in place. Throws
  /// OutputError telling where they are if that is not the folder asked for.
  void Commit(const std::string& name, const std::string& text);
  /// The same without a further file.
  void Commit();

  /// Ends without Commit(); what stays, in words, "" after Commit().
  std::string Abandon();

 private:
  struct Kept {
    std::string name;
    std::string text;
    std::vector<std::string> files;
  };

  std::optional<struct stat> CheckMayReplace(
      bool force, const std::function<Paths()>& inputs) const;
  void MakeStaging();
  std::vector<std::string> Written() const;
  void PublishComplete();
  void Publish(bool complete);
  void PublishBeside(bool complete, const std::string& reason);
  void Replace(bool complete);
  void ReplaceByTwoRenames(bool complete);
  void ReplacedBy(const std::filesystem::path& old);
  std::string Objection(const std::filesystem::path& old, bool complete) const;
  std::string AbandonLocked();
  void RestoreKept();
  std::string Stop();

  std::filesystem::path folder_;
  std::optional<struct stat> replaced_;  ///< what may be replaced
  Unpublished staging_;
  std::filesystem::path finished_;  ///< what is to be published
  std::optional<Kept> kept_;
  bool half_kept_ = false;  ///< the files on the medium are not those of kept_
  /// Where the results are, once they are to stay.
  std::optional<std::filesystem::path> published_;
  std::mutex mutex_;
  StopWatch stop_watch_;  ///< the last: it uses the others
};

/// `work` with a folder of results, which it commits. An OutputError that comes
/// out of it says besides what stays.
int WithResultFolder(const OutputRequest& request,
                     const std::function<ResultFolder::Paths()>& inputs,
                     const std::function<int(ResultFolder*)>& work);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_RESULT_FOLDER_H_
