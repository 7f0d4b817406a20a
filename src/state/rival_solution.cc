#include "state/rival_solution.h"

#include <algorithm>
#include <cmath>

namespace hindsight {

void SetProbabilities(std::vector<RivalSolution>* rivals) {
  double sum = 1.0;
  for (const RivalSolution& rival : *rivals) {
    sum += std::exp(rival.log_evidence);
  }
  for (RivalSolution& rival : *rivals) {
    rival.probability = std::exp(rival.log_evidence) / sum;
  }
  std::stable_sort(rivals->begin(), rivals->end(),
                   [](const RivalSolution& a, const RivalSolution& b) {
                     return a.log_evidence > b.log_evidence;
                   });
}

}  // namespace hindsight
