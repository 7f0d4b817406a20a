#include "io/config/config_map.h"

#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "base/error.h"
#include "base/nearest_word.h"
#include "io/read/paths.h"
#include "io/read/text_lines.h"

namespace hindsight {
namespace {

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
  if (IsFolder(path)) {
    throw InputError(path, 0,
                     "is a folder; expected a configuration: 'hindsight init " +
                         path +
                         " --out=CONFIG' drafts one, and 'hindsight run " +
                         path + " --out=DIR' does all in one go");
  }
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

/// Hears only where documents begin.
class DocumentStarts : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override {
    line_ = mark.line + 1L;
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

  /// Of the last one.
  long line() const { return line_; }

 private:
  long line_ = 0;
};

/// YAML::LoadAll() does not end where the parser is left with a token that
/// begins nothing (",+"): it hears of one empty document after the other.
void ExpectOneDocument(const std::string& text, const std::string& path) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentStarts starts;
  if (!parser.HandleNextDocument(starts)) return;
  if (parser.HandleNextDocument(starts)) {
    throw InputError(
        path, starts.line(),
        "a second YAML document begins behind `---`; expected one");
  }
}

}  // namespace

ConfigMap ConfigMap::Load(const std::string& path, const Edit& edit) {
  return Parse(ReadText(path), path, edit);
}

ConfigMap ConfigMap::Parse(const std::string& text, const std::string& path,
                           const Edit& edit) {
  YAML::Node node;
  try {
    node = YAML::Load(text);
    if (node.IsMap()) ExpectOneDocument(text, path);
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
    throw InputError(
        file_, key_lines_[i],
        "unknown key '" + Path(key) + "'; expected " +
            (nearest.empty()
                 ? "one of " + fmt::format("{}", fmt::join(asked_, ", "))
                 : "perhaps '" + nearest + "'"));
  }
}

void ConfigMap::Resolve(const std::string& key, const std::string& value) {
  resolved_[key] = value;
}

void ConfigMap::Resolve(const std::string& key,
                        const std::vector<std::string>& values) {
  YAML::Node list(YAML::NodeType::Sequence);
  list.SetStyle(YAML::EmitterStyle::Flow);
  for (const std::string& value : values) list.push_back(value);
  resolved_[key] = list;
}

void ConfigMap::Resolve(const std::string& key, double value,
                        Quantity quantity) {
  resolved_[key] = FormatNumber(value) + " " + SiUnit(quantity);
}

}  // namespace hindsight
