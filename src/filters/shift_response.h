#ifndef HINDSIGHT_FILTERS_SHIFT_RESPONSE_H_
#define HINDSIGHT_FILTERS_SHIFT_RESPONSE_H_

#include <span>
#include <vector>

#include "filters/linear_tape.h"
#include "filters/mean_shift.h"

namespace hindsight {

/// By what the smoothed errors of all epochs, a column each, change where a
/// deviation of the size of one is allowed for: truth less estimate, of the tape
/// that has it.
Eigen::MatrixXd CorrectionFor(const MeanShift& shift, const LinearTape& tape,
                              const ShiftColumns& columns);

/// z() of the onsets of one column from several epochs, squared and added up: of
/// a right system, where z ~ N(0, C), a weighted sum of chi-square variables of
/// one degree of freedom. Shows errors that wander off.
struct ShiftEnergy {
  double sum = 0.0;
  std::vector<double> weights;  ///< eigenvalues of C, WeightedChiSquareQuantile
};

/// Whether columns of a group vary.
struct GroupEnergy {
  std::vector<ShiftEnergy> columns;
  /// z' C^-1 z of all columns together, chi^2(dof): shows errors of any course,
  /// as those that last a while and come again.
  double whitened = 0.0;
  double dof = 0.0;
  /// By how much each column steps at each onset, a row an onset. In units of
  /// the sigma of a column that is there throughout they are taken for
  /// N(0, tau^2): with s and G their scores and information and D the diagonal of
  /// G, the mean of their distribution is (G + I / tau^2)^-1 s, with the larger
  /// tau that makes one of the sums what it is (moments),
  ///   tau^2 = (z' z - n) / tr(D^-1 G^2) or (z' C^-1 z - dof) / tr(G);
  /// zero where neither is above its mean.
  Eigen::MatrixXd steps;
};

/// Of some columns of one group, over the onsets that cause an innovation.
GroupEnergy EnergiesOf(ShiftColumns::Group group, std::span<const int> wanted,
                       std::span<const std::size_t> onsets,
                       const LinearTape& tape, const ShiftColumns& columns);

/// The same as CorrectionFor of columns that step by `steps`, a row an onset.
Eigen::MatrixXd CorrectionForSteps(ShiftColumns::Group group,
                                   std::span<const int> wanted,
                                   std::span<const std::size_t> onsets,
                                   const Eigen::MatrixXd& steps,
                                   const LinearTape& tape,
                                   const ShiftColumns& columns);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_SHIFT_RESPONSE_H_
