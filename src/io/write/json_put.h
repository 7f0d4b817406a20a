#ifndef HINDSIGHT_IO_WRITE_JSON_PUT_H_
#define HINDSIGHT_IO_WRITE_JSON_PUT_H_

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace hindsight {

/// \file
/// Entries of a JSON object. What is no number, empty or not there is left out,
/// so that no reader meets a null.

inline void PutValue(nlohmann::ordered_json* json, const std::string& key,
                     double value) {
  if (std::isfinite(value)) (*json)[key] = value;
}

inline void PutValue(nlohmann::ordered_json* json, const std::string& key,
                     const std::optional<double>& value) {
  if (value) PutValue(json, key, *value);
}

inline void PutValue(nlohmann::ordered_json* json, const std::string& key,
                     const Eigen::Vector3d& v) {
  if (v.allFinite()) (*json)[key] = {v.x(), v.y(), v.z()};
}

inline void PutText(nlohmann::ordered_json* json, const std::string& key,
                    const std::string& text) {
  if (!text.empty()) (*json)[key] = text;
}

inline void PutWords(nlohmann::ordered_json* json, const std::string& key,
                     const std::vector<std::string>& words) {
  if (!words.empty()) (*json)[key] = words;
}

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_JSON_PUT_H_
