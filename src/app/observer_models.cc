#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "app/flags.h"
#include "app/list_flags.h"
#include "app/observer_flags.h"
#include "app/studies.h"

namespace hindsight {
namespace {

const std::string kRules = "ekf,hinf,modified_hinf";

using NamedRule = std::pair<std::string, CovarianceOptions>;

/// One rule of --rules with its parameters in words, once for each of them.
std::vector<NamedRule> RulesOf(const std::string& name) {
  std::vector<NamedRule> rules;
  if (name == "ekf") {
    rules.emplace_back(name, ReadCovariance(RiccatiRule::kKalman));
  } else if (name == "hinf") {
    CovarianceOptions options = ReadCovariance(RiccatiRule::kHInfinity);
    const std::vector<double> gammas =
        IsGiven("gamma") ? ReadGammas() : std::vector<double>{1.0, 5.0};
    for (const double gamma : gammas) {
      options.gamma = gamma;
      rules.emplace_back(fmt::format("hinf gamma={:g}", gamma), options);
    }
  } else if (name == "modified_hinf") {
    CovarianceOptions options = ReadCovariance(RiccatiRule::kModifiedHInfinity);
    const std::vector<bool> choices =
        IsGiven("alpha_blocks") ? std::vector<bool>{options.alpha_on_all}
                                : std::vector<bool>{false, true};
    for (const bool on_all : choices) {
      options.alpha_on_all = on_all;
      rules.emplace_back(
          fmt::format("modified_hinf alpha={:g}{} delta={:g}", options.alpha,
                      on_all ? " on all" : "", options.delta),
          options);
    }
  } else {
    throw UsageError("--rules=" + FLAGS_rules + ": unknown rule '" + name +
                     "', expected some of " + kRules);
  }
  return rules;
}

}  // namespace

std::vector<ObserverModel> ReadObserverModels() {
  const std::vector<std::string> names = ReadWords("rules", FLAGS_rules);
  const auto runs = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  CheckObserverFlags(runs("hinf"), runs("modified_hinf"));
  if (names.empty()) throw UsageError("--rules=: expected some of " + kRules);
  std::vector<NamedRule> rules;
  for (const std::string& name : names) {
    for (NamedRule& rule : RulesOf(name)) rules.push_back(std::move(rule));
  }
  const std::vector<ErrorDefinition> errors =
      IsGiven("error") ? ReadErrors()
                       : std::vector{ErrorDefinition::kNavigation,
                                     ErrorDefinition::kQuaternion,
                                     ErrorDefinition::kLeftInvariant};
  std::vector<ObserverModel> models;
  for (const auto& [name, covariance] : rules) {
    for (const ErrorDefinition error : errors) {
      models.push_back({name, {error, covariance}});
    }
  }
  return models;
}

}  // namespace hindsight
