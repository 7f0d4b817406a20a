#ifndef HINDSIGHT_IO_WRITE_DATASET_WRITER_H_
#define HINDSIGHT_IO_WRITE_DATASET_WRITER_H_

#include <functional>
#include <string>

#include "dataset/dataset.h"
#include "simulation/scenario.h"

namespace hindsight {

/// Name of the configuration within the folder.
inline constexpr char kDatasetConfigName[] = "config.yaml";

/// Writes a data set as a recording that LoadDataset reads: config.yaml,
/// imu.csv, one NAME.csv for each aiding stream and truth.csv
/// (docs/formats.md; truth carries the biases in columns bg_x[deg/h]...
/// ba_z[m/s^2]). IMU samples keep 12 significant digits, positions 1e-13 deg.
/// The folder is made if need be. Throws OutputError if it cannot be written,
/// and InputError for what the format cannot hold: correlated errors of a fix,
/// a sensor that is none of position, velocity, height, odometer, DVL and
/// acoustic fix.
void WriteDataset(const Dataset& dataset, const std::string& folder);

/// The same for a simulation not yet begun, whose IMU samples go straight to
/// the file. `path_of` says where the file of a name is to be written.
void WriteDataset(
    Simulation* simulation,
    const std::function<std::string(const std::string& name)>& path_of);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_DATASET_WRITER_H_
