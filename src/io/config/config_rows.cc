#include "io/config/config_key.h"
#include "io/config/config_streams.h"

namespace hindsight {
namespace {

const ConfigTable<RowWord>& RowsTable() {
  using Key = ConfigKey<RowWord>;
  static const ConfigTable<RowWord> kTable = {
      "rows",
      "Of a stream whose lines stand between those of others.",
      {{.name = "column",
        .value = Key::Special{[](ConfigMap* map, RowWord* rows) {
          rows->column = map->Integer("column", 1) - 1;
          if (rows->column < 0) map->Fail("column", "expected 1 or more");
        }},
        .help = "the column of the word, from 1",
        .fallback = "1"},
       {.name = "word",
        .value = Key::Special{[](ConfigMap* map, RowWord* rows) {
          rows->word = map->Text("word");
        }},
        .help = "lines that have it are the stream's, all others are not",
        .needed = true},
       {.name = "device_column",
        .value = Key::Special{[](ConfigMap* map, RowWord* rows) {
          if (map->Has("device_column") != map->Has("device")) {
            map->Fail(map->Has("device") ? "device" : "device_column",
                      "expected `device_column` and `device` together");
          }
          rows->device_column = map->Integer("device_column", 0) - 1;
          if (map->Has("device_column") && rows->device_column < 0) {
            map->Fail("device_column", "expected 1 or more");
          }
        }},
        .help = "a column that counts devices of the kind, from 1",
        .fallback = "none"},
       {.name = "device",
        .value = Key::Special{[](ConfigMap* map, RowWord* rows) {
          rows->device = map->Text("device", "");
        }},
        .help = "what stands there in the lines of the device",
        .fallback = "none"}}};
  return kTable;
}

}  // namespace

RowWord ReadRowWord(ConfigMap* map) {
  RowWord rows;
  ReadTable(RowsTable(), map, &rows);
  return rows;
}

KeySection RowsSection() { return Documented(RowsTable()); }

}  // namespace hindsight
