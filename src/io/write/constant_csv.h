#ifndef HINDSIGHT_IO_WRITE_CONSTANT_CSV_H_
#define HINDSIGHT_IO_WRITE_CONSTANT_CSV_H_

#include <cstdint>
#include <optional>
#include <string>

#include "state/solution.h"

namespace hindsight {

/// What a forward method knew of the constants as time went on, or the backward
/// filter of a two-filter smoother against time: t[s], then for each estimated component beyond navigation state and biases its value
/// `NAME[unit]` and standard deviation `sd_NAME[unit]`, SI, empty
/// where nothing is known; at most 5000 epochs, evenly. `program` and what t = 0 is go into the comments. Throws
/// OutputError if the file cannot be written.
void WriteConstantCsv(const std::string& path, const Solution& solution,
                      const std::string& program,
                      std::optional<std::int64_t> epoch_gps_ns);

/// Whether there is anything to write: a forward method with covariances or a
/// backward filter, and such components.
bool HasConstantSeries(const Solution& solution);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_CONSTANT_CSV_H_
