#ifndef HINDSIGHT_IO_CONFIG_FAULT_CONFIG_H_
#define HINDSIGHT_IO_CONFIG_FAULT_CONFIG_H_

#include <string>
#include <string_view>
#include <vector>

#include "simulation/fault.h"

namespace hindsight {

/// A fault in one size, as it was written.
struct SizedFault {
  std::string name;  ///< "position delay", "imu_rate"
  std::string size;  ///< "0.2 s"
  Fault fault;
};

/// Which vehicles are tried with which faults.
struct FaultCases {
  std::vector<std::string> scenarios;  ///< names, or paths beside the file
  std::vector<SizedFault> faults;
};

/// \file
/// Cases of faults as YAML:
///   scenarios   list of names of `simulate --list`, or paths
///   faults      list of {fault, sensor, sizes}: a kind of FaultKinds, the kind
///               of the sensor that has it (not of an IMU's or a start's), and
///               sizes with their units

/// Reads a file of cases. Throws InputError "file:line: ...".
FaultCases LoadFaultCases(const std::string& path);

/// Those of a file of data/faults, which come along. Throws InputError if there
/// is none of that name.
FaultCases BuiltinFaultCases(std::string_view file);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_FAULT_CONFIG_H_
