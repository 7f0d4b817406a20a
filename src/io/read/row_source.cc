#include "io/read/row_source.h"

#include "base/error.h"

namespace hindsight {

void RowSource::Fail(const std::string& message) const {
  throw InputError(row_path(), line_, message);
}

}  // namespace hindsight
