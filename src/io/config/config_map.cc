#include "io/config/config_map.h"

#include <yaml-cpp/depthguard.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "base/error.h"
#include "io/read/text_lines.h"

namespace hindsight {
namespace {

std::string Join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

bool IsPlainName(const std::string& name) {
  return !name.empty() && name.find_first_not_of(
                              "abcdefghijklmnopqrstuvwxyz"
                              "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                              "0123456789_-.") == name.npos;
}

/// A message is one line, whatever it quotes.
std::string Printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

long LineOf(const YAML::Node& node) { return node.Mark().line + 1L; }

constexpr std::size_t kLongestText = std::size_t{4} << 20;

std::string ReadText(const std::string& path) {
  TextLines lines(path);
  std::string text;
  std::string_view line;
  while (lines.Next(&line)) {
    text.append(line).push_back('\n');
    if (text.size() > kLongestText) {
      throw InputError(path, 0,
                       "is longer than 4 MB; expected a configuration");
    }
  }
  return text;
}

/// What usually is the matter with a map or list in one line.
std::string FlowAdvice(const std::string& message) {
  if (message.find("flow") == message.npos) return "";
  return "; a value with [ ] inside of { } stands in quotes: {t: \"1 [s]\"}";
}

std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (const char letter : a) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (letter == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string NearestWord(std::string_view word,
                        const std::vector<std::string>& candidates) {
  std::string nearest;
  std::size_t distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t d = EditDistance(word, candidate);
    if (d < distance) {
      distance = d;
      nearest = candidate;
    }
  }
  return nearest;
}

ConfigMap ConfigMap::Load(const std::string& path, const Edit& edit) {
  return Parse(ReadText(path), path, edit);
}

ConfigMap ConfigMap::Parse(const std::string& text, const std::string& path,
                           const Edit& edit) {
  YAML::Node node;
  try {
    node = YAML::Load(text);
  } catch (const YAML::DeepRecursion&) {
    // Its mark is where the parser has looked ahead to.
    throw InputError(path, 0, "is nested too deep");
  } catch (const YAML::ParserException& error) {
    throw InputError(path, error.mark.line + 1L,
                     "is not valid YAML: " + error.msg + FlowAdvice(error.msg));
  }
  if (!node.IsMap()) {
    throw InputError(path, 1, "expected keys and values at the top level");
  }
  if (edit) edit(&node);
  return ConfigMap(node, path, "", 1, YAML::Node(YAML::NodeType::Map));
}

ConfigMap::ConfigMap(const YAML::Node& node, std::string file, std::string name,
                     long line, const YAML::Node& resolved)
    : node_(node),
      file_(std::move(file)),
      name_(std::move(name)),
      line_(line),
      resolved_(resolved) {
  if (!node_.IsMap()) return;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) {
      throw InputError(file_, LineOf(entry.first), "a key must be a word");
    }
    const std::string key = entry.first.Scalar();
    const auto same = [&](const auto& other) { return other.first == key; };
    if (std::any_of(entries_.begin(), entries_.end(), same)) {
      throw InputError(file_, LineOf(entry.first),
                       "key '" + Path(key) + "' stands twice");
    }
    entries_.emplace_back(key, entry.second);
    key_lines_.push_back(LineOf(entry.first));
  }
}

std::string ConfigMap::Path(const std::string& key) const {
  return name_.empty() ? key : name_ + "." + key;
}

long ConfigMap::Line(const std::string& key) const {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].first == key) return key_lines_[i];
  }
  return line_;
}

void ConfigMap::Fail(const std::string& key, const std::string& message) const {
  throw InputError(file_, Line(key), Path(key) + ": " + message);
}

std::optional<YAML::Node> ConfigMap::Find(const std::string& key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) {
    asked_.push_back(key);
  }
  for (const auto& [name, node] : entries_) {
    if (name != key) continue;
    if (node.IsNull()) Fail(key, "has no value");
    return node;
  }
  return std::nullopt;
}

bool ConfigMap::Has(const std::string& key) { return Find(key).has_value(); }

bool ConfigMap::IsMap(const std::string& key) {
  const auto node = Find(key);
  return node && node->IsMap();
}

bool ConfigMap::IsScalar(const std::string& key) {
  const auto node = Find(key);
  return node && node->IsScalar();
}

bool ConfigMap::Is(const std::string& key, const std::string& word) {
  if (!IsScalar(key) || ScalarText(key, *Find(key)) != word) return false;
  Resolve(key, word);
  return true;
}

