#ifndef HINDSIGHT_IO_CONFIG_CONFIG_COLUMNS_H_
#define HINDSIGHT_IO_CONFIG_CONFIG_COLUMNS_H_

#include <vector>

#include "io/config/config_map.h"
#include "io/read/fields.h"
#include "io/read/text_format.h"

namespace hindsight {

/// `columns` of a stream whose quantities are `fields`, into the columns and
/// constants of the format. Throws InputError that names file, line and key.
void ReadColumns(ConfigMap* map, const std::vector<FieldName>& fields,
                 TextFormat* format);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_CONFIG_COLUMNS_H_
