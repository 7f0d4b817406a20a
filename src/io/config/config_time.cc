#include <string>

#include "io/config/config_key.h"
#include "io/config/config_streams.h"
#include "io/read/date_text.h"
#include "io/read/file_format.h"

namespace hindsight {
namespace {

void ReadStart(ConfigMap* time, ClockMap* clock) {
  const auto text = time->OptionalText("start");
  if (!text) return;
  clock->start_date = ParseDateTime(*text);
  if (clock->start_date) return;
  if (text->find("GPST") != text->npos || text->find("UTC") != text->npos) {
    time->Fail("start", "'" + *text +
                            "' is not a date; expected yyyy-mm-dd hh:mm:ss.sss "
                            "GPST or UTC");
  }
  clock->start = time->Number("start", Quantity::kTime);
}

void ReadSpan(ConfigMap* time, ClockMap* clock) {
  if (const auto from = time->OptionalNumber("from", Quantity::kTime)) {
    clock->from = *from;
  }
  if (const auto until = time->OptionalNumber("until", Quantity::kTime)) {
    clock->until = *until;
  }
  if (!(clock->until > clock->from)) {
    time->Fail("until", "must lie behind from");
  }
}

/// With what decides its defaults.
struct ClockConfig : ClockMap {
  bool counts_from_1970 = false;
};

void ReadStretch(ConfigMap* time, ClockConfig* clock) {
  const std::string stretch = time->Text("stretch", "1");
  const auto factor = ParseNumber(stretch);
  if (!factor || !(*factor > 0.0)) {
    time->Fail("stretch", "'" + stretch + "' is not a positive number");
  }
  clock->stretch = *factor;
}

const ConfigTable<ClockConfig>& TimeTable() {
  using Key = ConfigKey<ClockConfig>;
  static const ConfigTable<ClockConfig> kTable = {
      "time",
      "Of a stream.",
      {{.name = "clock",
        .value = Key::Special{[](ConfigMap* time, ClockConfig* clock) {
          clock->scale = static_cast<ClockMap::Scale>(
              time->Choice("clock", {"dataset", "gps", "unix"},
                           clock->counts_from_1970 ? 2 : 0));
        }},
        .help = "dataset, gps, unix: what stamps count from"},
       {.name = "week",
        .value = Key::Special{[](ConfigMap* time, ClockConfig* clock) {
          if (!time->Has("week")) return;
          clock->week = time->Integer("week", 0);
          if (*clock->week > kLastWeek) time->Fail("week", "is no GPS week");
        }},
        .help = "stamps are seconds of this GPS week, and may run over its "
                "end"},
       {.name = "start",
        .value = Key::Special{[](ConfigMap* time, ClockConfig* clock) {
          ReadStart(time, clock);
        }},
        .help = "first row is at this date or time; the rest follows"},
       {.name = "duration",
        .quantity = Quantity::kTime,
        .value =
            Key::OptionalNumber{&ClockConfig::duration, KeyRange::kPositive},
        .help = "last row is this much later; stamps in between are stretched"},
       {.name = "rate",
        .quantity = Quantity::kFrequency,
        .value = Key::OptionalNumber{&ClockConfig::rate, KeyRange::kPositive},
        .help = "stamps are row number / rate"},
       {.name = "stretch",
        .value = Key::Special{ReadStretch},
        .help = "factor on the time since the first row",
        .fallback = "1"},
       {.name = "week_rollovers",
        .value = Key::Special{[](ConfigMap* time, ClockConfig* clock) {
          clock->week_rollovers = time->Integer("week_rollovers", 0);
          if (clock->week_rollovers > 10) {
            time->Fail("week_rollovers", "is too many; expected 1 or 2");
          }
        }},
        .help = "times 1024 weeks that dates lack",
        .fallback = "0"},
       {.name = "from",
        .value = Key::Special{[](ConfigMap* time, ClockConfig* clock) {
          ReadSpan(time, clock);
        }},
        .help = "only rows this much behind the first are used"},
       {.name = "until", .value = Key::Special{}, .help = "the same"}}};
  return kTable;
}

}  // namespace

ClockMap ReadClock(ConfigMap* map, const FileFormat& format) {
  ClockConfig clock;
  clock.counts_from_1970 = format.counts_from_1970;
  ConfigMap time = map->Map("time");
  ReadTable(TimeTable(), &time, &clock);
  if (clock.week && clock.scale != ClockMap::Scale::kDataset) {
    time.Fail("week", "does not go with clock");
  }
  time.Finish();
  return clock;
}

KeySection TimeSection() { return Documented(TimeTable()); }

}  // namespace hindsight
