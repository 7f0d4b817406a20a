#include <memory>
#include <string>
#include <vector>

#include "app/asked_methods.h"
#include "app/flags.h"
#include "app/studies.h"
#include "io/config/fault_config.h"
#include "io/config/scenario_config.h"
#include "problems/grade_trial.h"
#include "problems/navigation_trial.h"
#include "simulation/fault.h"
#include "simulation/scenario.h"

namespace hindsight {

Study GradesStudy() {
  if (IsGiven("faults") && FLAGS_faults.empty()) {
    throw UsageError("--faults: expected a file");
  }
  const AskedMethods asked = ReadMethods(FLAGS_methods);
  const FaultCases cases =
      IsGiven("faults")
          ? LoadFaultCases(FLAGS_faults)
          : BuiltinFaultCases(asked.attitude_alone ? "attitude.yaml"
                                                   : "grades.yaml");
  Study study = {"", {}, GradeTables(), {}};
  for (const std::string& name : cases.scenarios) {
    const Scenario scenario = FindScenario(name, {});
    std::vector<FaultyTwin> twins;
    const auto perfect = std::make_shared<const PerfectRecording>(scenario);
    const Dataset sample = perfect->Realize(0);
    for (const SizedFault& sized : cases.faults) {
      if (!HasPlaceFor(sized.fault, sample)) continue;
      twins.push_back({sized.name, sized.size,
                       [fault = sized.fault](std::uint64_t seed, Dataset* d) {
                         ApplyFault(fault, seed, d);
                       },
                       [fault = sized.fault, perfect](std::uint64_t seed,
                                                      const Dataset& healthy) {
                         return WithErrorsAsTheyWere(
                             fault, seed, healthy,
                             perfect->WithoutErrors(healthy));
                       }});
    }
    study.cases.push_back(
        {{scenario.name},
         [perfect] {
           return
               [perfect](std::uint64_t seed) { return perfect->Realize(seed); };
         },
         GradeTrial({.methods = asked.names, .judged_every = 1.0}, twins)});
  }
  return study;
}

}  // namespace hindsight
