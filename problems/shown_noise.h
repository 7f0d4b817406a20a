#ifndef HINDSIGHT_PROBLEMS_SHOWN_NOISE_H_
#define HINDSIGHT_PROBLEMS_SHOWN_NOISE_H_

#include <vector>

#include "dataset/dataset.h"
#include "evaluation/explanation.h"
#include "evaluation/innovation_test.h"
#include "problems/linearisation.h"
#include "timeline/problem.h"

namespace hindsight {

/// Whether a sensor states kDoubtfulError times what its innovations say, or more,
/// beyond chance.
bool StateTooMuch(const std::vector<NormalisedInnovation>& innovations,
                  double false_alarms);

/// What would explain the innovations if the sigmas of the sensors that state
/// kDoubtfulError times what theirs say or more, beyond chance, were that small:
/// their root mean square, or what the largest of them allows, again until it is
/// one. Sigmas that are far too large hide what is wrong with the IMU and the
/// other sensors. The innovations are then to be white as well: where sums of them
/// are larger than chance explains, Explanation::z is divided by that excess. What
/// matters is measured as it is stated: Explanation::effect in sigmas of
/// `solution`, of position, velocity and attitude; beside other errors that are
/// far smaller, errors of kDoubtfulError are a shift of as many sigmas. None where
/// no sigma is too large. `innovations` are of `problem` as it is stated.
std::vector<Explanation> ExplainByShownNoise(
    const Dataset& dataset, const Relinearised& solution,
    const std::vector<NormalisedInnovation>& innovations, double false_alarms,
    const Problem& problem, const EpochCallback& callback = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_SHOWN_NOISE_H_
