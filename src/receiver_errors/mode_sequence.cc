#include "receiver_errors/mode_sequence.h"

#include <algorithm>
#include <cmath>

namespace hindsight {
namespace {

// Expected numbers of changes in a record that is all of one mode, the prior of a
// Markov chain. Orders of magnitude: errors are rare, and end; a velocity step is
// likelier than a drift. A factor of ten is 2.3 in the logarithm of a posterior,
// of which an error of three sigmas over ten fixes has 45.
constexpr double kJumps = 1.0;          // a good receiver becomes biased
constexpr double kSlights = 1.0;        // a receiver becomes slightly biased
constexpr double kDrifts = 0.2;         // a good receiver begins to drift
constexpr double kStops = 0.2;          // a drift stops, its error stays
constexpr double kVelocitySteps = 2.0;  // the velocity of the IMU jumps
constexpr double kChanges = 3.0;  // a biased receiver jumps to another bias
constexpr double kBends = 0.001;  // a drifting one gets another rate

// Of the ten recordings with a receiver that data/README.md lists all begin well:
// Laplace's rule of succession.
constexpr double kBeginsWell = 11.0 / 12.0;

constexpr ErrorStep kStayGood = {ErrorMode::kGood};
constexpr ErrorStep kGoOnBiased = {ErrorMode::kBiased};
constexpr ErrorStep kJump = {ErrorMode::kBiased, true};
constexpr ErrorStep kGoOnSlight = {ErrorMode::kSlight};
constexpr ErrorStep kSlightJump = {ErrorMode::kSlight, true};
constexpr ErrorStep kGoOnDrifting = {ErrorMode::kDrifting};
constexpr ErrorStep kBeginDrift = {ErrorMode::kDrifting, true};

}  // namespace

bool IsGoodThroughout(const ModeSequence& sequence) {
  return std::ranges::all_of(
      sequence, [](const ErrorStep& s) { return s.mode == ErrorMode::kGood; });
}

std::vector<ErrorMode> ModeOrder(const ModeSequence& sequence) {
  std::vector<ErrorMode> order;
  ErrorMode mode = ErrorMode::kGood;
  for (const ErrorStep& step : sequence) {
    if (step.anew || step.mode != mode) order.push_back(step.mode);
    mode = step.mode;
  }
  return order;
}

bool BeginsAtSomeTime(ErrorStep step) {
  return step.velocity_step || (step.anew && step.mode == ErrorMode::kDrifting);
}

ErrorStep WithoutVelocityStep(ErrorStep step) {
  step.velocity_step = false;
  if (!BeginsAtSomeTime(step)) step.onset = Onset::kUsual;
  return step;
}

double LogTransition(ErrorMode before, ErrorStep step, double share) {
  const double of_onset = LogPriorOf(step.onset);
  step.outlier = false;
  step.onset = Onset::kUsual;
  const bool good = before == ErrorMode::kGood;
  const bool small = good || before == ErrorMode::kSlight;
  const double jumps = small ? kJumps : kChanges;
  const double drifts = small ? kDrifts : kBends;
  const double stops = before == ErrorMode::kDrifting ? kStops : 0.0;
  const double ends = good ? 0.0 : kEndsOfAnError;
  const double all = jumps + kSlights + drifts + stops + ends + kVelocitySteps;
  const auto log_of = [&](double rate) {
    return std::log(rate / all * -std::expm1(-all * share)) + of_onset;
  };
  if (step == kJump) return log_of(jumps);
  if (step == kSlightJump) return log_of(kSlights);
  if (step == kBeginDrift) return log_of(drifts);
  if (step.velocity_step) return log_of(kVelocitySteps);
  if (step.mode == before) return -all * share;
  return log_of(step == kStayGood ? kEndsOfAnError : kStops);
}

double LogFirst(ErrorStep step, double share) {
  const double of_onset = LogPriorOf(step.onset);
  step.outlier = false;
  step.onset = Onset::kUsual;
  // Shares of time in the stationary distribution of the transitions.
  constexpr double kBiased = kJumps / kEndsOfAnError;
  constexpr double kSlight = kSlights / kEndsOfAnError;
  constexpr double kDrifting = kDrifts / (kEndsOfAnError + kStops);
  constexpr double kOfWell = kBeginsWell / (1.0 + kSlight);
  constexpr double kOfErring = (1.0 - kBeginsWell) / (kBiased + kDrifting);
  if (step == kStayGood) return std::log(kOfWell);
  if (step == kSlightJump) return std::log(kOfWell * kSlight);
  if (step == kJump) return std::log(kOfErring * kBiased);
  if (step == kBeginDrift) return std::log(kOfErring * kDrifting) + of_onset;
  return LogTransition(ErrorMode::kGood, step, share) + of_onset;
}

double LogOddsOfBeginningWell() {
  constexpr double kAny = 0.05;
  return LogFirst(kStayGood, kAny) - LogFirst(kJump, kAny) -
         std::log(kEndsOfAnError / kJumps);
}

double LogOddsOfAnotherBias() { return std::log(kChanges / kJumps); }

double LogOfVelocitySteps(int count) {
  constexpr double kRarer = 4.605170185988092;  // ln 100
  return -0.5 * kRarer * count * (count - 1);
}

int CountVelocitySteps(const ModeSequence& sequence) {
  return static_cast<int>(
      std::count_if(sequence.begin(), sequence.end(),
                    [](const ErrorStep& s) { return s.velocity_step; }));
}

std::vector<ErrorStep> StepsAfter(ErrorMode before) {
  const ErrorStep stepping = {before, false, true};
  switch (before) {
    case ErrorMode::kGood:
      return {kStayGood, stepping, kJump, kSlightJump, kBeginDrift};
    case ErrorMode::kBiased:
      return {kGoOnBiased, stepping,    kStayGood,
              kJump,       kSlightJump, kBeginDrift};
    case ErrorMode::kSlight:
      return {kGoOnSlight, stepping,    kStayGood,
              kJump,       kSlightJump, kBeginDrift};
    case ErrorMode::kDrifting:
      return {kGoOnDrifting, stepping,    kStayGood,  kGoOnBiased,
              kJump,         kSlightJump, kBeginDrift};
  }
  return {};
}

std::vector<ErrorStep> StepsByNode(const SensorTape& tape,
                                   const ModeSequence& sequence) {
  std::vector<ErrorStep> steps;
  ErrorStep step;
  auto next = sequence.begin();
  for (std::size_t k = 0; k < tape.size(); ++k) {
    step = {step.mode};
    if (tape.HasFix(k)) step = *next++;
    steps.push_back(step);
  }
  return steps;
}

}  // namespace hindsight
