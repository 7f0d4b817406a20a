#ifndef HINDSIGHT_IO_CONFIG_CONFIG_MAP_H_
#define HINDSIGHT_IO_CONFIG_CONFIG_MAP_H_

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/read/units.h"

namespace hindsight {

/// One map of a YAML file, read key by key. Every value asked for is checked,
/// brought to SI, and written into a resolved copy, defaults included; keys
/// nobody asked for are errors. All errors are InputError
/// "file:line: key: ...".
// What it holds of YAML is not declared noexcept.
// NOLINTNEXTLINE(bugprone-exception-escape)
class ConfigMap {
 public:
  /// What is done to the top level before it is read; throws InputError.
  using Edit = std::function<void(YAML::Node* top)>;
  /// Reads a YAML file whose top level is a map.
  static ConfigMap Load(const std::string& path, const Edit& edit = {});
  /// The same of a text; errors name it as `path`.
  static ConfigMap Parse(const std::string& text, const std::string& path,
                         const Edit& edit = {});

  bool Has(const std::string& key);

  double Number(const std::string& key, Quantity quantity);
  double Number(const std::string& key, Quantity quantity, double fallback);
  std::optional<double> OptionalNumber(const std::string& key,
                                       Quantity quantity);
  /// As Number, and greater than zero.
  double Positive(const std::string& key, Quantity quantity);
  double Positive(const std::string& key, Quantity quantity, double fallback);

  /// Any number of values, the last of which may carry the unit of all; nothing
  /// if absent.
  std::vector<double> Numbers(const std::string& key, Quantity quantity);
  /// Three values; `isotropic` lets one value stand for all.
  std::optional<Eigen::Vector3d> OptionalVector(const std::string& key,
                                                Quantity quantity,
                                                bool isotropic = false);
  Eigen::Vector3d Vector(const std::string& key, Quantity quantity,
                         const Eigen::Vector3d& fallback);
  /// Three standard deviations, or one for all; each greater than zero.
  std::optional<Eigen::Vector3d> OptionalSigma(const std::string& key,
                                               Quantity quantity);

  std::string Text(const std::string& key);
  std::string Text(const std::string& key, const std::string& fallback);
  std::optional<std::string> OptionalText(const std::string& key);
  /// Index of the value among `choices`; on, true, yes and off, false, no are
  /// the same, as in YAML 1.1.
  std::size_t Choice(const std::string& key,
                     const std::vector<std::string>& choices,
                     std::optional<std::size_t> fallback);
  bool Flag(const std::string& key, bool fallback);
  int Integer(const std::string& key, int fallback);
  std::vector<std::string> List(const std::string& key);

  /// The map under `key`; if it is absent, an empty one at this map's line.
  ConfigMap Map(const std::string& key);
  /// An empty map under `key`, whatever the file says there: all defaults.
  ConfigMap Defaults(const std::string& key);
  /// The maps of the list under `key`; nothing if absent.
  std::vector<ConfigMap> Maps(const std::string& key);
  /// The maps under free names, in the file's order. Names stand in file names
  /// and CSV fields: letters, digits, '_', '-' and '.'.
  std::vector<std::pair<std::string, ConfigMap>> NamedMaps();

  /// True if the value of `key` is a map rather than a scalar or a list.
  bool IsMap(const std::string& key);
  /// True if the value of `key` is a single word or number.
  bool IsScalar(const std::string& key);
  /// True if the value of `key` is that word; it then counts as read.
  bool Is(const std::string& key, const std::string& word);

  /// Keys of this map in the file's order.
  std::vector<std::string> Keys() const;

  /// Throws for keys that were never asked for, suggesting the nearest that
  /// were.
  void Finish() const;

  [[noreturn]] void Fail(const std::string& key,
                         const std::string& message) const;

  const std::string& file() const { return file_; }
  /// Line of the map, or of the key in it.
  long line() const { return line_; }
  long Line(const std::string& key) const;
  /// "aiding.gnss"; empty at the top.
  const std::string& name() const { return name_; }
  /// The resolved copy, a map in the order of reading.
  YAML::Node resolved() const { return resolved_; }
  /// Writes a value into the resolved copy.
  void Resolve(const std::string& key, const std::string& value);
  void Resolve(const std::string& key, double value, Quantity quantity);
  void Resolve(const std::string& key, const std::vector<std::string>& values);

 private:
  ConfigMap(const YAML::Node& node, std::string file, std::string name,
            long line, const YAML::Node& resolved);
  std::optional<YAML::Node> Find(const std::string& key);
  std::string ScalarText(const std::string& key, const YAML::Node& node) const;
  std::vector<double> Values(const std::string& key, const YAML::Node& node,
                             Quantity quantity) const;
  std::string Path(const std::string& key) const;

  YAML::Node node_;
  std::string file_;
  std::string name_;
  long line_ = 0;
  std::vector<std::pair<std::string, YAML::Node>> entries_;
  std::vector<long> key_lines_;
  std::vector<std::string> asked_;
  YAML::Node resolved_;
};

/// The node as YAML text with a line end at its end.
std::string EmitYaml(const YAML::Node& node);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_CONFIG_MAP_H_
