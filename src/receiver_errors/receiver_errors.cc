#include "receiver_errors/receiver_errors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "receiver_errors/error_regimes.h"
#include "receiver_errors/error_states.h"
#include "receiver_errors/error_tuning.h"
#include "receiver_errors/history_alternatives.h"
#include "receiver_errors/history_words.h"

namespace hindsight {

struct ReceiverErrors::Findings {
  Findings(const Problem& problem, const LinearTape& linear, int index,
           std::function<void()> poll);
  bool switching() const {
    return regimes.kind == ErrorRegimes::Kind::kSwitching;
  }
  ErrorStates states() const {
    return {tape, receiver, stated_sigma, regimes.kind, chosen};
  }

  const LinearTape& tape;
  int receiver;
  std::string name;     ///< of the sensor
  double stated_sigma;  ///< of its fixes, an axis [m]
  ErrorRegimes regimes;
  std::vector<HistoryAlternative> alternatives;
  const HistoryAlternative& chosen;  ///< one of them
};

namespace {

/// Root mean square of the stated sigmas of the receiver, north and east [m].
double StatedSigma(const Timeline& timeline, int receiver) {
  double sum = 0.0;
  int count = 0;
  for (const Measurement& z : timeline.all_measurements()) {
    const auto* fix = std::get_if<PositionFix>(&z.model);
    if (fix == nullptr || z.sensor != receiver) continue;
    sum += 0.5 * (fix->R_n(0, 0) + fix->R_n(1, 1));
    ++count;
  }
  return std::sqrt(sum / std::max(1, count));
}

}  // namespace

ReceiverErrors::Findings::Findings(const Problem& problem,
                                   const LinearTape& linear, int index,
                                   std::function<void()> poll)
    : tape(linear),
      receiver(index),
      name(problem.timeline.sensors()[static_cast<std::size_t>(index)].name),
      stated_sigma(StatedSigma(problem.timeline, index)),
      regimes(ChooseRegimes(
          {tape, receiver, stated_sigma,
           problem.layout.Has(BlockKind::kColouredNoise, receiver),
           std::move(poll)})),
      alternatives(WeighHistories(tape, receiver, regimes)),
      chosen(MostCentral(alternatives)) {}

ReceiverErrors::ReceiverErrors(std::unique_ptr<const Findings> found)
    : found_(std::move(found)) {}
ReceiverErrors::ReceiverErrors(ReceiverErrors&&) noexcept = default;
ReceiverErrors& ReceiverErrors::operator=(ReceiverErrors&&) noexcept = default;
ReceiverErrors::~ReceiverErrors() = default;

void ReceiverErrors::Extend(Problem* problem) const {
  found_->states().Extend(problem);
}

std::vector<State> ReceiverErrors::States(const ErrorLayout& layout) const {
  return found_->states().States(layout);
}

void ReceiverErrors::Widen(CovarianceSeries* P) const {
  const int dim = found_->tape.dim();
  for (std::size_t k = 0; k < found_->tape.size(); ++k) {
    ErrorMatrix P_k = P->Get(k);
    P_k.topLeftCorner(dim, dim) +=
        Spread(found_->alternatives, found_->chosen, k, dim);
    P->Set(k, P_k);
  }
}

std::vector<std::string> ReceiverErrors::Notes(
    const CovarianceSeries& P) const {
  std::vector<std::string> notes =
      DescribeParameters(found_->regimes.kind, found_->chosen);
  if (found_->switching()) {
    std::vector<double> times;
    for (std::size_t k = 0; k < found_->tape.size(); ++k) {
      times.push_back(found_->tape.epoch(k).t);
    }
    notes.push_back(DescribeHistory(found_->chosen.steps, times));
    const RivalHistory rival =
        FindRival(found_->alternatives, found_->chosen, P);
    std::string other = DescribeRival(rival, times);
    if (!other.empty()) notes.push_back(std::move(other));
  }
  for (std::string& note : notes) note.insert(0, found_->name + ": ");
  return notes;
}

ModePart ReceiverErrors::Modes() const {
  ModePart modes;
  modes.names = {"good", "biased", "drifting", "slight"};
  modes.probabilities.assign(found_->tape.size(), Eigen::VectorXd::Zero(4));
  for (std::size_t k = 0; k < modes.probabilities.size(); ++k) {
    for (const HistoryAlternative& one : found_->alternatives) {
      modes.probabilities[k](static_cast<int>(one.steps[k].mode)) += one.weight;
    }
  }
  return modes;
}

std::vector<double> ReceiverErrors::Trust() const {
  std::vector<double> trust(found_->tape.size(), 1.0);
  if (!found_->switching()) return trust;
  const ModePart modes = Modes();
  for (std::size_t k = 0; k < trust.size(); ++k) {
    trust[k] = modes.probabilities[k](static_cast<int>(ErrorMode::kGood));
  }
  return trust;
}

std::vector<BoundedValue> ReceiverErrors::Bounded() const {
  const ScoredHistory& likeliest = found_->regimes.histories.front();
  return BoundedParameters(likeliest.history, likeliest.parameters);
}

ReceiverErrors FindReceiverErrors(const Problem& problem,
                                  const LinearTape& tape, int receiver,
                                  std::function<void()> poll) {
  return ReceiverErrors(std::make_unique<const ReceiverErrors::Findings>(
      problem, tape, receiver, std::move(poll)));
}

}  // namespace hindsight
