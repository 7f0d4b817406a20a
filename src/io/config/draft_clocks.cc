#include "io/config/draft_clocks.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "io/read/file_format.h"
#include "io/read/paths.h"
#include "io/read/reader.h"
#include "io/read/rtklib_tag.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

fs::path PathOf(const RecordingDraft& draft, const FoundStream& found) {
  return fs::path(draft.folder) / found.file;
}

/// Whether its stamps are dates, or seconds since 1970.
bool IsDated(const FoundStream& found) {
  return found.stamps && found.stamps->scale != StampGuess::Scale::kOwn;
}

Stamp FirstOf(const StampGuess& dated) {
  const double whole = std::floor(dated.first);
  const Stamp since_1970 = {static_cast<std::int64_t>(whole),
                            dated.first - whole};
  const bool utc =
      dated.unit != "GPST" && dated.scale != StampGuess::Scale::kWeek;
  if (utc) return GpsFromUnix(since_1970);
  return Stamp{since_1970.seconds - kGpsEpochUnix, since_1970.fraction};
}

std::optional<Stamp> FirstDate(const fs::path& path, const FoundStream& found) {
  if (IsDated(found)) return FirstOf(*found.stamps);
  const FileFormat& kind = *found.format;
  if (!kind.dated && &kind != &CsvFormat()) return std::nullopt;
  TextFormat format;
  format.kind = found.format;
  try {
    const OpenedTable opened =
        OpenTable(path.string(), format, FieldsOf(found), {});
    if (!opened.dated || !opened.table->Next()) return std::nullopt;
    return opened.table->stamp();
  } catch (const InputError&) {
    return std::nullopt;  // which whoever loads it is told
  }
}

/// Whether its stamps count from an instant that nothing tells.
bool IsUndated(const RecordingDraft& draft, const FoundStream& found) {
  if (found.stamps) return !IsDated(found);
  return !found.format->counts_from_1970 && !found.format->whole_recordings &&
         !FirstDate(PathOf(draft, found), found);
}

