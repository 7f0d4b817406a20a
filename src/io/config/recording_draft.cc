#include "io/config/recording_draft.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>

#include "base/error.h"
#include "io/config/draft_clocks.h"
#include "io/config/draft_values.h"
#include "io/config/no_imu.h"
#include "io/config/recognise_again.h"
#include "io/config/recording_search.h"
#include "io/config/supposed_places.h"
#include "io/config/unused_columns.h"
#include "io/config/unused_rows.h"
#include "io/read/file_formats.h"
#include "io/read/input_file.h"
#include "io/read/paths.h"
#include "io/read/recognise_format.h"
#include "io/read/split_files.h"
#include "io/read/units.h"
#include "io/read/unread_content.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

/// Whether a text file has some lines that begin with a number and go on.
bool HoldsRowsOfNumbers(const fs::path& path) {
  constexpr int kLinesLookedAt = 200;
  constexpr int kRows = 5;
  std::ifstream file(path);
  std::string line;
  int rows = 0;
  for (int i = 0; i < kLinesLookedAt && std::getline(file, line); ++i) {
    const std::size_t number = line.find_first_not_of("\" \t+-.");
    const bool is_row = number != line.npos && line[number] >= '0' &&
                        line[number] <= '9' &&
                        line.find_first_of(",; \t", number) != line.npos;
    if (is_row && ++rows == kRows) return true;
  }
  return false;
}

class Drafter {
 public:
  explicit Drafter(RecordingFiles files) : files_(std::move(files)) {
    draft_.name = files_.name;
    draft_.folder = fs::absolute(files_.folder).lexically_normal().string();
    draft_.unknown = files_.unknown;
    draft_.copies = files_.copies;
  }

  RecordingDraft Draft() {
    TakeImu();
    RecogniseAgain(*draft_.imu, draft_.folder, &files_.others, &draft_.unknown);
    for (FoundStream& found :
         TakeSupposedPlaces(draft_.imu->file, &files_.others)) {
      draft_.unused.push_back({"position", &PositionKind(), std::move(found)});
    }
    for (FoundStream& found : files_.others) TakeOther(std::move(found));
    KeepFieldForAttitude();
    SetDraftClocks(&draft_);
    SetStart();
    const bool axes_known = FindLine(draft_.imu->lines, "axes") != nullptr;
    for (StreamDraft& stream : draft_.aiding) {
      CompleteStream(axes_known, &stream);
    }
    for (const std::string& name : draft_.unknown) {
      const fs::path path = fs::path(draft_.folder) / name;
      if (IsFile(path) && IsUtf16(InputFile(path.string()))) {
        draft_.Assume(name + ": is UTF-16 text, which is not read");
      }
      if (!HoldsRowsOfNumbers(path)) continue;
      draft_.Assume(name +
                    ": its numbers were not recognised, and are left out");
    }
    for (std::string& name : draft_.unknown) {
      const std::string why =
          WhyNotRead((fs::path(draft_.folder) / name).string());
      if (!why.empty()) name += ", which " + why;
    }
    for (auto* unused : {UnusedRows, UnusedColumns}) {
      for (std::string& what : unused(draft_)) {
        draft_.unknown.push_back(std::move(what));
      }
    }
    return std::move(draft_);
  }

 private:
  static bool IsBetter(const FoundStream& a, const FoundStream& b) {
    const auto key = [](const FoundStream& found) {
      const bool sure = !found.stamps ||
                        found.stamps->certainty == Certainty::kCertain ||
                        !found.stamps->rate;
      const double rate = found.stamps && found.stamps->step > 0.0
                              ? 1.0 / found.stamps->step
                              : 0.0;
      return std::tuple(!found.spin_axis.has_value(), sure, rate);
    };
    return key(a) > key(b);
  }

  void TakeImu() {
    std::stable_sort(files_.imus.begin(), files_.imus.end(), IsBetter);
    draft_.imu = std::move(files_.imus.front());
    for (std::size_t i = 1; i < files_.imus.size(); ++i) {
      FoundStream& other = files_.imus[i];
      other.imu = false;
      if (other.spin_axis) {
        AddWheel(std::move(other));
      } else {
        other.remarks.emplace_back("another IMU; one is estimated with");
        draft_.unused.push_back({"imu", nullptr, std::move(other)});
      }
    }
    for (const std::string& assumption : draft_.imu->assumptions) {
      draft_.assumptions.push_back("imu: " + assumption);
    }
  }

  void TakeOther(FoundStream found) {
    if (found.truth) {
      if (!draft_.truth) {
        draft_.truth = std::move(found);
      } else if (MoreTold(found, *draft_.truth)) {
        Unused("truth", nullptr, std::move(*draft_.truth), "another truth");
        draft_.truth = std::move(found);
      } else {
        Unused("truth", nullptr, std::move(found), "another truth");
      }
      return;
    }
    if (found.pose) {
      Unused("truth", nullptr, std::move(found),
             "holds attitudes, which no estimate uses; if it is an independent "
             "reference, uncomment");
      return;
    }
    for (const SensorKind* kind : found.kinds) AddAiding(*kind, found);
  }

  /// Positions are worth more than attitudes alone.
  static bool MoreTold(const FoundStream& a, const FoundStream& b) {
    const auto place = [](const FoundStream& found) {
      return FindLine(found.lines, "  lat") != nullptr ||
             FindLine(found.lines, "  p_x") != nullptr;
    };
    return place(a) && !place(b);
  }

  void Unused(const std::string& name, const SensorKind* kind,
              FoundStream found, const std::string& why) {
    found.remarks.push_back(why);
    draft_.unused.push_back({name, kind, std::move(found)});
  }

