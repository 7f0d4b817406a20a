#include "io/config/fault_config.h"

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "base/error.h"
#include "io/config/config_map.h"
#include "io/config/scenario_texts.h"
#include "io/read/paths.h"
#include "io/read/units.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

Fault ReadFault(ConfigMap* map) {
  Fault fault;
  const std::string name = map->Text("fault");
  fault.kind = FindFaultKind(name);
  if (fault.kind == nullptr) {
    std::vector<std::string> known;
    for (const FaultKind& kind : FaultKinds()) known.emplace_back(kind.name);
    std::string all;
    for (const std::string& word : known)
      all += (all.empty() ? "" : ", ") + word;
    map->Fail("fault", "'" + name + "' is none; expected one of " + all);
  }
  if (fault.kind->of != FaultKind::Of::kSensor) return fault;
  fault.sensor = map->Text("sensor");
  if (FindSensorKind(fault.sensor) == nullptr) {
    map->Fail("sensor", "'" + fault.sensor + "' is no type of sensor");
  }
  return fault;
}

double NumberIn(const std::string& text, bool (*is_valid)(double),
                const char* expected) {
  const std::optional<double> number = ParseNumber(text);
  if (number && is_valid(*number)) return *number;
  throw std::invalid_argument("'" + text + "': expected " + expected);
}

/// Throws std::invalid_argument.
double ReadSize(const std::string& text, const Fault& fault) {
  switch (fault.kind->size) {
    case FaultKind::Size::kQuantity:
      return ParseQuantity(text, fault.kind->quantity);
    case FaultKind::Size::kOfSensor:
      return ParseQuantity(text,
                           ReadingQuantity(*FindSensorKind(fault.sensor)));
    case FaultKind::Size::kFactor:
      return NumberIn(
          text, [](double x) { return x > 0.0; }, "a factor greater than 0");
    case FaultKind::Size::kAxis:
      return NumberIn(
          text, [](double x) { return x == 0 || x == 1 || x == 2; },
          "an axis of 0, 1 and 2");
    case FaultKind::Size::kCount:
      return NumberIn(
          text,
          [](double x) { return x >= 1.0 && x <= 1e6 && x == std::floor(x); },
          "a whole number from 1 to 1000000");
  }
  return 0.0;
}

void ReadSizes(ConfigMap* map, std::vector<SizedFault>* out) {
  const Fault fault = ReadFault(map);
  const std::string name = fault.sensor + (fault.sensor.empty() ? "" : " ") +
                           std::string(fault.kind->name);
  for (const std::string& text : map->List("sizes")) {
    SizedFault sized{name, text, fault};
    try {
      sized.fault.size = ReadSize(text, fault);
    } catch (const std::invalid_argument& error) {
      map->Fail("sizes", error.what());
    }
    out->push_back(sized);
  }
  map->Finish();
}

FaultCases ReadFaultCases(ConfigMap top, const std::filesystem::path& folder) {
  FaultCases cases;
  for (const std::string& name : top.List("scenarios")) {
    const std::filesystem::path beside = folder / name;
    cases.scenarios.push_back(PathExists(beside.string()) ? beside.string()
                                                          : name);
  }
  if (cases.scenarios.empty()) top.Fail("scenarios", "is missing");
  for (ConfigMap& map : top.Maps("faults")) ReadSizes(&map, &cases.faults);
  top.Finish();
  return cases;
}

}  // namespace

FaultCases LoadFaultCases(const std::string& path) {
  return ReadFaultCases(ConfigMap::Load(path),
                        std::filesystem::path(path).parent_path());
}

FaultCases BuiltinFaultCases(std::string_view file) {
  for (const ScenarioText& text : FaultCaseTexts()) {
    if (text.name != file) continue;
    return ReadFaultCases(
        ConfigMap::Parse(std::string(text.text), std::string(text.name)), {});
  }
  throw InputError("'" + std::string(file) + "' is no built-in list of faults");
}

}  // namespace hindsight