std::vector<std::string> ConfigMap::Keys() const {
  std::vector<std::string> keys;
  for (const auto& entry : entries_) keys.push_back(entry.first);
  return keys;
}

std::string ConfigMap::ScalarText(const std::string& key,
                                  const YAML::Node& node) const {
  if (!node.IsScalar()) Fail(key, "expected one value");
  return node.Scalar();
}

std::vector<double> ConfigMap::Values(const std::string& key,
                                      const YAML::Node& node,
                                      Quantity quantity) const {
  std::string text;
  if (node.IsSequence()) {
    for (const auto& item : node) {
      text += (text.empty() ? "" : ", ") + ScalarText(key, item);
    }
  } else {
    text = ScalarText(key, node);
  }
  try {
    return ParseQuantities(text, quantity);
  } catch (const std::invalid_argument& error) {
    Fail(key, error.what());
  }
}

std::optional<double> ConfigMap::OptionalNumber(const std::string& key,
                                                Quantity quantity) {
  const auto node = Find(key);
  if (!node) return std::nullopt;
  const std::vector<double> values = Values(key, *node, quantity);
  if (values.size() != 1) Fail(key, "expected one value");
  Resolve(key, values[0], quantity);
  return values[0];
}

double ConfigMap::Number(const std::string& key, Quantity quantity) {
  const auto value = OptionalNumber(key, quantity);
  if (!value) {
    Fail(key, std::string("is missing; expected a value in one of ") +
                  UnitExamples(quantity));
  }
  return *value;
}

double ConfigMap::Number(const std::string& key, Quantity quantity,
                         double fallback) {
  const auto value = OptionalNumber(key, quantity);
  if (!value) Resolve(key, fallback, quantity);
  return value.value_or(fallback);
}

double ConfigMap::Positive(const std::string& key, Quantity quantity) {
  const double value = Number(key, quantity);
  if (!(value > 0.0)) Fail(key, "must be greater than zero");
  return value;
}

double ConfigMap::Positive(const std::string& key, Quantity quantity,
                           double fallback) {
  const double value = Number(key, quantity, fallback);
  if (!(value > 0.0)) Fail(key, "must be greater than zero");
  return value;
}

std::vector<double> ConfigMap::Numbers(const std::string& key,
                                       Quantity quantity) {
  const auto node = Find(key);
  return node ? Values(key, *node, quantity) : std::vector<double>();
}

std::optional<Eigen::Vector3d> ConfigMap::OptionalVector(const std::string& key,
                                                         Quantity quantity,
                                                         bool isotropic) {
  const auto node = Find(key);
  if (!node) return std::nullopt;
  std::vector<double> values = Values(key, *node, quantity);
  if (isotropic && values.size() == 1) values.assign(3, values[0]);
  if (values.size() != 3) {
    Fail(key, "expected three values, found " + std::to_string(values.size()));
  }
  const Eigen::Vector3d vector(values[0], values[1], values[2]);
  YAML::Node list(YAML::NodeType::Sequence);
  list.SetStyle(YAML::EmitterStyle::Flow);
  for (const double value : values) {
    list.push_back(FormatNumber(value) + " " + SiUnit(quantity));
  }
  resolved_[key] = list;
  return vector;
}

Eigen::Vector3d ConfigMap::Vector(const std::string& key, Quantity quantity,
                                  const Eigen::Vector3d& fallback) {
  const auto vector = OptionalVector(key, quantity);
  if (vector) return *vector;
  YAML::Node list(YAML::NodeType::Sequence);
  list.SetStyle(YAML::EmitterStyle::Flow);
  for (const double value : fallback) {
    list.push_back(FormatNumber(value) + " " + SiUnit(quantity));
  }
  resolved_[key] = list;
  return fallback;
}

std::optional<Eigen::Vector3d> ConfigMap::OptionalSigma(const std::string& key,
                                                        Quantity quantity) {
  const auto sigma = OptionalVector(key, quantity, true);
  if (sigma && !(sigma->minCoeff() > 0.0)) {
    Fail(key, "standard deviations must be greater than zero");
  }
  return sigma;
}

std::optional<std::string> ConfigMap::OptionalText(const std::string& key) {
  const auto node = Find(key);
  if (!node) return std::nullopt;
  const std::string text = ScalarText(key, *node);
  Resolve(key, text);
  return text;
}

std::string ConfigMap::Text(const std::string& key) {
  const auto text = OptionalText(key);
  if (!text) Fail(key, "is missing");
  return *text;
}

std::string ConfigMap::Text(const std::string& key,
                            const std::string& fallback) {
  const auto text = OptionalText(key);
  if (!text) Resolve(key, fallback);
  return text.value_or(fallback);
}

