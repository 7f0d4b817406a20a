#include "io/config/recording_draft.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>
#include <variant>

#include "base/error.h"
#include "io/config/recording_search.h"
#include "io/read/paths.h"
#include "io/read/reader.h"
#include "io/read/rtklib_tag.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

bool IsDatedFormat(const std::string& format) {
  return format == "rtklib_pos" || format == "nmea";
}

std::optional<Stamp> FirstDate(const fs::path& path, const Found& found) {
  if (found.stamps && found.stamps->scale == StampGuess::Scale::kUnix) {
    const double whole = std::floor(found.stamps->first);
    return GpsFromUnix(
        {static_cast<std::int64_t>(whole), found.stamps->first - whole});
  }
  if (!IsDatedFormat(found.format)) return std::nullopt;
  TextFormat format;
  const auto& names = FormatNames();
  format.kind = static_cast<TextFormat::Kind>(
      std::find(names.begin(), names.end(), found.format) - names.begin());
  const OpenedTable opened =
      OpenTable(path.string(), format, PositionKind().columns, {});
  if (!opened.dated || !opened.table->Next()) return std::nullopt;
  return opened.table->stamp();
}

/// The share of rows whose integer ambiguities are resolved.
double FixedShare(const fs::path& path) {
  TextFormat format;
  format.kind = TextFormat::Kind::kRtklibPos;
  const OpenedTable opened =
      OpenTable(path.string(), format, {{"quality", Quantity::kRatio}}, {});
  long rows = 0;
  long fixed = 0;
  while (opened.table->Next()) {
    ++rows;
    if (opened.table->value(0) == 1.0) ++fixed;
  }
  return rows == 0 ? 0.0
                   : static_cast<double>(fixed) / static_cast<double>(rows);
}

/// "{rate: 100 Hz, start: 0 s}"; nothing to say: "".
void SetTime(const std::string& start, const std::string& duration,
             const std::string& comment, Found* found) {
  std::vector<std::string> parts;
  if (found->stamps && found->stamps->rate) {
    parts.push_back(fmt::format("rate: {:.12g} Hz", *found->stamps->rate));
  }
  if (!start.empty()) parts.push_back("start: " + start);
  if (!duration.empty()) parts.push_back("duration: " + duration);
  const bool unix_scale =
      found->stamps && found->stamps->scale == StampGuess::Scale::kUnix;
  if (unix_scale && start.empty()) parts.emplace_back("clock: unix");
  if (parts.empty()) return;
  std::string value;
  for (const std::string& part : parts) {
    value += (value.empty() ? "{" : ", ") + part;
  }
  std::string why = comment;
  if (found->stamps && found->stamps->rate) {
    why += (why.empty() ? "" : "; ") + found->stamps->reason + " (" +
           CertaintyName(found->stamps->certainty) + ")";
  }
  SetLine({"time", value + "}", why}, &found->lines);
}

/// Overlap of two records in their own stamps, as a share of the shorter.
double Overlap(const StampGuess& a, const StampGuess& b) {
  const double begin = std::max(a.first, b.first);
  const double end = std::min(a.first + a.span, b.first + b.span);
  const double shorter = std::min(a.span, b.span);
  return shorter > 0.0 ? (end - begin) / shorter : 0.0;
}

class Drafter {
 public:
  explicit Drafter(RecordingFiles files) : files_(std::move(files)) {
    draft_.name = files_.name;
    draft_.folder = fs::absolute(files_.folder).lexically_normal().string();
    draft_.unknown = files_.unknown;
  }

  RecordingDraft Draft() {
    TakeImu();
    LookAgain();
    for (Found& found : files_.others) TakeOther(std::move(found));
    KeepFieldForAttitude();
    SetClocks();
    SetStart();
    for (StreamDraft& stream : draft_.aiding) Complete(&stream);
    return std::move(draft_);
  }

 private:
  fs::path PathOf(const Found& found) const {
    return fs::path(draft_.folder) / found.file;
  }

