#ifndef HINDSIGHT_IO_CONFIG_SCENARIO_TEXTS_H_
#define HINDSIGHT_IO_CONFIG_SCENARIO_TEXTS_H_

#include <string_view>
#include <vector>

namespace hindsight {

/// A file of data/scenarios or data/faults, built into the program by
/// cmake/EmbedAssets.cmake.
struct ScenarioText {
  std::string_view name;  ///< "corners.yaml"
  std::string_view text;
};

const std::vector<ScenarioText>& ScenarioTexts();
/// Of data/faults.
const std::vector<ScenarioText>& FaultCaseTexts();

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_SCENARIO_TEXTS_H_
