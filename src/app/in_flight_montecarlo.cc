#include <algorithm>
#include <iostream>
#include <memory>

#include "app/finished_runs.h"
#include "app/flags.h"
#include "app/in_flight_report.h"
#include "app/list_flags.h"
#include "app/montecarlo_scenarios.h"
#include "app/observer_flags.h"
#include "base/text.h"
#include "base/units.h"
#include "problems/observer_comparison.h"
#include "simulation/in_flight_alignment.h"

namespace hindsight {
namespace {

constexpr ObserverLimits kLimits = {.settled_tilt = 0.5 * kDegree,
                                    .settled_heading = 2.0 * kDegree,
                                    .diverged_tilt = 2.0 * kDegree,
                                    .diverged_heading = 10.0 * kDegree,
                                    .last = 20.0};

const std::string kRules = "ekf,hinf,modified_hinf";

std::vector<ObserverRecording> Recordings() {
  std::vector<ObserverRecording> recordings;
  for (const double rate : ReadPositiveNumbers("rates", FLAGS_rates)) {
    InFlightAlignmentOptions options;
    options.velocity_rate_hz = rate;
    const auto perfect =
        std::make_shared<const PerfectRecording>(InFlightAlignment(options));
    recordings.push_back({Format("%g Hz", rate), [perfect](std::uint64_t seed) {
                            return perfect->Realize(seed);
                          }});
  }
  return recordings;
}

std::vector<double> ReadAngles(const std::string& flag,
                               const std::string& text) {
  const std::vector<double> angles = ReadPositiveNumbers(flag, text);
  for (const double angle : angles) {
    if (angle <= 180.0) continue;
    throw UsageError("--" + flag + "=" + text + ": expected at most 180 deg");
  }
  return angles;
}

std::vector<ObserverStart> Starts() {
  std::vector<ObserverStart> starts;
  for (const double tilt : ReadAngles("tilt", FLAGS_tilt)) {
    for (const double heading : ReadAngles("heading", FLAGS_heading)) {
      const BadStart start{tilt * kDegree, heading * kDegree};
      starts.push_back({Format("tilt %g heading %g", tilt, heading),
                        [start](std::uint64_t seed, Dataset* dataset) {
                          GiveBadStart(start, seed, dataset);
                        }});
    }
  }
  return starts;
}

/// The rules with their parameters in words, before each error definition.
std::vector<std::pair<std::string, CovarianceOptions>> Rules() {
  std::vector<std::pair<std::string, CovarianceOptions>> rules;
  const std::vector<std::string> names = ReadWords("rules", FLAGS_rules);
  const auto runs = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  CheckObserverFlags(runs("hinf"), runs("modified_hinf"));
  for (const std::string& name : names) {
    if (name == "ekf") {
      rules.emplace_back(name, ReadCovariance(RiccatiRule::kKalman));
    } else if (name == "hinf") {
      CovarianceOptions options = ReadCovariance(RiccatiRule::kHInfinity);
      const std::vector<double> gammas =
          IsGiven("gamma") ? ReadGammas() : std::vector<double>{1.0, 5.0};
      for (const double gamma : gammas) {
        options.gamma = gamma;
        rules.emplace_back(Format("hinf gamma=%g", gamma), options);
      }
    } else if (name == "modified_hinf") {
      CovarianceOptions options =
          ReadCovariance(RiccatiRule::kModifiedHInfinity);
      const std::vector<bool> choices =
          IsGiven("alpha_blocks") ? std::vector<bool>{options.alpha_on_all}
                                  : std::vector<bool>{false, true};
      for (const bool on_all : choices) {
        options.alpha_on_all = on_all;
        rules.emplace_back(
            Format("modified_hinf alpha=%g%s delta=%g", options.alpha,
                   on_all ? " on all" : "", options.delta),
            options);
      }
    } else {
      throw UsageError("--rules=" + FLAGS_rules + ": unknown rule '" + name +
                       "', expected some of " + kRules);
    }
  }
  if (rules.empty()) throw UsageError("--rules=: expected some of " + kRules);
  return rules;
}

std::vector<ObserverModel> Models() {
  const std::vector<ErrorDefinition> errors =
      IsGiven("error") ? ReadErrors()
                       : std::vector{ErrorDefinition::kNavigation,
                                     ErrorDefinition::kQuaternion,
                                     ErrorDefinition::kLeftInvariant};
  std::vector<ObserverModel> models;
  for (const auto& [name, covariance] : Rules()) {
    for (const ErrorDefinition error : errors) {
      models.push_back({name, {error, covariance}});
    }
  }
  return models;
}

}  // namespace

void RunInFlightAlignment(MonteCarloOptions options, Progress* progress,
                          ResultFolder* folder) {
  options.progress = RunProgress(options.runs, progress);
  const std::vector<ObserverModel> models = Models();
  const std::vector<ObserverStart> starts = Starts();
  const auto files = [options](const std::vector<ObserverCell>& cells,
                               bool complete) -> std::vector<OutputFile> {
    return {{kMonteCarloJson, ObserverJson(cells, options, complete)},
            {"cells.csv", ObserverCsv(cells)}};
  };
  const std::vector<ObserverCell> cells = CompareObservers(
      Recordings(), starts, models, kLimits, options,
      KeepFinishedRuns<std::vector<ObserverCell>>(folder, files));
  std::cout << kInFlightAlignmentName << ", seeds " << options.first_seed
            << " to "
            << options.first_seed + static_cast<std::uint64_t>(options.runs - 1)
            << "\n\n"
            << ObserverTable(cells);
  CommitFiles(files(cells, true), folder);
}

}  // namespace hindsight
