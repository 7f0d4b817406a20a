#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "io/config/config_map.h"

namespace hindsight {
std::string ConfigMap::ScalarText(const std::string& key,
                                  const YAML::Node& node) const {
  if (!node.IsScalar()) Fail(key, "expected one value");
  return node.Scalar();
}

namespace {

/// What nothing on the Earth or near it exceeds, nor the uncertainty of it, SI.
double MostOf(Quantity quantity) {
  switch (quantity) {
    case Quantity::kFrequency:
      return 1e9;
    case Quantity::kLength:
      return 1e7;  // from the equator to a pole
    case Quantity::kSpeed:
      return 1e5;
    case Quantity::kAcceleration:
      return 1e4;
    case Quantity::kAngle:
    case Quantity::kAngularRate:
      return 1e3;
    case Quantity::kMagneticField:
      return 1e6;
    default:
      return std::numeric_limits<double>::infinity();
  }
}

}  // namespace

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
  std::vector<double> values;
  try {
    values = ParseQuantities(text, quantity);
  } catch (const std::invalid_argument& error) {
    Fail(key, error.what());
  }
  const double most = MostOf(quantity);
  for (const double value : values) {
    if (std::abs(value) <= most) continue;
    Fail(key, fmt::format("is {:.4g} {}; expected at most {:.4g} {}", value,
                          SiUnit(quantity), most, SiUnit(quantity)));
  }
  return values;
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

namespace {

/// The choice that is the same boolean of YAML 1.1 as `text`: a program that
/// reads `off` may write `false`.
std::optional<std::size_t> SameBoolean(
    const std::string& text, const std::vector<std::string>& choices) {
  for (const auto& words :
       {std::array{"off", "false", "no"}, std::array{"on", "true", "yes"}}) {
    if (std::find(words.begin(), words.end(), text) == words.end()) continue;
    const auto found = std::find_first_of(choices.begin(), choices.end(),
                                          words.begin(), words.end());
    if (found == choices.end()) return std::nullopt;
    return static_cast<std::size_t>(found - choices.begin());
  }
  return std::nullopt;
}

}  // namespace

std::size_t ConfigMap::Choice(const std::string& key,
                              const std::vector<std::string>& choices,
                              std::optional<std::size_t> fallback) {
  const auto text = OptionalText(key);
  if (!text) {
    if (!fallback)
      Fail(key, "is missing; expected one of " +
                    fmt::format("{}", fmt::join(choices, ", ")));
    Resolve(key, choices[*fallback]);
    return *fallback;
  }
  const auto found = std::find(choices.begin(), choices.end(), *text);
  if (const auto same = SameBoolean(*text, choices)) {
    Resolve(key, choices[*same]);
    return *same;
  }
  if (found == choices.end()) {
    Fail(key, "'" + *text + "' is not known; expected one of " +
                  fmt::format("{}", fmt::join(choices, ", ")));
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
  for (const auto& item : *node) items.push_back(ScalarText(key, item));
  Resolve(key, items);
  return items;
}

}  // namespace hindsight
