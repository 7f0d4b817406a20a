#include "io/config/scenario_choices.h"

#include <algorithm>
#include <utility>

#include "base/error.h"

namespace hindsight {
namespace {

/// The keys of a map, in the file's order.
std::vector<std::string> KeysOf(const YAML::Node& map) {
  std::vector<std::string> keys;
  for (const auto& entry : map) {
    if (entry.first.IsScalar()) keys.push_back(entry.first.Scalar());
  }
  return keys;
}

/// Null takes the key away.
void Put(const std::string& key, const YAML::Node& value, YAML::Node map) {
  if (value.IsNull()) {
    map.remove(key);
  } else {
    map[key] = YAML::Clone(value);
  }
}

/// Lays a map over another.
void Merge(const YAML::Node& from, YAML::Node to) {
  for (const std::string& key : KeysOf(from)) {
    const YAML::Node& there = std::as_const(to)[key];
    if (from[key].IsMap() && there && there.IsMap()) {
      Merge(from[key], to[key]);
    } else {
      Put(key, from[key], to);
    }
  }
}

/// The value stays text: to assign a YAML::Node is to change what it names.
struct Change {
  std::string text;
  std::string key;

  YAML::Node Value() const { return YAML::Load(text.substr(key.size() + 1)); }
};

Change ParseChange(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == text.npos) {
    throw InputError("'" + text + "': expected KEY=VALUE");
  }
  try {
    Change change = {text, text.substr(0, equals)};
    change.Value();
    return change;
  } catch (const YAML::Exception& error) {
    throw InputError("'" + text + "': is not valid YAML: " + error.msg);
  }
}

/// Sets what the rest of the path from `begin` on leads to.
void Set(const Change& change, std::size_t begin, YAML::Node map) {
  if (!map.IsMap()) {
    throw InputError(
        "'" + change.text + "': '" +
        change.key.substr(0, begin - std::min<std::size_t>(begin, 1)) +
        "' holds no keys");
  }
  const std::size_t end =
      std::min(change.key.find('.', begin), change.key.size());
  std::vector<std::string> keys = {change.key.substr(begin, end - begin)};
  if (keys[0] == "*") keys = KeysOf(map);
  for (const std::string& key : keys) {
    if (end == change.key.size()) {
      Put(key, change.Value(), map);
      continue;
    }
    if (!std::as_const(map)[key]) map[key] = YAML::Node(YAML::NodeType::Map);
    Set(change, end + 1, map[key]);
  }
}

/// The name that is chosen of a group: the last that a change names, which is
/// taken from `changes`, or the file's, or the first.
std::string ChosenName(const std::string& group,
                       const std::vector<std::string>& names,
                       std::vector<Change>* changes, YAML::Node* top) {
  std::string chosen = names.front();
  const auto choose = [&](const YAML::Node& name) {
    if (name && name.IsScalar()) chosen = name.Scalar();
    if (std::find(names.begin(), names.end(), chosen) != names.end()) return;
    std::string known;
    for (const std::string& one : names) {
      known += (known.empty() ? "" : ", ") + one;
    }
    throw InputError(group + ": '" + chosen +
                     "' is not known; expected one of " + known);
  };
  choose(std::as_const(*top)[group]);
  top->remove(group);
  for (const Change& change : *changes) {
    if (change.key == group) choose(change.Value());
  }
  std::erase_if(*changes, [&](const Change& c) { return c.key == group; });
  return chosen;
}

}  // namespace

void EditScenario(const std::vector<std::string>& changes, YAML::Node* top) {
  std::vector<Change> left;
  for (const std::string& text : changes) left.push_back(ParseChange(text));
  const YAML::Node choices = std::as_const(*top)["choices"];
  if (choices) top->remove("choices");
  for (const std::string& group : KeysOf(choices)) {
    const std::vector<std::string> names = KeysOf(choices[group]);
    if (names.empty()) {
      throw InputError("choices." + group + ": expected names and their keys");
    }
    Merge(choices[group][ChosenName(group, names, &left, top)], *top);
  }
  for (const Change& change : left) Set(change, 0, *top);
}

}  // namespace hindsight
