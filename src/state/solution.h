#ifndef HINDSIGHT_STATE_SOLUTION_H_
#define HINDSIGHT_STATE_SOLUTION_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "state/covariance_series.h"
#include "state/error_layout.h"
#include "state/evidence.h"
#include "state/method_parts.h"
#include "state/rival_solution.h"
#include "state/state.h"

namespace hindsight {

/// What an estimator made of one measurement.
struct ResidualRecord {
  double t = 0.0;
  int sensor = 0;         ///< index into Dataset::streams
  bool accepted = true;   ///< false: rejected by the gate
  bool withheld = false;  ///< true: predicted, not used
  /// Of a robust loss or of modes, 1 = full; 0 if rejected.
  double weight = 1.0;
  RowVector residual;  ///< measured - predicted, in the model's axes
  /// Predicted standard deviation of `residual`, with the stated R.
  RowVector sigma;
  double nis = 0.0;  ///< residual' S^-1 residual
};

/// An estimated constant (scale factor, lever arm component, time offset...).
struct ConstantEstimate {
  enum class Verdict { kObserved, kWeak, kUnobserved };
  std::string name;  ///< "odometer_scale", "gnss_lever_arm[x]", ...
  std::string unit;
  double value = 0.0;
  double sigma = 0.0;
  double prior_value = 0.0;
  double prior_sigma = 0.0;
  /// The factor in `sigma` by which it is larger than P says, for noise that is
  /// larger than stated or correlated.
  double widened = 1.0;
  Verdict verdict = Verdict::kObserved;
  std::string advice;  ///< for a weak one, the motion that would help
};

/// A state that the data do not determine, over a time span.
struct UnobservedSpan {
  std::string component;
  double t_begin = 0.0;
  double t_end = 0.0;
  double sigma = 0.0;  ///< the smallest reached in the span, SI
  double limit = 0.0;  ///< above which it counts as not observed, SI
};

/// What a search within bounds found.
struct BoundedValue {
  std::string name;
  std::string unit;
  double value = 0.0;
  double least = 0.0;
  double most = 0.0;
};

/// What one estimator made of a data set: the trajectory at the nodes with
/// covariances over `layout` (NED-resolved, metres, m/s, radians).
struct Solution {
  std::string method;  ///< "ekf", "rts", "iterated", "batch", ...
  ErrorLayout layout;
  std::vector<State> states;
  CovarianceSeries covariances;  ///< same length as states, or empty
  std::vector<ResidualRecord> residuals;
  std::vector<ConstantEstimate> constants;
  std::vector<UnobservedSpan> unobserved;
  /// What a self-tuning method made of the sensors' noise, in words.
  std::vector<std::string> notes;
  /// Other explanations of the same data, the likeliest first.
  std::vector<RivalSolution> rivals;
  // What only methods of one kind have.
  std::optional<TwoFilterPart> two_filter;
  std::optional<ModePart> modes;
  std::optional<AttitudePart> attitude;
  std::optional<ObserverFigures> observer;
  /// Of a method that at each node knows nothing later: between nodes its state
  /// is what the one before predicts.
  bool forward = false;
  bool converged = true;
  int iterations = 0;    ///< 0 for a method that does not iterate
  double seconds = 0.0;  ///< processor time of the method alone
  /// Sensors of which the method took no measurement, as its evidence says.
  std::vector<int> left_out;
  /// Estimates that were sought within bounds.
  std::vector<BoundedValue> bounded;
  Grade grade = Grade::kUsable;
  std::vector<Evidence> evidence;  ///< what `grade` is concluded from
  /// What comparing it with earlier methods shows of either, by method
  /// (ShareFindings).
  std::vector<std::pair<std::string, Evidence>> compared;
  std::string verdict;  ///< in words: the grade, and why

  bool usable() const { return grade == Grade::kUsable; }
};

/// All of a solution that is no series over its states or measurements.
inline Solution WithoutSeries(const Solution& solution) {
  Solution out;
  out.method = solution.method;
  out.layout = solution.layout;
  out.constants = solution.constants;
  out.unobserved = solution.unobserved;
  out.notes = solution.notes;
  out.observer = solution.observer;
  out.forward = solution.forward;
  out.converged = solution.converged;
  out.iterations = solution.iterations;
  out.seconds = solution.seconds;
  out.grade = solution.grade;
  out.evidence = solution.evidence;
  out.compared = solution.compared;
  out.verdict = solution.verdict;
  return out;
}

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_SOLUTION_H_
