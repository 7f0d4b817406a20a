#ifndef HINDSIGHT_PROBLEMS_EXPLANATION_WORDS_H_
#define HINDSIGHT_PROBLEMS_EXPLANATION_WORDS_H_

#include <string>

#include "filters/mean_shift.h"
#include "problems/deviation_columns.h"
#include "timeline/problem.h"

namespace hindsight {

/// What people call a deviation, with its size and unit, and what to try.
struct Words {
  std::string what;  ///< a clause, without since when
  std::string remedy;
};

/// `own` made the columns of `problem` that `shift` is of.
Words WordsOfShift(const MeanShift& shift, const DeviationColumns& own,
                   const Problem& problem);

/// Says which additive error comes and goes.
Words WordsOfVarying(const MeanShift& shift, const DeviationColumns& own,
                     const Problem& problem);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_EXPLANATION_WORDS_H_
