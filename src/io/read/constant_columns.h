#ifndef HINDSIGHT_IO_READ_CONSTANT_COLUMNS_H_
#define HINDSIGHT_IO_READ_CONSTANT_COLUMNS_H_

#include <memory>
#include <string>
#include <vector>

#include "io/read/fields.h"
#include "io/read/row_source.h"

namespace hindsight {

/// A quantity that has the same value in every row and no column in the file.
struct ConstantColumn {
  std::string quantity;  ///< a FieldName
  double value = 0.0;    ///< SI
};

/// The rows of `source`, to which the constants are added.
std::unique_ptr<RowSource> WithConstants(
    std::unique_ptr<RowSource> source,
    const std::vector<ConstantColumn>& constants,
    const std::vector<FieldName>& fields);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_CONSTANT_COLUMNS_H_
