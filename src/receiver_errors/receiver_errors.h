#ifndef HINDSIGHT_RECEIVER_ERRORS_RECEIVER_ERRORS_H_
#define HINDSIGHT_RECEIVER_ERRORS_RECEIVER_ERRORS_H_

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "filters/linear_tape.h"
#include "state/solution.h"
#include "timeline/problem.h"

namespace hindsight {

/// What the errors of one position receiver are like, as FindReceiverErrors
/// found them: the noise of its fixes, and beyond noise the histories of its
/// error that the data do not rule out, of which one is chosen.
class ReceiverErrors {
 public:
  ReceiverErrors(ReceiverErrors&&) noexcept;
  ReceiverErrors& operator=(ReceiverErrors&&) noexcept;
  ~ReceiverErrors();

  /// Gives the problem that was asked about what was found: to the receiver's
  /// fixes their sigma and a two-component mixture as loss; behind all other
  /// blocks of the layout the receiver's error e [m, NED] and, if it drifts,
  /// its rate [m/s], which go from node to node as the chosen history says
  /// (Timeline::SetBlockSteps). White errors bring no blocks.
  void Extend(Problem* problem) const;

  /// The smoothed trajectory of the chosen history, a state a node, over the
  /// layout of the extended problem.
  std::vector<State> States(const ErrorLayout& layout) const;

  /// Adds to the covariances of the chosen history's solution, a node each, how
  /// far the other histories take the trajectory elsewhere, weighed by their
  /// probabilities.
  void Widen(CovarianceSeries* P) const;

  /// What was found, in words; `P` as it was before Widen.
  std::vector<std::string> Notes(const CovarianceSeries& P) const;

  /// By node, how probable it is that the receiver is good, biased, drifting or
  /// slightly biased.
  ModePart Modes() const;

  /// By node, the probability that a fix is taken at its word: that it is good,
  /// where the receiver is not so throughout; else 1.
  std::vector<double> Trust() const;

  /// Parameters of the likeliest history that were sought within bounds.
  std::vector<BoundedValue> Bounded() const;

 private:
  struct Findings;
  explicit ReceiverErrors(std::unique_ptr<const Findings> found);
  friend ReceiverErrors FindReceiverErrors(const Problem& problem,
                                           const LinearTape& tape, int receiver,
                                           std::function<void()> poll);

  std::unique_ptr<const Findings> found_;
};

/// Finds out from the data alone what the errors of a position sensor are like:
/// white, Gauss-Markov, or good at times and at others biased or drifting; each
/// with outliers. `tape` is the problem linearised about one fixed trajectory
/// and must outlive what is returned; `receiver` is the index of the sensor. If
/// the layout has a Gauss-Markov error of the receiver already, only white
/// errors are fitted. `poll` is called between the steps of the search and may
/// throw to end it. Throws EstimationError if the noise of a measurement is not
/// positive definite.
ReceiverErrors FindReceiverErrors(const Problem& problem,
                                  const LinearTape& tape, int receiver,
                                  std::function<void()> poll);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_RECEIVER_ERRORS_H_
