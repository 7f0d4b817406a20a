#ifndef HINDSIGHT_IO_CONFIG_CONFIG_OMISSIONS_H_
#define HINDSIGHT_IO_CONFIG_CONFIG_OMISSIONS_H_

#include <vector>

#include "io/config/config.h"
#include "io/config/config_map.h"

namespace hindsight {

/// Takes the measurements of `declared` and of `options.omit` out of the streams
/// that they name, and puts those of `options` into the resolved configuration.
/// Throws InputError for a span that names no stream, that holds no measurement
/// or that leaves none.
void ApplyOmissions(const std::vector<Omission>& declared,
                    const LoadOptions& options, ConfigMap* top,
                    Dataset* dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_CONFIG_OMISSIONS_H_
