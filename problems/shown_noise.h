#ifndef HINDSIGHT_PROBLEMS_SHOWN_NOISE_H_
#define HINDSIGHT_PROBLEMS_SHOWN_NOISE_H_

#include <vector>

#include "dataset/dataset.h"
#include "evaluation/explanation.h"
#include "evaluation/innovation_test.h"
#include "problems/linearisation.h"
#include "timeline/problem.h"

namespace hindsight {

/// What would explain the innovations if the sigmas of the sensors whose
/// innovations are smaller than stated by kDoubtfulError or more, beyond chance,
/// were what the innovations say: multiplied by their root mean square, again
/// until it is one. Sigmas that are far too large hide what is wrong with the IMU
/// and the other sensors, and with them a state that is more than its own sigmas
/// off. What matters is measured in these: Explanation::effect in sigmas of
/// `solution`, as it is stated, of position, velocity and attitude. None where no
/// sigma is too large. `innovations` are of `problem` as it is stated.
std::vector<Explanation> ExplainByShownNoise(
    const Dataset& dataset, const Relinearised& solution,
    const std::vector<NormalisedInnovation>& innovations, double false_alarms,
    const Problem& problem, const EpochCallback& callback = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_SHOWN_NOISE_H_
