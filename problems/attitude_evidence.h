#ifndef HINDSIGHT_PROBLEMS_ATTITUDE_EVIDENCE_H_
#define HINDSIGHT_PROBLEMS_ATTITUDE_EVIDENCE_H_

#include <optional>
#include <string>
#include <vector>

#include "attitude/attitude_run.h"
#include "evaluation/grade.h"
#include "evaluation/innovation_test.h"
#include "measurements/sensor.h"
#include "state/solution.h"

namespace hindsight {

/// What the innovations of attitude alone are of, by AttitudeInnovation::Source.
std::vector<Sensor> JudgedSources();

/// Those of a run, in order of time; their index is the time since the first
/// [us].
std::vector<NormalisedInnovation> InnovationsOf(const AttitudeRun& run);

/// What a solution started from: x with P, whose first components are those of
/// the layout. A heading that is zero by definition counts as not known.
StartValues StartOf(const ErrorLayout& layout, const AttitudeState::Matrix& P,
                    const State& x, const InitialState& given);

/// Compares the methods: the same readings have one truth, which the errors that
/// both state must hold.
class AttitudeComparison {
 public:
  /// Evidence that makes `solution` doubtful: an earlier one from which a
  /// component of the attitude is kUnusableBias of the larger standard deviation
  /// away, in the root mean square over the interval.
  std::optional<Evidence> Compare(const Solution& solution,
                                  const Eigen::Quaterniond& q_en);

 private:
  struct Course {
    std::string method;
    std::vector<Eigen::Quaterniond> q_nb = {};
    std::vector<Eigen::Vector3d> variances = {};  ///< of psi, in n [rad^2]
  };

  std::vector<Course> courses_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ATTITUDE_EVIDENCE_H_
