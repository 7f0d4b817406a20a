#include <yaml-cpp/yaml.h>

#include "io/config/config.h"
#include "io/config/config_map.h"
#include "io/write/atomic_file.h"

namespace hindsight {

std::string EmitYaml(const YAML::Node& node) {
  YAML::Emitter emitter;
  emitter << node;
  return std::string(emitter.c_str()) + "\n";
}

void SetWithholdings(const std::vector<Withholding>& withholdings,
                     ResolvedConfig* resolved) {
  YAML::Node top = YAML::Load(resolved->yaml);
  YAML::Node list(YAML::NodeType::Sequence);
  for (const Withholding& withholding : withholdings) {
    YAML::Node entry;
    entry["sensor"] = withholding.sensor;
    entry["every"] = FormatNumber(withholding.every) + " s";
    entry["length"] = FormatNumber(withholding.length) + " s";
    if (withholding.from) {
      entry["from"] = FormatNumber(*withholding.from) + " s";
    }
    list.push_back(entry);
  }
  top["withhold"] = list;
  resolved->yaml = EmitYaml(top);
}

void WriteResolvedConfig(const ResolvedConfig& resolved,
                         const std::string& path) {
  WriteFileAtomically(
      path,
      "# What was used, in SI units, defaults included.\n" + resolved.yaml);
}

}  // namespace hindsight
