#ifndef HINDSIGHT_IO_READ_BAD_VALUES_H_
#define HINDSIGHT_IO_READ_BAD_VALUES_H_

#include "io/read/file_columns.h"

namespace hindsight {

/// Makes NaN of numbers by which devices say that they have no reading, -32.768 of a
/// DVL or -999, and notes them as FileColumns::bad_values: the number of a column
/// farthest from zero, if it is nines, an end of 16 or 32 bits, or above 1e9, and
/// stands three times and more, in less than half of the rows, ten times as far from
/// zero as all others.
void TakeOutBadValues(FileColumns* file);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_BAD_VALUES_H_
