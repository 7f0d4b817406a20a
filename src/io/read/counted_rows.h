#ifndef HINDSIGHT_IO_READ_COUNTED_ROWS_H_
#define HINDSIGHT_IO_READ_COUNTED_ROWS_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "io/read/column_steps.h"
#include "io/read/stamp_guess.h"

namespace hindsight {

/// Without stamps: at the IMU's rate, or as long as the IMU recorded where that
/// would be another length. Nothing if no rate is known.
std::optional<StampGuess> CountedRows(std::size_t rows,
                                      const StampHints& hints);

/// Rows of whole seconds that several rows share come evenly; the first second may
/// not be whole. False where ten seconds and more are not there, or are no seconds.
bool RecogniseWholeSeconds(const std::vector<double>& t, StampGuess* guess);

/// An axis drawn from 0 to D in N points, where N rows of D/N were meant.
void RecogniseDrawnAxis(std::size_t rows, const Steps& steps,
                        StampGuess* guess);

/// Stamps that tell ten times the time that the IMU recorded.
void RecogniseWrongScale(std::size_t rows, const StampHints& hints,
                         StampGuess* guess);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_COUNTED_ROWS_H_