/// "{rate: 100 Hz, start: 0 s}"; nothing to say: "".
void SetTime(std::string start, const std::string& duration,
             const std::string& comment, FoundStream* found) {
  if (start.empty() && found->stamps && found->stamps->starts) {
    start = IsDated(*found)
                ? FormatGpsTime(Nanoseconds(FirstOf(*found->stamps)))
                : fmt::format("{:.12g} s", found->stamps->first);
  }
  std::vector<std::string> parts;
  if (found->stamps && found->stamps->rate) {
    parts.push_back(fmt::format("rate: {:.12g} Hz", *found->stamps->rate));
  }
  if (!start.empty()) parts.push_back("start: " + start);
  if (!duration.empty()) parts.push_back("duration: " + duration);
  const bool unix_scale =
      found->stamps && found->stamps->scale == StampGuess::Scale::kUnix;
  if (unix_scale && start.empty()) parts.emplace_back("clock: unix");
  if (found->stamps && found->stamps->scale == StampGuess::Scale::kWeek &&
      start.empty()) {
    parts.push_back(fmt::format("week: {}", found->stamps->week));
  }
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

/// Whether a time tag tells a record's length better than the stamps within. It
/// says when bytes came, with what lay in buffers; they are of a quartz, unless
/// the two contradict each other.
bool TellsDuration(const RtklibTag& tag, const FoundStream& found) {
  constexpr double kLatency = 0.2;  // [s]
  constexpr double kQuartz = 1e-4;  // data sheets: 10 to 100 ppm
  if (!found.stamps) return false;  // a header says their unit
  const double by_quartz = kQuartz * tag.duration;
  return by_quartz > kLatency || std::abs(found.stamps->span - tag.duration) >
                                     3.0 * std::hypot(kLatency, by_quartz);
}

/// The stamps of the fixes are dates, those of the IMU are not.
void StartImuAt(const Stamp& first_fix, RecordingDraft* draft) {
  FoundStream* imu = &*draft->imu;
  fs::path beside = PathOf(*draft, *imu).string() + ".tag";
  // "imu.csv.gz" was logged as "imu.csv".
  if (!PathExists(beside) && PathOf(*draft, *imu).extension() == ".gz") {
    beside = PathOf(*draft, *imu).replace_extension("").string() + ".tag";
  }
  if (const auto found =
          PathExists(beside) ? ReadRtklibTag(beside.string()) : std::nullopt) {
    SetTime(FormatGpsTime(Nanoseconds(found->opened)),
            TellsDuration(*found, *imu)
                ? fmt::format("{:.3f} s", found->duration)
                : "",
            "by the time tag beside it", imu);
    return;
  }
  SetTime(FormatGpsTime(Nanoseconds(first_fix)), "",
          "as the first fix (a guess); the motion tells the rest", imu);
  draft->assumptions.emplace_back(
      "imu: its clock has no date; it begins with the first fix, and the "
      "motion tells the offset");
}

/// The IMU has dates: a stream that has none, or others, begins with it.
void StartWithImu(const Stamp& first, const std::string& name,
                  RecordingDraft* draft, FoundStream* found) {
  if (!found->stamps) return;
  const bool apart =
      IsDated(*found) && Overlap(*draft->imu->stamps, *found->stamps) < 0.5;
  if (IsDated(*found) && !apart) return;
  const std::string why =
      apart ? "its dates lie apart from the IMU's" : "its clock has no date";
  SetTime(FormatGpsTime(Nanoseconds(first)), "",
          why + ": it begins with the IMU (a guess)", found);
  draft->assumptions.push_back(name + ": " + why +
                               "; it begins with the IMU, and the motion tells "
                               "the offset");
}

/// Records whose stamps do not overlap begin together.
void BeginTogether(RecordingDraft* draft) {
  FoundStream* imu = &*draft->imu;
  if (IsDated(*imu)) {
    const Stamp first = *FirstDate(PathOf(*draft, *imu), *imu);
    for (StreamDraft& stream : draft->aiding) {
      StartWithImu(first, stream.name, draft, &stream.found);
    }
    if (draft->truth) StartWithImu(first, "truth", draft, &*draft->truth);
    SetTime("", "", "", imu);
    return;
  }
  const auto counts = [](const FoundStream& found) {
    return found.stamps->rate && !found.stamps->starts;
  };
  bool apart = counts(*imu);
  const auto look = [&](const FoundStream& found) {
    apart = apart ||
            (found.stamps &&
             (Overlap(*imu->stamps, *found.stamps) < 0.5 || counts(found)));
  };
  for (const StreamDraft& stream : draft->aiding) look(stream.found);
  if (draft->truth) look(*draft->truth);
  if (!apart) {
    SetTime("", "", "", imu);
    return;
  }
  const std::string why = "clocks that do not overlap begin together";
  SetTime("0 s", "", why, imu);
  for (StreamDraft& stream : draft->aiding) {
    if (stream.found.stamps) SetTime("0 s", "", "", &stream.found);
  }
  if (draft->truth && draft->truth->stamps) {
    SetTime("0 s", "", "", &*draft->truth);
  }
  if (!imu->stamps->rate) draft->assumptions.push_back(why);
}

/// Seconds of the week without the week, beside a stream that has both and overlaps.
void ShareWeek(RecordingDraft* draft) {
  std::vector<FoundStream*> all = {&*draft->imu};
  for (StreamDraft& stream : draft->aiding) all.push_back(&stream.found);
  if (draft->truth) all.push_back(&*draft->truth);
  const auto weekly =
      std::find_if(all.begin(), all.end(), [](const FoundStream* found) {
        return found->stamps &&
               found->stamps->scale == StampGuess::Scale::kWeek;
      });
  if (weekly == all.end()) return;
  for (FoundStream* found : all) {
    if (!found->stamps || IsDated(*found) || found->stamps->rate) continue;
    StampGuess shared = *found->stamps;
    shared.scale = StampGuess::Scale::kWeek;
    shared.week = (*weekly)->stamps->week;
    shared.first += static_cast<double>(
        kGpsEpochUnix + std::int64_t{shared.week} * kWeekSeconds);
    if (Overlap(shared, *(*weekly)->stamps) > 0.5) found->stamps = shared;
  }
}

}  // namespace

void SetDraftClocks(RecordingDraft* draft) {
  ShareWeek(draft);
  FoundStream& imu = *draft->imu;
  std::optional<Stamp> date;
  for (const StreamDraft& stream : draft->aiding) {
    if (!date) date = FirstDate(PathOf(*draft, stream.found), stream.found);
  }
  if (date && IsUndated(*draft, imu)) {
    StartImuAt(*date, draft);
  } else if (imu.stamps) {
    BeginTogether(draft);
  }
  for (StreamDraft& stream : draft->aiding) {
    if (FindLine(stream.found.lines, "time") == nullptr) {
      SetTime("", "", "", &stream.found);
    }
  }
  if (draft->truth && FindLine(draft->truth->lines, "time") == nullptr) {
    SetTime(draft->truth->stamps && draft->truth->stamps->rate ? "0 s" : "", "",
            "", &*draft->truth);
  }
  for (StreamDraft& stream : draft->unused) {
    SetTime("", "", "", &stream.found);
  }
}

}  // namespace hindsight
