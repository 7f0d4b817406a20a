#ifndef HINDSIGHT_IO_CONFIG_CONFIG_HELP_H_
#define HINDSIGHT_IO_CONFIG_CONFIG_HELP_H_

#include <string>
#include <vector>

namespace hindsight {

/// A key of a configuration as it is documented.
struct KeyEntry {
  std::string name;
  std::string meaning;
  /// As it would be written; "needed", or "-" where absence has a meaning.
  std::string fallback;
  std::string when = {};  ///< under which other values the key stands
};

/// The keys of one map.
struct KeySection {
  /// "imu", "time"; "" is the top, "stream" what every file has, "aiding" what
  /// every aiding sensor has, "aiding: KIND" what a kind has besides.
  std::string name;
  std::string about;
  std::vector<KeyEntry> keys;
};

/// A format of files as it is documented.
struct FormatEntry {
  std::string name;
  std::string meaning;
  std::string streams;
  bool recognised = false;  ///< by `hindsight init`
};

/// In the order of FileFormats.
std::vector<FormatEntry> FormatEntries();

/// The formats for the terminal, and the rows of the documentation's table.
std::string FormatHelp();
std::string FormatMarkdown();

/// All of a recording's configuration; the sections of aiding sensors are those
/// of SensorKinds.
std::vector<KeySection> ConfigSections();

/// Of a scenario (scenario_config.h): "scenario" is the top.
std::vector<KeySection> ScenarioSections();

/// For the terminal: all sections, or those whose name or a key of which is
/// `word`; empty if there is none.
std::string ConfigHelp(const std::string& word);

/// The page of the documentation.
std::string ConfigMarkdown();

/// JSON Schema (2020-12) of a configuration, for editors.
std::string ConfigSchema();

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_CONFIG_HELP_H_
