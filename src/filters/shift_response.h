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
/// whose sum is a weighted one of chi-square variables of one degree of freedom.
struct ShiftEnergy {
  double sum = 0.0;
  std::vector<double> weights;  ///< WeightedChiSquareQuantile
  /// By how much it steps at each onset, as variables N(0, tau^2): with s and G
  /// their scores and information and D the diagonal of G, the mean of their
  /// distribution is (G + I / tau^2)^-1 s, with the tau that makes the sum what
  /// it is, tau^2 = (s' D^-1 s - n) / tr(D^-1 G^2) (moments). Zero where the sum
  /// is not above its mean.
  std::vector<double> steps;
};
/// Of some columns of one group, in their order, over the onsets that cause an
/// innovation; empty where none does.
std::vector<ShiftEnergy> EnergiesOf(ShiftColumns::Group group,
                                    std::span<const int> wanted,
                                    std::span<const std::size_t> onsets,
                                    const LinearTape& tape,
                                    const ShiftColumns& columns,
                                    const EpochCallback& callback = nullptr);

/// The same of a deviation that steps at several onsets, by `steps`.
std::vector<ErrorVector> CorrectionForSteps(ShiftColumns::Group group,
                                            int column,
                                            std::span<const std::size_t> onsets,
                                            std::span<const double> steps,
                                            const LinearTape& tape,
                                            const ShiftColumns& columns);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_SHIFT_RESPONSE_H_
