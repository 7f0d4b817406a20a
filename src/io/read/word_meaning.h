#ifndef HINDSIGHT_IO_READ_WORD_MEANING_H_
#define HINDSIGHT_IO_READ_WORD_MEANING_H_

#include <string>
#include <vector>

#include "io/read/column_meaning.h"

namespace hindsight {

/// The words of a title, in small letters.
using Words = std::vector<std::string>;

/// What they say of a column, in their natural reading; its unit is left open.
/// No quantity where they say nothing that is known.
ColumnMeaning MeaningOfWords(const Words& words);

/// The same among rates, specific forces and fields alone.
ColumnMeaning InertialMeaning(const Words& words);

/// Whether they name a time.
bool IsOfTime(const Words& words);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_WORD_MEANING_H_
