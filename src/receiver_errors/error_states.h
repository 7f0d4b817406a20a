#ifndef HINDSIGHT_RECEIVER_ERRORS_ERROR_STATES_H_
#define HINDSIGHT_RECEIVER_ERRORS_ERROR_STATES_H_

#include <string>
#include <vector>

#include "receiver_errors/error_regimes.h"
#include "receiver_errors/history_alternatives.h"
#include "state/block_step.h"
#include "timeline/problem.h"

namespace hindsight {

/// The error (e, r) of a receiver, as one history has it, as states of a
/// problem: e is a block kColouredNoise, r a block kErrorRate.
class ErrorStates {
 public:
  /// All arguments must outlive the object.
  ErrorStates(const LinearTape& tape, int receiver, double stated_sigma,
              ErrorRegimes::Kind kind, const HistoryAlternative& chosen);

  /// Puts e and r behind all other blocks, as far as the history has them, with
  /// their steps, and gives the receiver's fixes the sigma and loss as found.
  void Extend(Problem* problem) const;

  /// The smoothed trajectory of the history, over the extended layout.
  std::vector<State> States(const ErrorLayout& layout) const;

 private:
  bool HasError() const { return kind_ != ErrorRegimes::Kind::kWhite; }
  bool HasRate() const;
  void ApplyToSensor(Timeline* timeline) const;
  void AddBlock(BlockKind kind, const std::string& name, const char* unit,
                double sigma0, ErrorLayout* layout) const;
  /// Over the interval into node k. Where e does not drift r is drawn anew, so
  /// that it is free where a drift begins.
  std::vector<BlockStep> StepsTo(std::size_t k) const;

  const LinearTape& tape_;
  int receiver_;
  double floor_;  ///< sigma of e where the receiver is good [m]
  ErrorRegimes::Kind kind_;
  const HistoryAlternative& chosen_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_ERROR_STATES_H_
