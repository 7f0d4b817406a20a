#include "io/config/config_key.h"
#include "io/config/config_streams.h"
#include "io/read/paths.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

/// Beside the configuration unless it is absolute.
void ReadFrom(ConfigMap* map, ConstantsConfig* constants) {
  if (!constants->from.empty()) return;
  const fs::path from = map->Text("from");
  constants->from = fs::path(map->file()).parent_path() / from;
  if (PathExists(constants->from)) return;
  map->Fail("from", "there is no " +
                        constants->from.lexically_normal().string() +
                        "; expected the folder or the summary.json of an "
                        "earlier result");
}

const ConfigTable<ConstantsConfig>& ConstantsTable() {
  using Key = ConfigKey<ConstantsConfig>;
  static const ConfigTable<ConstantsConfig> kTable = {
      "constants",
      "What earlier recordings say of scales, mountings, lever arms, time "
      "offsets and offsets becomes a priori value and covariance, in place of "
      "those under `estimate`, by the names in the result's summary.json. "
      "Biases of the IMU, errors over the ground and time offsets of streams "
      "whose clock is the recording's own (time_offset: unknown; stamps that "
      "`time: {rate}` or `{start}` places) are not carried.",
      {{.name = "from",
        .value = Key::Special{ReadFrom},
        .help = "folder or summary.json of a result of `run` or `combine`, "
                "relative to the configuration; --constants replaces it",
        .needed = true},
       {.name = "method",
        .value = Key::Special{[](ConfigMap* map, ConstantsConfig* constants) {
          constants->method = map->OptionalText("method").value_or("");
        }},
        .help = "whose constants",
        .fallback = "the best"},
       {.name = "without",
        .value = Key::Special{[](ConfigMap* map, ConstantsConfig* constants) {
          if (map->Has("without")) constants->without = map->List("without");
        }},
        .help = "list of constants that are not taken, by name"}}};
  return kTable;
}

}  // namespace

ConstantsConfig ReadConstantsConfig(ConfigMap* top, const std::string& from) {
  ConstantsConfig constants;
  constants.from = from;
  if (!top->Has("constants")) return constants;
  ConfigMap map = top->Map("constants");
  if (!from.empty() && map.Has("from")) map.Text("from");
  ReadTable(ConstantsTable(), &map, &constants);
  map.Finish();
  return constants;
}

KeySection ConstantsSection() { return Documented(ConstantsTable()); }

}  // namespace hindsight
