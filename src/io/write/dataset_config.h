#ifndef HINDSIGHT_IO_WRITE_DATASET_CONFIG_H_
#define HINDSIGHT_IO_WRITE_DATASET_CONFIG_H_

#include <string>

#include "dataset/dataset.h"

namespace hindsight {

/// The configuration (io/config/config.h) of a data set whose files lie beside
/// it as own CSV: imu.csv, NAME.csv for each aiding stream, truth.csv. Values
/// are written in the units people use, with 12 significant digits.
std::string DatasetConfigYaml(const Dataset& dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_DATASET_CONFIG_H_
