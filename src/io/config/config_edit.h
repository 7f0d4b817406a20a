#ifndef HINDSIGHT_IO_CONFIG_CONFIG_EDIT_H_
#define HINDSIGHT_IO_CONFIG_CONFIG_EDIT_H_

#include <optional>
#include <string>
#include <vector>

namespace hindsight {

/// The text of a configuration in which values are exchanged, while all else,
/// comments and order too, stays as somebody wrote it.
class ConfigEdit {
 public:
  using Path = std::vector<std::string>;  ///< keys from the top level down

  /// Throws InputError if it is no valid YAML; `file` for its message.
  ConfigEdit(std::string text, std::string file);

  /// As it is written, without quotes: a scalar, or a list in brackets. Nothing
  /// where there is none, or it is written in another way.
  std::optional<std::string> Value(const Path& path) const;

  /// Puts `value` in the place of that at `path` or, where there is none, first
  /// into its map, and "# SOURCE: KEY WHY" on the line before, in the place of an
  /// earlier one of that source and key. False, and nothing has changed, where
  /// the map is not there or what is there cannot be exchanged.
  bool Set(const Path& path, const std::string& value,
           const std::string& source, const std::string& why);

  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::string file_;
};

/// "[0.65 m, 1.3 m]" of "[0.5 m, 1 m]" and 1.3, to three digits.
std::string ScaledNumbers(const std::string& value, double factor);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_CONFIG_EDIT_H_
