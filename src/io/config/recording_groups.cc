#include "io/config/recording_groups.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "base/error.h"
#include "io/read/file_format.h"
#include "io/read/split_files.h"
#include "io/read/time_scale.h"
#include "io/read/title_words.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

using Words = std::set<std::string>;

Words WordsOf(std::string file) {
  if (file.ends_with(".gz")) file.resize(file.size() - 3);
  const std::vector<std::string> words =
      SplitWords(fs::path(file).replace_extension("").string());
  return {words.begin(), words.end()};
}

class Grouper {
 public:
  explicit Grouper(RecordingFiles files) : files_(std::move(files)) {
    for (const FoundStream& imu : files_.imus) {
      (imu.spin_axis ? others_ : mains_).push_back(&imu);
    }
    for (const FoundStream& other : files_.others) others_.push_back(&other);
  }

  std::vector<RecordingFiles> Group() {
    if (mains_.size() < 2) return Whole();
    TellNames();
    TellSpans();
    for (const bool by_time : {true, false}) {
      if (by_time ? TimesTell() : NamesTell()) return Groups(by_time);
    }
    RequireOne();
    return Whole();
  }

 private:
  using Places = std::vector<std::size_t>;  ///< of mains_

  std::vector<RecordingFiles> Whole() { return {std::move(files_)}; }

  /// Seconds since 1970 of what is dated.
  std::optional<StampSpan> SpanOfStream(const FoundStream& found) const {
    auto span = SpanOf(files_.folder / found.file, found);
    if (!span || found.stamps) return span;
    for (const std::string& more : found.more_files) {
      const auto next = SpanOf(files_.folder / more, found);
      if (next) span->last = std::max(span->last, next->last);
    }
    if (found.format->dated) {
      span->first += static_cast<double>(kGpsEpochUnix);
      span->last += static_cast<double>(kGpsEpochUnix);
    }
    return span;
  }

  /// The words of each main's name that no other's has.
  void TellNames() {
    for (const FoundStream* main : mains_) {
      Words own = WordsOf(main->file);
      for (const FoundStream* other : mains_) {
        if (other == main) continue;
        for (const std::string& word : WordsOf(other->file)) own.erase(word);
      }
      own_words_.push_back(std::move(own));
    }
  }

  void TellSpans() {
    for (const FoundStream* main : mains_) {
      spans_.push_back(SpanOfStream(*main));
    }
  }

  Places ByName(const std::string& file) const {
    const Words words = WordsOf(file);
    Places places;
    for (std::size_t i = 0; i < mains_.size(); ++i) {
      const bool named =
          std::any_of(own_words_[i].begin(), own_words_[i].end(),
                      [&](const std::string& w) { return words.contains(w); });
      if (named) places.push_back(i);
    }
    return places;
  }

  /// Where it stands in the file of an IMU.
  Places OwnFile(const FoundStream& found) const {
    for (std::size_t i = 0; i < mains_.size(); ++i) {
      if (mains_[i]->file == found.file) return {i};
    }
    return {};
  }

  Places ByTime(const FoundStream& found) const {
    const auto span = SpanOfStream(found);
    Places places;
    for (std::size_t i = 0; span && i < mains_.size(); ++i) {
      if (Share(*span, *spans_[i]) >= kHalf) places.push_back(i);
    }
    return places;
  }

  /// Overlap as a share of the shorter.
  static double Share(const StampSpan& a, const StampSpan& b) {
    const double begin = std::max(a.first, b.first);
    const double end = std::min(a.last, b.last);
    const double shorter = std::min(a.last - a.first, b.last - b.first);
    return shorter > 0.0 ? (end - begin) / shorter : 0.0;
  }

  static bool IsDated(const FoundStream& found) {
    return found.stamps ? found.stamps->scale != StampGuess::Scale::kOwn
                        : found.format->dated;
  }

  bool TimesTell() const {
    for (std::size_t i = 0; i < mains_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (!spans_[i] || !spans_[j] || Share(*spans_[i], *spans_[j]) > 0.0) {
          return false;
        }
      }
    }
    // Clocks of their own differ between the devices of one recording as well.
    return std::all_of(mains_.begin(), mains_.end(),
                       [](const FoundStream* f) { return IsDated(*f); });
  }

  bool NamesTell() const {
    std::set<std::size_t> hit;
    for (const FoundStream* other : others_) {
      const Places places = ByName(other->file);
      if (places.size() > 1) return false;
      if (!OwnFile(*other).empty()) continue;
      hit.insert(places.begin(), places.end());
    }
    return hit.size() > 1;
  }

  /// Throws InputError where IMUs recorded for different times, and there are
  /// positions in as many files: each is likely to be of another.
  void RequireOne() const {
    constexpr double kSame = 0.95;
    double shortest = std::numeric_limits<double>::infinity();
    double longest = 0.0;
    std::string imus;
    for (std::size_t i = 0; i < mains_.size(); ++i) {
      if (!spans_[i]) return;
      const double length = spans_[i]->last - spans_[i]->first;
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
      imus += (i == 0 ? "" : ", ") + mains_[i]->file;
    }
    std::set<std::string> fixes;
    for (const FoundStream* other : others_) {
      const bool places =
          std::any_of(other->kinds.begin(), other->kinds.end(),
                      [](const SensorKind* kind) { return kind->is_position; });
      if (places) fixes.insert(other->file);
    }
    if (shortest >= kSame * longest || fixes.size() < mains_.size()) return;
    throw InputError(
        files_.folder.string(), 0,
        "holds IMUs that recorded for different times (" + imus +
            ") and positions in " + std::to_string(fixes.size()) +
            " files; neither dates nor names tell which belong together: "
            "expected a folder for each recording");
  }

  std::vector<RecordingFiles> Groups(bool by_time) const {
    std::vector<RecordingFiles> groups;
    for (const FoundStream* main : mains_) {
      RecordingFiles group;
      group.folder = files_.folder;
      std::string stem = main->file.substr(0, main->file.find('.'));
      std::replace(stem.begin(), stem.end(), '/', '_');
      group.name = files_.name + "_" + stem;
      group.imus.push_back(*main);
      group.copies = files_.copies;
      groups.push_back(std::move(group));
    }
    for (const FoundStream* other : others_) {
      const bool timed = by_time && IsDated(*other);
      Places places = OwnFile(*other);
      if (places.empty()) {
        places = timed ? ByTime(*other) : ByName(other->file);
      }
      for (const std::size_t place : places) {
        (other->imu ? groups[place].imus : groups[place].others)
            .push_back(*other);
      }
      if (!places.empty()) continue;
      for (RecordingFiles& group : groups) {
        group.copies.push_back(
            other->file + (by_time
                               ? ": its times are of none of the recordings"
                               : ": its name is of none of the recordings"));
      }
    }
    for (const std::string& unknown : files_.unknown) {
      const Places places = ByName(unknown);
      for (std::size_t i = 0; i < groups.size(); ++i) {
        const bool here =
            places.empty() || std::count(places.begin(), places.end(), i) > 0;
        if (here) groups[i].unknown.push_back(unknown);
      }
    }
    return groups;
  }

  static constexpr double kHalf = 0.5;
  RecordingFiles files_;
  std::vector<const FoundStream*> mains_;
  std::vector<const FoundStream*> others_;
  std::vector<Words> own_words_;
  std::vector<std::optional<StampSpan>> spans_;
};

}  // namespace

std::vector<RecordingFiles> GroupRecordings(RecordingFiles files) {
  return Grouper(std::move(files)).Group();
}

}  // namespace hindsight
