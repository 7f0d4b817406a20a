#ifndef HINDSIGHT_STATE_RIVAL_SOLUTION_H_
#define HINDSIGHT_STATE_RIVAL_SOLUTION_H_

#include <optional>
#include <string>
#include <vector>

#include "state/state.h"

namespace hindsight {

/// Another explanation of the data than the one that a solution is: the whole
/// interval, solved from another clock, heading, mounting... to its own end.
struct RivalSolution {
  /// In which quantity it differs, and by how much: rival minus chosen.
  struct Difference {
    std::string quantity;  ///< "rtk_time_offset", "heading", ...
    double value = 0.0;
    std::string unit;  ///< SI: "s", "rad", ...
  };
  /// "clock of rtk 1.36 s later and heading turned by 178 deg".
  std::string description;
  /// What to change in the data if it is the right one; empty: nothing that one
  /// could know.
  std::string remedy = {};
  std::vector<Difference> differences;
  /// ln of its evidence over that of the chosen solution, both of the same
  /// measurements with all priors in them; above 0 only of one that is told and
  /// never chosen.
  double log_evidence = 0.0;
  /// Posterior probability among the chosen solution and all its rivals, which
  /// are equally likely beforehand but for the priors in the evidence.
  double probability = 0.0;
  std::optional<State> final_state;  ///< where it ends
};

/// Sets the probabilities by the evidence and puts the likeliest first.
void SetProbabilities(std::vector<RivalSolution>* rivals);

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_RIVAL_SOLUTION_H_
