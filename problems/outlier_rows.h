#ifndef HINDSIGHT_PROBLEMS_OUTLIER_ROWS_H_
#define HINDSIGHT_PROBLEMS_OUTLIER_ROWS_H_

#include <span>
#include <vector>

#include "state/evidence.h"
#include "state/solution.h"
#include "timeline/timeline.h"

namespace hindsight {

/// A fix of one sensor that is used: is it taken for an outlier?
struct TakenFix {
  double t = 0.0;  ///< [s]
  bool outlier = false;
};

/// Outliers in a row, with no fix behind them or before them for long.
struct RowAtGap {
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]
  int count = 0;       ///< 0: there is none
};

/// The longest of the rows next to a gap, begin and end of the recording among
/// them (LongestSpacingWithoutGap). Fixes in the order of time.
RowAtGap LongestRowAtGap(std::span<const TakenFix> fixes);

/// Outliers come one by one. Two and more, behind which nothing follows that
/// would agree with the fixes before them, may be the right ones: of each sensor of
/// positions that has such a doubt is added. So it is if its very last fix is an outlier,
/// as an error that grows slowly is seen where it ends, unless another sensor of positions
/// or velocities still tells there, with a last measurement that is none. Outliers have a
/// weight below a half.
void DoubtOutliersAtGaps(const Timeline& timeline,
                         const std::vector<ResidualRecord>& residuals,
                         std::vector<Evidence>* doubts);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_OUTLIER_ROWS_H_
