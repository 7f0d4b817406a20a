#include "io/config/config_help.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace hindsight {
namespace {

using Json = nlohmann::ordered_json;

std::string Title(const KeySection& section) {
  return section.name.empty() ? "the configuration" : section.name;
}

bool Speaks(const KeySection& section, const std::string& word) {
  if (word.empty() || section.name == word ||
      section.name == "aiding: " + word) {
    return true;
  }
  return std::any_of(section.keys.begin(), section.keys.end(),
                     [&](const KeyEntry& key) { return key.name == word; });
}

/// Text in lines of up to `width`, each behind `indent`.
std::string Fold(const std::string& text, const std::string& indent,
                 std::size_t width) {
  std::string out;
  std::string line;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    begin = end + 1;
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      out += indent + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return line.empty() ? out : out + indent + line + "\n";
}

std::string Entry(const KeyEntry& key) {
  std::string head = "  " + key.name + "  (" + key.fallback;
  if (!key.when.empty()) head += "; with " + key.when;
  return head + ")\n" + Fold(key.meaning, "      ", 72);
}

/// In a cell of a table.
std::string Cell(std::string text) {
  for (std::size_t at = text.find('|'); at != text.npos;
       at = text.find('|', at + 2)) {
    text.replace(at, 1, "\\|");
  }
  return text;
}

Json SchemaOf(const KeyEntry& key) {
  Json json;
  std::string text = key.meaning;
  if (!key.when.empty()) text += " (with " + key.when + ")";
  json["description"] = text;
  if (key.fallback != "needed" && key.fallback != "-") {
    json["default"] = key.fallback;
  }
  return json;
}

void AddKeys(const KeySection& section, Json* object) {
  for (const KeyEntry& key : section.keys) {
    Json* map = object;
    std::string name = key.name;
    if (const std::size_t dot = name.find('.'); dot != name.npos) {
      map = &(*object)["properties"][name.substr(0, dot)];
      (*map)["type"] = "object";
      name = name.substr(dot + 1);
    }
    (*map)["properties"][name] = SchemaOf(key);
    auto& required = (*map)["required"];
    if (required.is_null()) required = Json::array();
    const bool listed =
        std::find(required.begin(), required.end(), name) != required.end();
    if (key.fallback == "needed" && key.when.empty() && !listed) {
      required.push_back(name);
    }
  }
}

const KeySection& Section(const std::vector<KeySection>& all,
                          const std::string& name) {
  return *std::find_if(all.begin(), all.end(), [&](const KeySection& section) {
    return section.name == name;
  });
}

Json Object(const std::vector<KeySection>& all,
            const std::vector<std::string>& names) {
  Json json;
  json["type"] = "object";
  json["additionalProperties"] = false;
  for (const std::string& name : names) AddKeys(Section(all, name), &json);
  return json;
}

std::vector<KeySection> AllSections() {
  std::vector<KeySection> all = ConfigSections();
  for (KeySection& section : ScenarioSections()) {
    all.push_back(std::move(section));
  }
  return all;
}

}  // namespace

std::string ConfigHelp(const std::string& word) {
  std::string text;
  for (const KeySection& section : AllSections()) {
    if (!Speaks(section, word)) continue;
    text += (text.empty() ? "" : "\n") + Title(section) + "\n" +
            Fold(section.about, "  ", 76);
    const bool whole = word.empty() || section.name == word ||
                       section.name == "aiding: " + word;
    for (const KeyEntry& key : section.keys) {
      if (whole || key.name == word) text += Entry(key);
    }
  }
  return text;
}

std::string FormatHelp() {
  std::string text =
      "What the `format` of a stream may be; init recognises those with *.\n";
  for (const FormatEntry& format : FormatEntries()) {
    text += "\n  " + format.name + (format.recognised ? " *" : "") + "  (" +
            format.streams + ")\n" + Fold(format.meaning, "      ", 72);
  }
  return text;
}

std::string FormatMarkdown() {
  std::string text = "| format | what | streams |\n|---|---|---|\n";
  for (const FormatEntry& format : FormatEntries()) {
    text += "| `" + format.name + "`" + (format.recognised ? " *" : "") +
            " | " + Cell(format.meaning) + " | " + Cell(format.streams) +
            " |\n";
  }
  return text;
}

std::string ConfigMarkdown() {
  std::string text =
      "# Configuration\n\nWritten by `hindsight help config --markdown` from "
      "the tables that the program reads by; `hindsight help config KEY` shows "
      "a part,\n`hindsight help config --schema` is a JSON Schema for editors. "
      "\"needed\" marks a key without default, \"-\" one that may be left "
      "out.\n";
  for (const KeySection& section : AllSections()) {
    text += "\n## " + (section.name.empty() ? "The top level" : section.name) +
            "\n\n";
    if (!section.about.empty()) text += section.about + "\n\n";
    text += "| key | meaning | default |\n|---|---|---|\n";
    for (const KeyEntry& key : section.keys) {
      text += "| `" + key.name + "` | " + Cell(key.meaning) +
              (key.when.empty() ? "" : " (with `" + key.when + "`)") + " | " +
              Cell(key.fallback) + " |\n";
    }
  }
  return text;
}

std::string ConfigSchema() {
  const std::vector<KeySection> all = ConfigSections();
  Json json = Object(all, {""});
  json["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  json["title"] = "Configuration of a recording for hindsight";
  Json& of = json["properties"];
  const auto stream = [&](const std::string& name) {
    Json object = Object(all, {"stream", name});
    object["properties"]["time"] = Object(all, {"time"});
    return object;
  };
  of["imu"] = stream("imu");
  of["imu"]["properties"]["noise"] = Object(all, {"imu_noise"});
  of["truth"] = stream("truth");
  of["initial"] = Object(all, {"initial"});
  of["ahrs"] = Object(all, {"ahrs"});
  of["stationary"]["anyOf"] = {Json{{"enum", {"on", "off", true, false}}},
                               Object(all, {"stationary"})};
  of["withhold"] = {{"type", "array"}, {"items", Object(all, {"withhold"})}};
  of["nodes"] = Object(all, {"nodes"});
  Json kinds = Json::array();
  for (const KeySection& section : all) {
    if (!section.name.starts_with("aiding: ")) continue;
    Json object = Object(all, {"stream", "aiding", section.name});
    object["properties"]["time"] = Object(all, {"time"});
    object["properties"]["noise"] = Object(all, {"noise"});
    object["properties"]["type"]["const"] = section.name.substr(8);
    if (section.about.find("It has no file") != std::string::npos) {
      auto& required = object["required"];
      required.erase(std::find(required.begin(), required.end(), "file"));
    }
    kinds.push_back(object);
  }
  of["aiding"] = {{"type", "object"},
                  {"additionalProperties", {{"oneOf", kinds}}}};
  return json.dump(1) + "\n";
}

}  // namespace hindsight
