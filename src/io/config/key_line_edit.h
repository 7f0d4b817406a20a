#ifndef HINDSIGHT_IO_CONFIG_KEY_LINE_EDIT_H_
#define HINDSIGHT_IO_CONFIG_KEY_LINE_EDIT_H_

#include <string>
#include <vector>

#include "io/read/found_stream.h"

namespace hindsight {

/// Adds an entry to the flow map of a key: "{rate: 1 Hz}".
void AddToMap(const std::string& key, const std::string& entry,
              const std::string& comment, std::vector<KeyLine>* lines);

/// Takes "time_offset: ..." out of the map `estimate`.
void DropClockSigma(std::vector<KeyLine>* lines);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_KEY_LINE_EDIT_H_
