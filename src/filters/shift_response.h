#ifndef HINDSIGHT_FILTERS_SHIFT_RESPONSE_H_
#define HINDSIGHT_FILTERS_SHIFT_RESPONSE_H_

#include <span>
#include <vector>

#include "filters/linear_tape.h"
#include "filters/mean_shift.h"

namespace hindsight {

/// By what the smoothed errors of all epochs change where a deviation of the
/// size of one is allowed for: truth less estimate, of the tape that has it.
std::vector<ErrorVector> CorrectionFor(const MeanShift& shift,
                                       const LinearTape& tape,
                                       const ShiftColumns& columns);

/// Whether a column of a group varies: the squares of z() of its onsets from
/// several epochs, added up. Of a right system they are correlated N(0, 1),
/// whose sum is close to scale chi^2(dof) (Satterthwaite 1946).
struct ShiftEnergy {
  double sum = 0.0;
  double scale = 1.0;
  double dof = 1.0;
};
/// Of some columns of one group, in their order, over the onsets that cause an
/// innovation; zero where none does.
std::vector<ShiftEnergy> EnergiesOf(ShiftColumns::Group group,
                                    std::span<const int> wanted,
                                    std::span<const std::size_t> onsets,
                                    const LinearTape& tape,
                                    const ShiftColumns& columns);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_SHIFT_RESPONSE_H_
