#ifndef HINDSIGHT_PROBLEMS_EXPLANATION_EFFECT_H_
#define HINDSIGHT_PROBLEMS_EXPLANATION_EFFECT_H_

#include <vector>

#include "evaluation/explanation.h"
#include "filters/linear_tape.h"
#include "problems/linearisation.h"

namespace hindsight {

/// Which components an effect is looked for in: all, or position, velocity and
/// attitude, of which alone Relinearised has the sigmas.
enum class EffectOn { kAll, kNavigation };

/// By what `size` times a correction of every epoch of `tape`, a column each, moves the solution
/// `anew`, of constants in the sigmas of the tape: into Explanation::effect where
/// it is more than what is there.
void AddEffect(const Eigen::MatrixXd& correction, double size,
               const Relinearised& anew, const LinearTape& tape, EffectOn on,
               Explanation* out);

/// The same of an IMU whose clock runs `size` [s/s] faster than all others from
/// the first epoch on: if the others are right, what the solution says of a time
/// is what was true at another. Nothing where the layout has no navigation state.
void AddEffectOfClock(double size, const Relinearised& anew,
                      const ErrorLayout& layout, Explanation* out);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_EXPLANATION_EFFECT_H_
