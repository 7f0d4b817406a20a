#include "io/read/text_format.h"

#include <utility>

#include "base/error.h"
#include "io/read/file_format.h"
#include "io/read/open_text.h"

namespace hindsight {

OpenedTable OpenTable(const std::string& path, const TextFormat& format,
                      const std::vector<FieldName>& fields,
                      TextTable::Options options) {
  const TableRequest request = {path, format, fields, options};
  OpenedTable opened =
      format.kind->columns == nullptr
          ? format.kind->open(request)
          : OpenColumns(request, format.kind->columns(request));
  opened.table =
      WithConstants(std::move(opened.table), format.constants, fields);
  return opened;
}

void RequireFields(const OpenedTable& opened, const TextFormat& format,
                   const std::vector<FieldName>& fields, std::size_t first,
                   std::size_t last) {
  for (std::size_t i = first; i <= last; ++i) {
    if (opened.table->Has(i)) continue;
    const std::string message = std::string("no column ") + fields[i].name +
                                ", in " + SiUnit(fields[i].quantity) +
                                " or a like unit";
    if (format.kind->takes_columns) {
      throw InputError(format.config_path, format.config_line, message);
    }
    throw InputError(
        opened.table->path(), 0,
        message + "; expected by the format " + std::string(format.kind->name));
  }
}

}  // namespace hindsight
