#ifndef HINDSIGHT_PROBLEMS_LEAVE_ONE_OUT_H_
#define HINDSIGHT_PROBLEMS_LEAVE_ONE_OUT_H_

#include <span>
#include <vector>

#include "dataset/dataset.h"
#include "evaluation/contradicted_sensor.h"
#include "evaluation/explanation.h"
#include "filters/linear_tape.h"
#include "problems/linearisation.h"
#include "timeline/problem.h"

namespace hindsight {

/// Leaves out each of some sensors in turn, and the a priori values, of start
/// and constants together, that the solution ends StrainLimit sigmas from, about
/// the states of a solution, of which `all` is the tape: without which one does
/// all else fit, each test with kFalseAlarms? A
/// sensor is not named where a deviation of the IMU or of a state is among
/// `explanations` that is likelier than any of its own. The effect is infinite
/// where the layout has no navigation state. `problem` is as before afterwards;
/// `callback` hears of each epoch of each pass.
LeftOutSensor LeaveOneOut(const Dataset& dataset, const Relinearised& solution,
                          const LinearTape& all, std::span<const int> sensors,
                          const std::vector<Explanation>& explanations,
                          Problem* problem, const EpochCallback& callback);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_LEAVE_ONE_OUT_H_
