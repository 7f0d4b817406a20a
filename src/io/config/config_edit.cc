#include "io/config/config_edit.h"

#include <fmt/core.h>
#include <yaml-cpp/yaml.h>

#include <cstdlib>
#include <utility>

#include "base/error.h"

namespace hindsight {
namespace {

/// Of a value, as a part of the text.
struct Place {
  std::size_t begin = 0;
  std::size_t end = 0;
};

YAML::Node Parsed(const std::string& text, const std::string& file) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError(file, error.mark.line + 1L,
                     "is not valid YAML: " + error.msg);
  }
}

/// Undefined where there is none.
YAML::Node Find(YAML::Node node, const ConfigEdit::Path& path,
                std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (!node.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
    node.reset(node[path[i]]);
    if (!node.IsDefined()) break;
  }
  return node;
}

/// Where the value is written, without quotes; nothing in other ways of writing
/// than those of ConfigEdit::Value.
std::optional<Place> PlaceOf(const YAML::Node& node, const std::string& text) {
  if (!node.IsDefined() || node.Mark().pos < 0) return std::nullopt;
  const auto begin = static_cast<std::size_t>(node.Mark().pos);
  if (begin >= text.size()) return std::nullopt;
  const auto closed = [&](char last, std::size_t from, std::size_t behind) {
    const std::size_t end = text.find(last, begin + 1);
    return end == text.npos ? std::nullopt
                            : std::optional(Place{from, end + behind});
  };
  if (node.IsSequence() && text[begin] == '[') return closed(']', begin, 1);
  if (!node.IsScalar()) return std::nullopt;
  if (text[begin] == '"' || text[begin] == '\'') {
    return closed(text[begin], begin + 1, 0);
  }
  const std::string& scalar = node.Scalar();
  if (text.compare(begin, scalar.size(), scalar) != 0) return std::nullopt;
  return Place{begin, begin + scalar.size()};
}

std::size_t LineBegin(const std::string& text, std::size_t at) {
  const std::size_t feed = at == 0 ? text.npos : text.rfind('\n', at - 1);
  return feed == text.npos ? 0 : feed + 1;
}

std::string Indentation(const std::string& text, std::size_t line) {
  const std::size_t end = text.find_first_not_of(' ', line);
  return end == text.npos ? "" : text.substr(line, end - line);
}

/// Puts the comment before the line that holds `at`, in place of one among the
/// comments there that begins alike.
void Comment(std::size_t at, const std::string& begin, const std::string& why,
             std::string* text) {
  const std::size_t line = LineBegin(*text, at);
  const std::string indentation = Indentation(*text, line);
  for (std::size_t above = line; above > 0;) {
    const std::size_t end = above;
    above = LineBegin(*text, above - 1);
    const std::size_t word = text->find_first_not_of(' ', above);
    if (word >= end || (*text)[word] != '#') break;
    if (text->compare(word, begin.size(), begin) != 0) continue;
    text->erase(above, end - above);
    Comment(at - (end - above), begin, why, text);
    return;
  }
  text->insert(line, indentation + begin + why + "\n");
}

}  // namespace

ConfigEdit::ConfigEdit(std::string text, std::string file)
    : text_(std::move(text)), file_(std::move(file)) {
  Parsed(text_, file_);
}

std::optional<std::string> ConfigEdit::Value(const Path& path) const {
  const auto place =
      PlaceOf(Find(Parsed(text_, file_), path, path.size()), text_);
  if (!place) return std::nullopt;
  return text_.substr(place->begin, place->end - place->begin);
}

bool ConfigEdit::Set(const Path& path, const std::string& value,
                     const std::string& source, const std::string& why) {
  const YAML::Node top = Parsed(text_, file_);
  const YAML::Node node = Find(top, path, path.size());
  std::string text = text_;
  std::size_t at = 0;
  if (node.IsDefined() && !node.IsNull()) {
    const auto place = PlaceOf(node, text);
    if (!place) return false;
    at = place->begin;
    text.replace(at, place->end - at, value);
  } else {
    const YAML::Node map = Find(top, path, path.size() - 1);
    if (node.IsDefined() || !map.IsDefined() || !map.IsMap() ||
        map.size() == 0 || map.Mark().pos < 0) {
      return false;
    }
    at = static_cast<std::size_t>(map.Mark().pos);
    const std::string entry = path.back() + ": " + value;
    const std::size_t line = LineBegin(text, at);
    if (at < text.size() && text[at] == '{') {
      text.insert(at + 1, entry + ", ");
    } else {
      text.insert(at, entry + "\n" + std::string(at - line, ' '));
    }
  }
  Comment(at, "# " + source + ": " + path.back() + " ", why, &text);
  const YAML::Node now = Find(Parsed(text, file_), path, path.size());
  if (!now.IsDefined()) return false;
  text_ = std::move(text);
  return true;
}

std::string ScaledNumbers(const std::string& value, double factor) {
  std::string text;
  for (std::size_t i = 0; i < value.size();) {
    const bool digit = value[i] >= '0' && value[i] <= '9';
    const bool starts = digit && (i == 0 || value[i - 1] == ' ' ||
                                  value[i - 1] == '[' || value[i - 1] == ',');
    if (!starts) {
      text += value[i++];
      continue;
    }
    char* end = nullptr;
    const double number = std::strtod(value.c_str() + i, &end);
    text += fmt::format("{:.3g}", number * factor);
    i = static_cast<std::size_t>(end - value.c_str());
  }
  return text;
}

}  // namespace hindsight
