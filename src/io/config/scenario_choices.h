#ifndef HINDSIGHT_IO_CONFIG_SCENARIO_CHOICES_H_
#define HINDSIGHT_IO_CONFIG_SCENARIO_CHOICES_H_

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

namespace hindsight {

/// Makes the choices of a scenario's file and then the changes "KEY=VALUE". A
/// choice, CHOICE: {NAME: {keys}} under `choices`, lays the keys of one NAME
/// over those of the file, maps key by key: of the one that a key CHOICE at the
/// top or a change CHOICE=NAME names, else of the first. Other KEYs are paths,
/// "aiding.gnss.sigma", where * stands for every key that is there; VALUE is
/// YAML, and ~ takes the key away. Throws InputError.
void EditScenario(const std::vector<std::string>& changes, YAML::Node* top);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_SCENARIO_CHOICES_H_