  static bool IsBetter(const Found& a, const Found& b) {
    const auto key = [](const Found& found) {
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
      Found& other = files_.imus[i];
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

  /// Once the IMU's record is known, what was stamped otherwise is looked at
  /// again.
  void LookAgain() {
    RecogniseHints hints;
    if (draft_.imu->stamps) {
      hints.imu_span = draft_.imu->stamps->span;
      hints.count_rate = draft_.imu->stamps->rate;
    }
    std::vector<std::string> done;
    std::vector<Found> again;
    for (Found& found : files_.others) {
      const bool table = found.format == "columns" && !found.spin_axis &&
                         found.file != draft_.imu->file;
      if (!table) {
        again.push_back(std::move(found));
        continue;
      }
      if (std::find(done.begin(), done.end(), found.file) != done.end()) {
        continue;
      }
      done.push_back(found.file);
      for (Found stream : RecogniseFormat(PathOf(found).string(), hints)) {
        stream.file = found.file;
        if (!stream.imu) again.push_back(std::move(stream));
      }
    }
    // Counted rows that no stamp made a stream of.
    std::vector<std::string> unknown;
    for (const std::string& name : draft_.unknown) {
      auto streams = hints.count_rate
                         ? RecogniseFormat(
                               (fs::path(draft_.folder) / name).string(), hints)
                         : std::vector<Found>();
      if (streams.empty()) unknown.push_back(name);
      for (Found& stream : streams) {
        stream.file = name;
        again.push_back(std::move(stream));
      }
    }
    draft_.unknown = std::move(unknown);
    files_.others = std::move(again);
  }

  void TakeOther(Found found) {
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
  static bool MoreTold(const Found& a, const Found& b) {
    const auto place = [](const Found& found) {
      return FindLine(found.lines, "  lat") != nullptr ||
             FindLine(found.lines, "  p_x") != nullptr;
    };
    return place(a) && !place(b);
  }

  void Unused(const std::string& name, const SensorKind* kind, Found found,
              const std::string& why) {
    found.remarks.push_back(why);
    draft_.unused.push_back({name, kind, std::move(found)});
  }

  void AddAiding(const SensorKind& kind, const Found& found) {
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
  void AddWheel(Found found) {
    constexpr double kUsualRadius = 0.3;
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
    found.lines.push_back(
        {"  speed",
         fmt::format("{{column: {}, unit: m/s, scale: {:.6g}}}", column + 1,
                     kUsualRadius * factor),
         fmt::format("rate about {} times a radius of {:g} m (a guess)",
                     "xyz"[static_cast<std::size_t>(axis)], kUsualRadius)});
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

  void SetClocks() {
    Found& imu = *draft_.imu;
    std::optional<Stamp> date;
    for (const StreamDraft& stream : draft_.aiding) {
      if (!date) date = FirstDate(PathOf(stream.found), stream.found);
    }
    const bool imu_dated =
        !imu.stamps || imu.stamps->scale == StampGuess::Scale::kUnix;
    if (date && !imu_dated) {
      StartImuAt(*date, &imu);
    } else if (imu.stamps) {
      BeginTogether(&imu);
    }
    for (StreamDraft& stream : draft_.aiding) {
      if (FindLine(stream.found.lines, "time") == nullptr) {
        SetTime("", "", "", &stream.found);
      }
    }
    if (draft_.truth && FindLine(draft_.truth->lines, "time") == nullptr) {
      SetTime(draft_.truth->stamps && draft_.truth->stamps->rate ? "0 s" : "",
              "", "", &*draft_.truth);
    }
    for (StreamDraft& stream : draft_.unused) {
      SetTime("", "", "", &stream.found);
    }
  }

  /// The stamps of the fixes are dates, those of the IMU are not.
  void StartImuAt(const Stamp& first_fix, Found* imu) {
    fs::path beside = PathOf(*imu).string() + ".tag";
    // "imu.csv.gz" was logged as "imu.csv".
    if (!PathExists(beside) && PathOf(*imu).extension() == ".gz") {
      beside = PathOf(*imu).replace_extension("").string() + ".tag";
    }
    if (const auto found = PathExists(beside) ? ReadRtklibTag(beside.string())
                                              : std::nullopt) {
      SetTime(FormatGpsTime(Nanoseconds(found->opened)),
              fmt::format("{:.3f} s", found->duration),
              "by the time tag beside it", imu);
      return;
    }
    SetTime(FormatGpsTime(Nanoseconds(first_fix)), "",
            "as the first fix (a guess); the motion tells the rest", imu);
    draft_.assumptions.push_back(
        "imu: its clock has no date; it begins with the first fix, and the "
        "motion tells the offset");
  }

  /// Records whose stamps do not overlap begin together.
  void BeginTogether(Found* imu) {
    bool apart = imu->stamps->rate.has_value();
    const auto look = [&](const Found& found) {
      apart = apart ||
              (found.stamps && (Overlap(*imu->stamps, *found.stamps) < 0.5 ||
                                found.stamps->rate));
    };
    for (const StreamDraft& stream : draft_.aiding) look(stream.found);
    if (draft_.truth) look(*draft_.truth);
    if (!apart) {
      SetTime("", "", "", imu);
      return;
    }
    const std::string why = "clocks that do not overlap begin together";
    SetTime("0 s", "", why, imu);
    for (StreamDraft& stream : draft_.aiding) {
      if (stream.found.stamps) SetTime("0 s", "", "", &stream.found);
    }
    if (draft_.truth && draft_.truth->stamps) {
      SetTime("0 s", "", "", &*draft_.truth);
    }
    if (!imu->stamps->rate) draft_.assumptions.push_back(why);
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
          "your own, at latitude and longitude zero, and north as it may be");
    }
  }

  /// Values for what no file says, so that it runs as it stands.
  void Complete(StreamDraft* stream) const;

  RecordingFiles files_;
  RecordingDraft draft_;
};

/// A value that is usual of a key that must be given.
std::string UsualValue(const SensorKey& key) {
  if (std::holds_alternative<SensorKey::Place>(key.value)) {
    return "[0 deg, 0 deg, 0 m]";
  }
  std::string value = "1";
  switch (key.quantity) {
    case Quantity::kLength:
      value = "2 m";
      break;
    case Quantity::kSpeed:
      value = "0.2 m/s";
      break;
    case Quantity::kAngle:
      value = "2 deg";
      break;
    case Quantity::kRatio:
      break;
    default:
      value += std::string(" ") + SiUnit(key.quantity);
  }
  const bool three = std::holds_alternative<SensorKey::Vector>(key.value);
  return three ? "[" + value + ", " + value + ", " + value + "]" : value;
}

/// What suits a kind of sensor where its file says nothing.
std::vector<KeyLine> UsualLines(const SensorKind& kind, bool sigmas) {
  std::vector<KeyLine> lines;
  if (kind.is_position) {
    if (!sigmas) {
      lines.push_back(
          {"noise",
           "{model: gauss_markov, sigma: 2 m, tau: 60 s, white: 0.1 m}",
           "usual of a single receiver (a guess)"});
    }
    lines.push_back({"estimate", "{lever_arm: 1 m, time_offset: 0.5 s}",
                     "lever_arm is from the IMU: forward, right, down"});
  } else if (kind.is_velocity) {
    if (!sigmas) lines.push_back({"sigma", "0.2 m/s", "usual (a guess)"});
    lines.push_back({"estimate", "{time_offset: 0.5 s}"});
  } else if (&kind == &SpeedCourseKind()) {
    lines.push_back({"sigma", "0.2 m/s", "usual (a guess)"});
    lines.push_back({"course_sigma", "2 deg", "usual (a guess)"});
    lines.push_back({"course_above", "2 m/s"});
    lines.push_back({"estimate", "{time_offset: 0.5 s}"});
  } else if (&kind == &OdometerKind()) {
    lines.push_back({"sigma", "[0.1, 0.2, 0.3 m/s]",
                     "with no slip to the side or up (a guess)"});
    lines.push_back(
        {"estimate", "{scale: 5 %, mounting: 10 deg, time_offset: 0.1 s}"});
  } else if (&kind == &DvlKind()) {
    lines.push_back({"sigma", "1 cm/s", "usual (a guess)"});
    lines.push_back(
        {"estimate",
         "{scale: 1 %, mounting: 3 deg, lever_arm: 1 m, time_offset: 0.5 s}"});
  } else if (kind.standing) {
    lines.push_back({"sigma", "5 cm/s", "of a foot that rolls (a guess)"});
  } else if (kind.magnetic) {
    lines.push_back({"form", "vector"});
    lines.push_back({"sigma", "3.5 uT", "indoors (a guess)"});
    lines.push_back({"horizontal", "20 uT", "(a guess)"});
    lines.push_back({"down", "44 uT", "(a guess)"});
  }
  return lines;
}

void Drafter::Complete(StreamDraft* stream) const {
  std::vector<KeyLine>& lines = stream->found.lines;
  const SensorKind& kind = *stream->kind;
  const Found& found = stream->found;
  const bool own_sigma = found.format == "nmea" || found.format == "nclt" ||
                         FindLine(lines, "noise") != nullptr;
  const SensorSettings settings = SettingsOf(kind);
  const bool sigmas =
      found.sigmas && !own_sigma && kind.measured(settings).sigmas > 0;
  const auto add = [&](const KeyLine& line) {
    if (FindLine(lines, line.key) == nullptr) lines.push_back(line);
  };
  if (found.format == "rtklib_pos") {
    constexpr double kMostlyFixed = 0.5;
    const bool fixed = FixedShare(PathOf(found)) > kMostlyFixed;
    if (fixed) add({"accept_quality", "[1]", "integer ambiguities resolved"});
  }
  const bool fast =
      found.stamps ? found.stamps->step < 0.9 : found.format == "rtklib_pos";
  if ((kind.is_position || &kind == &SpeedCourseKind()) && fast) {
    add({"every", "1 s", "errors of neighbouring fixes are alike"});
  }
  if (&kind == &OdometerKind() && found.stamps && found.stamps->step < 0.09) {
    add({"every", "0.1 s"});
  }
  const bool increments = FindLine(lines, "form") != nullptr;
  if (!increments) {
    for (const KeyLine& line : UsualLines(kind, sigmas)) add(line);
  }
  if (kind.magnetic && FindLine(draft_.imu->lines, "axes") == nullptr) {
    add({"axes", "[x, y, z]"});
  }
  for (const SensorKey& key : kind.keys) {
    if (key.applies != nullptr && !key.applies(settings)) continue;
    const bool unstated = key.name == "sigma" && !sigmas && !own_sigma &&
                          FindLine(lines, "noise") == nullptr;
    if (unstated || (key.needed != nullptr && key.needed(settings))) {
      add({std::string(key.name), UsualValue(key), "usual (a guess)"});
    }
  }
}

[[noreturn]] void FailWithoutImu(const std::string& folder,
                                 const RecordingFiles& rest) {
  std::string found;
  const auto name = [&](const std::string& what) {
    constexpr std::size_t kMost = 160;
    if (found.size() > kMost) return;
    found += (found.empty() ? "" : ", ") + what;
  };
  for (const Found& other : rest.others) {
    const std::string kind = other.truth || other.pose ? "a reference"
                             : other.kinds.empty()
                                 ? "a stream"
                                 : std::string(other.kinds.front()->name);
    name(other.file + " (" + kind + ")");
  }
  for (const std::string& file : rest.unknown) name(file);
  throw InputError(folder, 0,
                   found.empty() ? "holds no files; expected an IMU's"
                                 : "no IMU was recognised among " + found +
                                       "; expected columns of three gyros and "
                                       "three accelerometers: name them under "
                                       "`imu` with `format: columns`");
}

}  // namespace

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