std::size_t ConfigMap::Choice(const std::string& key,
                              const std::vector<std::string>& choices,
                              std::optional<std::size_t> fallback) {
  const auto text = OptionalText(key);
  if (!text) {
    if (!fallback) Fail(key, "is missing; expected one of " + Join(choices));
    Resolve(key, choices[*fallback]);
    return *fallback;
  }
  const auto found = std::find(choices.begin(), choices.end(), *text);
  if (found == choices.end()) {
    Fail(key, "'" + *text + "' is not known; expected one of " + Join(choices));
  }
  return static_cast<std::size_t>(found - choices.begin());
}

bool ConfigMap::Flag(const std::string& key, bool fallback) {
  return Choice(key, {"false", "true"}, fallback ? 1 : 0) == 1;
}

int ConfigMap::Integer(const std::string& key, int fallback) {
  const auto text = OptionalText(key);
  if (!text) {
    Resolve(key, std::to_string(fallback));
    return fallback;
  }
  const auto number = ParseNumber(*text);
  if (!number || *number != std::floor(*number) || *number < 0.0 ||
      *number > 1e9) {
    Fail(key, "'" + *text + "' is not a whole number");
  }
  return static_cast<int>(*number);
}

std::vector<std::string> ConfigMap::List(const std::string& key) {
  const auto node = Find(key);
  std::vector<std::string> items;
  if (!node) return items;
  if (!node->IsSequence()) Fail(key, "expected a list in [ ]");
  YAML::Node list(YAML::NodeType::Sequence);
  list.SetStyle(YAML::EmitterStyle::Flow);
  for (const auto& item : *node) {
    items.push_back(ScalarText(key, item));
    list.push_back(items.back());
  }
  resolved_[key] = list;
  return items;
}

ConfigMap ConfigMap::Map(const std::string& key) {
  const auto node = Find(key);
  if (node && !node->IsMap()) Fail(key, "expected keys and values below it");
  YAML::Node copy(YAML::NodeType::Map);
  resolved_[key] = copy;
  return ConfigMap(node.value_or(YAML::Node(YAML::NodeType::Map)), file_,
                   Path(key), Line(key), copy);
}

ConfigMap ConfigMap::Defaults(const std::string& key) {
  YAML::Node copy(YAML::NodeType::Map);
  resolved_[key] = copy;
  return ConfigMap(YAML::Node(YAML::NodeType::Map), file_, Path(key), Line(key),
                   copy);
}

std::vector<ConfigMap> ConfigMap::Maps(const std::string& key) {
  const auto node = Find(key);
  std::vector<ConfigMap> maps;
  YAML::Node copies(YAML::NodeType::Sequence);
  if (node && !node->IsSequence()) Fail(key, "expected a list, with '- '");
  // Linked before it is filled: a node that joins a tree later leaves the
  // memory of its own children behind.
  resolved_[key] = copies;
  if (node) {
    for (const auto& item : *node) {
      if (!item.IsMap()) Fail(key, "expected keys and values in the list");
      YAML::Node copy(YAML::NodeType::Map);
      copies.push_back(copy);
      maps.push_back(ConfigMap(item, file_, Path(key), LineOf(item), copy));
    }
  }
  return maps;
}

std::vector<std::pair<std::string, ConfigMap>> ConfigMap::NamedMaps() {
  std::vector<std::pair<std::string, ConfigMap>> maps;
  for (const std::string& key : Keys()) {
    if (!IsPlainName(key)) {
      throw InputError(file_, Line(key),
                       Path(Printable(key)) +
                           ": is no name; expected letters, digits, '_', '-' "
                           "and '.'");
    }
    maps.emplace_back(key, Map(key));
  }
  return maps;
}

void ConfigMap::Finish() const {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const std::string& key = entries_[i].first;
    if (std::find(asked_.begin(), asked_.end(), key) != asked_.end()) continue;
    const std::string nearest = NearestWord(key, asked_);
    throw InputError(file_, key_lines_[i],
                     "unknown key '" + Path(key) + "'; expected " +
                         (nearest.empty() ? "one of " + Join(asked_)
                                          : "perhaps '" + nearest + "'"));
  }
}

void ConfigMap::Resolve(const std::string& key, const std::string& value) {
  resolved_[key] = value;
}

void ConfigMap::Resolve(const std::string& key, double value,
                        Quantity quantity) {
  resolved_[key] = FormatNumber(value) + " " + SiUnit(quantity);
}

}  // namespace hindsight