  void AddAiding(const SensorKind& kind, const FoundStream& found) {
    const auto same = std::count_if(
        draft_.aiding.begin(), draft_.aiding.end(),
        [&](const StreamDraft& stream) { return stream.kind == &kind; });
    const std::string base(kind.name);
    const std::string name = same == 0 ? base : base + std::to_string(same + 1);
    // A second odometer has the errors of the first: the road's and the tyres'.
    if (&kind == &OdometerKind() && same > 0) {
      Unused(name, &kind, found, "another odometer; one is used");
      return;
    }
    draft_.aiding.push_back({name, &kind, found});
    for (const std::string& assumption : found.assumptions) {
      draft_.assumptions.push_back(name + ": " + assumption);
    }
  }

  /// An IMU on a wheel counts as the speed of that wheel, of a radius that only
  /// the motion tells.
  void AddWheel(FoundStream found) {
    const int axis = *found.spin_axis;
    const auto column = static_cast<std::size_t>(
        found.imu_guess->gyro.columns[static_cast<std::size_t>(axis)]);
    const double factor =
        UnitFactor(found.imu_guess->gyro.unit, Quantity::kAngularRate)
            .value_or(1.0);
    std::erase_if(found.lines, [](const KeyLine& line) {
      return line.key.starts_with("  gyro_") ||
             line.key.starts_with("  accel_");
    });
    found.kinds = {&OdometerKind()};
    found.wheel_rate = true;
    found.lines.push_back(
        {"  speed",
         fmt::format("{{column: {}, unit: m/s, scale: {:.6g}}}", column + 1,
                     kUsualWheelRadius * factor),
         fmt::format("rate about {} times a radius of {:g} m (a guess)",
                     "xyz"[static_cast<std::size_t>(axis)],
                     kUsualWheelRadius)});
    found.assumptions.emplace_back(
        "an IMU that spins is taken for one on a wheel, an odometer");
    files_.others.push_back(std::move(found));
  }

  /// A field is measured for attitude alone; in a vehicle it is not the Earth's
  /// until somebody has surveyed it.
  void KeepFieldForAttitude() {
    const bool moves = std::any_of(draft_.aiding.begin(), draft_.aiding.end(),
                                   [](const StreamDraft& stream) {
                                     return stream.kind->places ||
                                            stream.kind->moves ||
                                            stream.kind->standing ||
                                            stream.kind == &OdometerKind() ||
                                            stream.kind == &DvlKind();
                                   });
    if (!moves) return;
    for (auto at = draft_.aiding.begin(); at != draft_.aiding.end();) {
      if (!at->kind->magnetic) {
        ++at;
        continue;
      }
      at->found.remarks.emplace_back(
          "its field is the vehicle's as well; `horizontal`, `declination` and "
          "a survey are needed");
      draft_.unused.push_back(std::move(*at));
      at = draft_.aiding.erase(at);
    }
  }

  void SetStart() {
    SetLine({"initial", ""}, &draft_.top);
    const bool placed = std::any_of(
        draft_.aiding.begin(), draft_.aiding.end(),
        [](const StreamDraft& stream) { return stream.kind->is_position; });
    const bool moves = std::any_of(
        draft_.aiding.begin(), draft_.aiding.end(),
        [](const StreamDraft& stream) { return !stream.kind->magnetic; });
    const auto told = [&](const char* key) {
      return draft_.truth && FindLine(draft_.truth->lines, key) != nullptr;
    };
    const bool truth_tells = (told("  lat") || told("  p_x")) &&
                             (told("  v_n") || told("  v_x")) &&
                             (told("  roll") || told("  q_w"));
    if (!placed && truth_tells) {
      draft_.top.push_back(
          {"  from", "truth", "no stream tells where it begins"});
      draft_.top.push_back({"  position_sigma", "1 m", "(a guess)"});
      draft_.assumptions.emplace_back(
          "no stream tells the position: the truth's first is the start");
    } else if (!placed && moves) {
      draft_.top.push_back({"  position", "[0 deg, 0 deg, 0 m]",
                            "no stream tells where it begins"});
      draft_.top.push_back({"  position_sigma", "1 m", "of a local frame"});
      draft_.assumptions.emplace_back(
          "no stream tells the position or the heading: the place is one of "
          "your own, at latitude and longitude zero, and north as it may be "
          "(initial.position, initial.attitude)");
    }
  }

  RecordingFiles files_;
  RecordingDraft draft_;
};

}  // namespace

void RecordingDraft::Assume(const std::string& what) {
  if (std::find(assumptions.begin(), assumptions.end(), what) ==
      assumptions.end()) {
    assumptions.push_back(what);
  }
}

StreamDraft* RecordingDraft::Find(const std::string& stream) {
  const auto at = std::find_if(
      aiding.begin(), aiding.end(),
      [&](const StreamDraft& draft) { return draft.name == stream; });
  return at == aiding.end() ? nullptr : &*at;
}

std::vector<RecordingDraft> DraftRecordings(const std::string& folder) {
  if (!IsFolder(folder)) {
    throw InputError(folder, 0, "there is no such folder");
  }
  RecordingFiles rest;
  const fs::path absolute = fs::absolute(folder).lexically_normal();
  std::vector<RecordingFiles> recordings = FindRecordings(
      absolute.has_filename() ? absolute : absolute.parent_path(), &rest);
  if (recordings.empty()) FailWithoutImu(folder, rest);
  std::vector<RecordingDraft> drafts;
  for (RecordingFiles& files : recordings) {
    drafts.push_back(Drafter(std::move(files)).Draft());
  }
  return drafts;
}

}  // namespace hindsight
