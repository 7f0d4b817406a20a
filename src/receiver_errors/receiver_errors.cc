#include "receiver_errors/receiver_errors.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "base/text.h"
#include "receiver_errors/error_tuning.h"
#include "receiver_errors/hypothesis_words.h"
#include "receiver_errors/sensor_findings.h"
#include "receiver_errors/sequence_smoother.h"

namespace hindsight {
namespace {

/// Of rivals: odds of 10^(1/2) against them.
constexpr double kComparable = 1.0 / (1.0 + 3.1622776601683795);

/// Of a rival beyond what the covariances hold: odds of a thousand against it.
constexpr double kSure = 1e-3;

Evidence DoubtOf(const RivalHypothesis& rival, const SensorFindings& found,
                 const std::string& chosen, bool is_mean) {
  return {.grade = Grade::kDoubtful,
          .what = DescribeEither(
                      chosen,
                      DescribeSequence(rival.hypothesis->steps, found.Times(),
                                       SizesOf(*rival.hypothesis,
                                               found.tape.dim(), found.unit)),
                      rival.probability, rival.distance) +
                  (is_mean ? ": the result is the mean, weighed by their "
                             "probabilities"
                           : ""),
          .value = rival.probability,
          .limit = is_mean ? kComparable : kSure,
          .unit = "probability",
          .causes = {"errors that explain the data as well in two ways"},
          .remedies = {"another sensor of positions, or a stream with a "
                       "position that is known"}};
}

}  // namespace

std::string DescribeEither(const std::string& chosen, const std::string& other,
                           double probability, double distance) {
  return fmt::format("{} likely up to {:.3g} m off: {}; or {} {}",
                     FormatProbability(probability), distance, chosen,
                     probability > 0.5 ? "rather" : "else", other);
}

ReceiverErrors::ReceiverErrors(std::shared_ptr<const SensorFindings> found)
    : found_(std::move(found)) {
  if (!found_->stands()) return;
  sizes_ = SizesOf(found_->chosen(), found_->tape.dim(), found_->unit).by_node;
}

bool ReceiverErrors::Stands() const { return found_->stands(); }

bool ReceiverErrors::WasEnded() const { return found_->stopped; }

bool ReceiverErrors::IsUnfitted() const { return found_->unfitted; }

int ReceiverErrors::sensor() const { return found_->sensor; }

double ReceiverErrors::log_gain() const { return found_->gain; }

void ReceiverErrors::Extend(Problem* problem) const {
  found_->states().Extend(problem);
}

bool ReceiverErrors::Expect(Problem* problem) const {
  const std::optional<ErrorParameters>& expected = found_->regimes.expected;
  if (!Stands() || !expected) return false;
  found_->states().Replace(*expected, problem);
  return true;
}

std::vector<State> ReceiverErrors::States(const ErrorLayout& layout) const {
  return found_->states().States(layout);
}

std::optional<Evidence> ReceiverErrors::Average(const ErrorLayout& layout,
                                                std::vector<State>* states,
                                                CovarianceSeries* P) const {
  const WeighedHypothesis& chosen = found_->chosen();
  const RivalHypothesis rival = FindRival(found_->alternatives, chosen, *P);
  const bool comparable = rival.probability > kComparable ||
                          (found_->errant_start && rival.probability > 0.0);
  const ErrorStates own = found_->states();
  const int dim = found_->tape.dim();
  for (std::size_t k = 0; k < found_->tape.size(); ++k) {
    ErrorMatrix P_k = P->Get(k);
    P_k.topLeftCorner(dim, dim) += Spread(found_->alternatives, chosen, k, dim);
    if (comparable) {
      const ErrorVector mean = MeanFrom(found_->alternatives, chosen, k);
      P_k.topLeftCorner(dim, dim) -=
          mean.head(dim) * mean.head(dim).transpose();
      (*states)[k] = own.Moved(layout, (*states)[k], mean);
    }
    P->Set(k, P_k);
  }
  if (comparable && found_->IsLarge(rival.distance)) {
    return DoubtOf(rival, *found_, InWords(), true);
  }
  if (comparable) return std::nullopt;
  const RivalHypothesis beyond =
      FindRivalBeyond(found_->alternatives, chosen, *P);
  if (beyond.probability < kSure) return std::nullopt;
  return DoubtOf(beyond, *found_, InWords(), false);
}

bool ReceiverErrors::IsUndecided() const { return !found_->undecided.empty(); }

std::optional<Evidence> ReceiverErrors::DoubtOfNoise(
    const CovarianceSeries& P) const {
  if (!IsUndecided()) return std::nullopt;
  const WeighedHypothesis noise = found_->SmoothNoise();
  for (WeighedHypothesis& one : found_->SmoothUndecided()) {
    const std::vector<WeighedHypothesis> maybe = {std::move(one)};
    RivalHypothesis rival = FindRivalBeyond(maybe, noise, P);
    if (rival.hypothesis == nullptr && maybe.front().weight > kComparable) {
      rival = FindRival(maybe, noise, P);
      if (!found_->IsLarge(rival.distance)) rival.hypothesis = nullptr;
    }
    if (rival.hypothesis == nullptr) continue;
    return DoubtOf(rival, *found_,
                   Stands() ? InWords() : found_->name + ": as stated", false);
  }
  return std::nullopt;
}

void ReceiverErrors::TakeSizes(const ErrorLayout& layout,
                               const std::vector<State>& states) {
  const Block* error = layout.Find(BlockKind::kSensorError, sensor());
  if (error == nullptr) return;
  for (std::size_t k = 0; k < sizes_.size(); ++k) {
    sizes_[k] = states[k].parameters.segment<3>(error->parameter_offset).norm();
  }
}

ModePart ReceiverErrors::Modes() const {
  ModePart modes;
  modes.names = {"good", "biased", "drifting", "slight"};
  modes.probabilities.assign(found_->tape.size(), Eigen::VectorXd::Zero(4));
  for (std::size_t k = 0; k < modes.probabilities.size(); ++k) {
    for (const WeighedHypothesis& one : found_->alternatives) {
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
  const Hypothesis& likeliest = found_->regimes.hypotheses.front();
  return BoundedParameters(likeliest.sequence, likeliest.parameters,
                           found_->is_tolerance);
}

double ReceiverErrors::MeanSquareDistanceTo(const ReceiverErrors& other) const {
  return MeanSquareDistance(found_->chosen().smoothed,
                            other.found_->chosen().smoothed);
}

bool ReceiverErrors::IsApart(const ReceiverErrors& other,
                             const CovarianceSeries& P) const {
  return Separate(other.found_->chosen(), found_->chosen(), P).significant;
}

bool ReceiverErrors::AverageWith(const std::vector<RivalSensor>& others,
                                 const ErrorLayout& layout,
                                 std::vector<State>* states,
                                 CovarianceSeries* P) const {
  const ErrorStates own = found_->states();
  const int dim = found_->tape.dim();
  double together = 0.0;
  for (const RivalSensor& other : others) together += other.probability;
  const bool comparable = states != nullptr && together > kComparable;
  for (std::size_t k = 0; k < found_->tape.size(); ++k) {
    const ErrorVector& chosen = found_->chosen().smoothed[k];
    // If another errs, this sensor does not.
    ErrorVector mean = -together * chosen;
    ErrorMatrix P_k = P->Get(k);
    for (const RivalSensor& other : others) {
      const auto there = other.errors->found_->chosen().smoothed[k].head(dim);
      const ErrorVector d = there - chosen.head(dim);
      mean.head(dim) += other.probability * there;
      P_k.topLeftCorner(dim, dim) += other.probability * d * d.transpose();
    }
    if (comparable) {
      P_k.topLeftCorner(dim, dim) -=
          mean.head(dim) * mean.head(dim).transpose();
      (*states)[k] = own.Moved(layout, (*states)[k], mean);
    }
    P->Set(k, P_k);
  }
  return comparable;
}

double ReceiverErrors::imu_scale() const {
  return found_->chosen().parameters.imu_scale;
}

double ReceiverErrors::LogOfPrior() const { return found_->log_prior; }

bool ReceiverErrors::HasVelocitySteps() const {
  return found_->switching() &&
         std::ranges::any_of(found_->chosen().steps, &ErrorStep::velocity_step);
}

std::vector<ToldVelocityStep> ReceiverErrors::VelocitySteps() const {
  if (!HasVelocitySteps()) return {};
  return found_->states().VelocitySteps();
}

std::vector<double> ReceiverErrors::ChangeTimes() const {
  std::vector<double> times;
  if (!found_->switching()) return times;
  ErrorMode before = ErrorMode::kGood;
  for (std::size_t k = 0; k < found_->tape.size(); ++k) {
    const ErrorStep& step = found_->chosen().steps[k];
    if (step.anew || step.mode != before) times.push_back(found_->tape.t(k));
    before = step.mode;
  }
  return times;
}

double ReceiverErrors::searched_fixes() const {
  return static_cast<double>(found_->searched_fixes);
}

std::shared_ptr<const ErrorDecisions> ReceiverErrors::Decisions() const {
  return std::make_shared<const ErrorDecisions>(*found_);
}

std::string ReceiverErrors::name() const { return found_->name; }

}  // namespace hindsight
