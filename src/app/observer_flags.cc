#include "app/observer_flags.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "app/flags.h"
#include "app/list_flags.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

/// Throws UsageError for what is no number any more after squaring; SI units.
void CheckWithin(const char* flag, double value, double least, double largest,
                 const char* unit) {
  if (value >= least && value <= largest) return;
  throw BadFlag(flag, FormatNumber(value),
                "expected " + FormatNumber(least) + " to " +
                    FormatNumber(largest) + unit);
}

/// "attitude=1rad" or "velocity=0.5m/s".
CovarianceOptions::Bounded ParseBounded(const std::string& text) {
  const std::size_t equals = std::min(text.find('='), text.size());
  const std::string name = text.substr(0, equals);
  CovarianceOptions::Bounded bounded;
  Quantity quantity = Quantity::kAngle;
  if (name == "velocity") {
    bounded.kind = BlockKind::kVelocity;
    quantity = Quantity::kSpeed;
  } else if (name != "attitude") {
    throw BadFlag("bounded", text, "expected attitude or velocity");
  }
  if (equals == text.size()) return bounded;
  try {
    bounded.unit = ParseQuantity(text.substr(equals + 1), quantity);
  } catch (const std::invalid_argument& error) {
    throw UsageError("--bounded=" + text + ": " + error.what());
  }
  constexpr double kLeastUnit = 1e-9;
  constexpr double kLargestUnit = 1e9;
  if (!(bounded.unit >= kLeastUnit && bounded.unit <= kLargestUnit)) {
    throw BadFlag("bounded", text,
                  "expected a unit of " + FormatNumber(kLeastUnit) + " to " +
                      FormatNumber(kLargestUnit) + " rad or m/s");
  }
  return bounded;
}

}  // namespace

std::vector<FlagUse> WithObserverFlags(std::vector<FlagUse> flags) {
  const std::vector<FlagUse> observer = {
      {"error", "NAME",
       "what forward filters call the error: navigation (angles\n"
       "north, east, down), quaternion (additive) or\n"
       "left_invariant (body axes, as of a group) (navigation)"},
      {"gamma", "G",
       "of hinf: bound of the gain from disturbances to the\n"
       "error of what --bounded names [sqrt(s)] (20)"},
      {"alpha", "A", "of modified_hinf: degree of stability [1/s] (0.03)"},
      {"alpha_blocks", "NAME",
       "what alpha acts on: velocity_attitude or all\n"
       "(velocity_attitude)"},
      {"delta", "D", "of modified_hinf: weight of L'L [1/s] (0)"},
      {"bounded", "LIST",
       "blocks of L with the error that counts one: attitude=1rad,\n"
       "velocity=1m/s (attitude=1rad)"},
      {"back_off", "",
       "drop gamma (delta) at steps that would double an\n"
       "eigenvalue of P; without it an escape is a failure"}};
  flags.insert(flags.end(), observer.begin(), observer.end());
  return flags;
}

std::vector<ErrorDefinition> ReadErrors() {
  std::vector<ErrorDefinition> errors;
  for (const std::string& name : ReadWords("error", FLAGS_error)) {
    try {
      errors.push_back(ErrorFromName(name));
    } catch (const InputError& error) {
      throw UsageError("--error=" + FLAGS_error + ": " + error.what());
    }
  }
  if (errors.empty()) {
    throw BadFlag("error", "", "expected an error definition");
  }
  return errors;
}

std::vector<double> ReadGammas() {
  const std::vector<double> gammas = ReadPositiveNumbers("gamma", FLAGS_gamma);
  for (const double gamma : gammas) {
    CheckWithin("gamma", gamma, 1e-6, 1e9, " sqrt(s)");
  }
  return gammas;
}

void CheckObserverFlags(bool hinf, bool modified) {
  const struct {
    const char* flag;
    const char* rules;
    bool used;
  } uses[] = {{"gamma", "hinf", hinf},
              {"alpha", "modified_hinf", modified},
              {"alpha_blocks", "modified_hinf", modified},
              {"delta", "modified_hinf", modified},
              {"bounded", "hinf or modified_hinf", hinf || modified},
              {"back_off", "hinf or modified_hinf", hinf || modified}};
  for (const auto& [flag, rules, used] : uses) {
    if (used || !IsGiven(flag)) continue;
    throw UsageError("--" + Dashed(flag) + " is of " + rules +
                     ", which is not asked for");
  }
}

CovarianceOptions ReadCovariance(RiccatiRule rule) {
  CovarianceOptions options;
  options.rule = rule;
  options.gamma = ReadGammas().front();
  CheckWithin("alpha", FLAGS_alpha, 0.0, 100.0, " 1/s");
  options.alpha = FLAGS_alpha;
  CheckWithin("delta", FLAGS_delta, -1e12, 1e12, " 1/s");
  options.delta = FLAGS_delta;
  if (FLAGS_alpha_blocks != "all" &&
      FLAGS_alpha_blocks != "velocity_attitude") {
    throw BadFlag("alpha-blocks", FLAGS_alpha_blocks,
                  "expected velocity_attitude or all");
  }
  options.alpha_on_all = FLAGS_alpha_blocks == "all";
  options.back_off = FLAGS_back_off;
  options.L.clear();
  for (const std::string& part : ReadWords("bounded", FLAGS_bounded)) {
    const CovarianceOptions::Bounded bounded = ParseBounded(part);
    for (const CovarianceOptions::Bounded& before : options.L) {
      if (before.kind != bounded.kind) continue;
      throw BadFlag("bounded", FLAGS_bounded, "expected each block once");
    }
    options.L.push_back(bounded);
  }
  if (options.L.empty()) {
    throw BadFlag("bounded", "", "expected attitude or velocity");
  }
  return options;
}

std::vector<ObserverModel> ReadObserverModels() {
  const std::string all = "ekf,hinf,modified_hinf";
  const std::string asked = IsGiven("methods") ? FLAGS_methods : all;
  std::vector<std::pair<std::string, CovarianceOptions>> rules;
  bool hinf = false, modified = false;
  for (const std::string& name : ReadWords("methods", asked)) {
    if (name == "ekf") {
      rules.emplace_back(name, ReadCovariance(RiccatiRule::kKalman));
    } else if (name == "hinf") {
      hinf = true;
      CovarianceOptions options = ReadCovariance(RiccatiRule::kHInfinity);
      for (const double gamma :
           IsGiven("gamma") ? ReadGammas() : std::vector{1.0, 5.0}) {
        options.gamma = gamma;
        rules.emplace_back(fmt::format("hinf gamma={:g}", gamma), options);
      }
    } else if (name == "modified_hinf") {
      modified = true;
      CovarianceOptions options =
          ReadCovariance(RiccatiRule::kModifiedHInfinity);
      for (const bool on_all : {false, true}) {
        if (IsGiven("alpha_blocks") && on_all != options.alpha_on_all) continue;
        rules.emplace_back(
            fmt::format("modified_hinf alpha={:g}{} delta={:g}", options.alpha,
                        on_all ? " on all" : "", options.delta),
            options);
        rules.back().second.alpha_on_all = on_all;
      }
    } else {
      throw BadFlag("methods", asked,
                    "'" + name + "' is none of the observers " + all);
    }
  }
  if (rules.empty()) throw BadFlag("methods", "", "expected some of " + all);
  CheckObserverFlags(hinf, modified);
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
