#ifndef HINDSIGHT_IO_WRITE_YAML_MAP_H_
#define HINDSIGHT_IO_WRITE_YAML_MAP_H_

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "base/units.h"
#include "earth/wgs84.h"
#include "io/write/number_format.h"

namespace hindsight {

/// Of a number as it is written.
inline constexpr int kYamlDigits = 12;

/// A unit as it is written and its size in SI.
struct PrintedUnit {
  const char* name;
  double si = 1.0;
};
inline constexpr PrintedUnit kMetres{"m"};
inline constexpr PrintedUnit kSeconds{"s"};
inline constexpr PrintedUnit kMetresPerSecond{"m/s"};
inline constexpr PrintedUnit kDegrees{"deg", kDegree};
inline constexpr PrintedUnit kDegreesPerHour{"deg/h", kDegree / kHour};
inline constexpr PrintedUnit kMilliGs{"mg", kMilliG};

inline std::string NumberText(double value, const PrintedUnit& unit) {
  return FormatGeneral(value / unit.si, kYamlDigits) + " " + unit.name;
}

/// A map of YAML in the order in which its keys are put in.
class YamlMap {
 public:
  void Text(const std::string& key, const std::string& value) {
    node_[key] = value;
  }
  void Number(const std::string& key, double value, const PrintedUnit& unit) {
    Text(key, NumberText(value, unit));
  }
  /// On one line.
  void List(const std::string& key, const std::vector<std::string>& values) {
    YAML::Node list(values);
    list.SetStyle(YAML::EmitterStyle::Flow);
    node_[key] = list;
  }
  void Vector(const std::string& key, const Eigen::Vector3d& value,
              const PrintedUnit& unit) {
    List(key, {NumberText(value.x(), unit), NumberText(value.y(), unit),
               NumberText(value.z(), unit)});
  }
  void Vector(const std::string& key,
              const std::optional<Eigen::Vector3d>& value,
              const PrintedUnit& unit) {
    if (value) Vector(key, *value, unit);
  }
  /// Latitude, longitude and height.
  void Position(const std::string& key, const Geodetic& position) {
    constexpr int kAngleDigits = 16;
    List(key,
         {FormatGeneral(position.latitude / kDegree, kAngleDigits) + " deg",
          FormatGeneral(position.longitude / kDegree, kAngleDigits) + " deg",
          NumberText(position.height, kMetres)});
  }
  /// Left out while it is empty.
  void Map(const std::string& key, const YamlMap& inside) {
    if (inside.node_.size() > 0) node_[key] = inside.node_;
  }
  /// Maps, a line each.
  void Lines(const std::string& key, const std::vector<YamlMap>& maps) {
    for (const YamlMap& map : maps) {
      YAML::Node line = map.node_;
      line.SetStyle(YAML::EmitterStyle::Flow);
      node_[key].push_back(line);
    }
  }
  std::string Emit() const {
    YAML::Emitter emitter;
    emitter << node_;
    return std::string(emitter.c_str()) + "\n";
  }

 private:
  YAML::Node node_{YAML::NodeType::Map};
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_YAML_MAP_H_
