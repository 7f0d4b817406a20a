#include "receiver_errors/receiver_errors.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "receiver_errors/error_tuning.h"
#include "receiver_errors/hypothesis_words.h"
#include "receiver_errors/sensor_findings.h"
#include "receiver_errors/sequence_smoother.h"

namespace hindsight {
namespace {

/// Fixes from `begin` to `end`, in all of which the sensor errs.
struct ErrantEnd {
  double begin = 0.0;  ///< [s]
  double end = 0.0;
  double share = 0.0;  ///< of the recording
};

/// Whether the sensor errs at each node: is biased or drifting, or by its slight
/// errors more than three stated sigmas off. Before its first fix it does what it
/// does there.
std::vector<char> ErrsAt(const SensorFindings& found) {
  constexpr double kSigmas = 3.0;
  const WeighedHypothesis& chosen = found.chosen();
  const int n = found.tape.dim();
  std::vector<char> errs;
  for (std::size_t k = 0; k < chosen.steps.size(); ++k) {
    const ErrorMode mode = chosen.steps[k].mode;
    const bool large =
        chosen.smoothed[k].segment<3>(n).norm() > kSigmas * found.stated_sigma;
    errs.push_back(mode != ErrorMode::kGood &&
                   (mode != ErrorMode::kSlight || large));
  }
  std::size_t first = 0;
  while (!HasFix(found.tape, first, found.sensor)) ++first;
  std::fill_n(errs.begin(), first, errs[first]);
  return errs;
}

/// The longer one of the stretches with the first and the last node in which it
/// errs; nothing where it does not, or does throughout.
ErrantEnd LongestErrantEnd(const std::vector<char>& errs,
                           const std::vector<double>& times) {
  const auto at_start = static_cast<std::size_t>(
      std::find(errs.begin(), errs.end(), 0) - errs.begin());
  if (at_start == errs.size()) return {};
  const auto at_end = static_cast<std::size_t>(
      std::find(errs.rbegin(), errs.rend(), 0) - errs.rbegin());
  const auto between = [&times](std::size_t from, std::size_t to) {
    const double share =
        (times[to] - times[from]) / (times.back() - times.front());
    return ErrantEnd{times[from], times[to], share};
  };
  const ErrantEnd begin = between(0, at_start > 0 ? at_start - 1 : 0);
  const ErrantEnd end = between(times.size() - std::max<std::size_t>(at_end, 1),
                                times.size() - 1);
  return end.share > begin.share ? end : begin;
}

/// ln of the odds a priori against the hypothesis with the good and the erroneous
/// fixes exchanged, of which the likelihood is the same: an erroneous stretch of
/// the share s has not ended with the probability exp(-kEndsOfAnError s).
double LogOddsOf(const ErrantEnd& errant) {
  return kEndsOfAnError * (1.0 - 2.0 * errant.share);
}
/// Twenty to one.
constexpr double kLeastLogOdds = 3.0;

Evidence DoubtOf(const std::string& name, const ErrantEnd& errant) {
  return {.grade = Grade::kDoubtful,
          .what = fmt::format(
              "{} errs from {:.0f} to {:.0f} s, or else all of its other fixes "
              "do: no other sensor tells positions",
              name, errant.begin, errant.end),
          .value = LogOddsOf(errant),
          .limit = kLeastLogOdds,
          .unit = "logarithm of the odds",
          .causes = {"a receiver that errs from the first fix, or to the last"},
          .remedies = {"a stream with a position that is known at the start or "
                       "the end"}};
}

/// Of rivals: odds of 10^(1/2) against them.
constexpr double kComparable = 1.0 / (1.0 + 3.1622776601683795);

Evidence DoubtOf(const RivalHypothesis& rival, const std::vector<double>& times,
                 const std::string& chosen) {
  return {.grade = Grade::kDoubtful,
          .what = fmt::format(
              "{}; or else, {:.2g} % likely and up to {:.3g} m away, {}: the "
              "result is the mean, weighed by their probabilities",
              chosen, 100.0 * rival.probability, rival.distance,
              DescribeSequence(rival.hypothesis->steps, times)),
          .value = rival.probability,
          .limit = kComparable,
          .unit = "probability",
          .causes = {"errors that explain the data as well in two ways"},
          .remedies = {"another sensor of positions, or a stream with a "
                       "position that is known"}};
}

}  // namespace

ReceiverErrors::ReceiverErrors(std::unique_ptr<const SensorFindings> found)
    : found_(std::move(found)) {}
ReceiverErrors::ReceiverErrors(ReceiverErrors&&) noexcept = default;
ReceiverErrors& ReceiverErrors::operator=(ReceiverErrors&&) noexcept = default;
ReceiverErrors::~ReceiverErrors() = default;

bool ReceiverErrors::Stands() const { return found_->stands(); }

int ReceiverErrors::sensor() const { return found_->sensor; }

double ReceiverErrors::log_gain() const { return found_->choice.gain; }

void ReceiverErrors::Extend(Problem* problem) const {
  found_->states().Extend(problem);
}

std::vector<State> ReceiverErrors::States(const ErrorLayout& layout) const {
  return found_->states().States(layout);
}

std::optional<Evidence> ReceiverErrors::Average(const ErrorLayout& layout,
                                                std::vector<State>* states,
                                                CovarianceSeries* P) const {
  const WeighedHypothesis& chosen = found_->chosen();
  const RivalHypothesis rival = FindRival(found_->alternatives, chosen, *P);
  const bool comparable = rival.probability > kComparable;
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
  if (!comparable) return std::nullopt;
  return DoubtOf(rival, found_->Times(), InWords());
}

std::vector<std::string> ReceiverErrors::Notes(
    const CovarianceSeries& P) const {
  std::vector<std::string> notes;
  if (found_->stands()) {
    notes = DescribeParameters(found_->regimes.kind, found_->unit,
                               found_->chosen());
    notes.push_back(fmt::format(
        "against the noise as stated the evidence is exp({:.3g}) to 1",
        found_->choice.gain));
  } else {
    notes.push_back("errors as stated");
  }
  for (const std::string& refused : found_->choice.refused) {
    notes.push_back(refused);
  }
  if (found_->stands() && found_->switching()) {
    const std::vector<double> times = found_->Times();
    notes.push_back(DescribeSequence(found_->chosen().steps, times));
    const RivalHypothesis rival =
        FindRival(found_->alternatives, found_->chosen(), P);
    std::string other = DescribeRival(rival, times);
    if (!other.empty()) notes.push_back(std::move(other));
  }
  for (std::string& note : notes) note.insert(0, found_->name + ": ");
  return notes;
}

std::vector<Evidence> ReceiverErrors::Doubts() const {
  std::vector<Evidence> doubts;
  if (found_->stopped) {
    doubts.push_back({.grade = Grade::kDoubtful,
                      .what = "the search for errors of " + found_->name +
                              " was ended before it was done (--max-time)",
                      .causes = {"less time than the recording needs"},
                      .remedies = {"a larger --max-time"}});
  }
  if (!found_->stands()) return doubts;
  if (found_->alone && found_->switching()) {
    const ErrantEnd errant = LongestErrantEnd(ErrsAt(*found_), found_->Times());
    if (errant.share > 0.0 && LogOddsOf(errant) < kLeastLogOdds) {
      doubts.push_back(DoubtOf(found_->name, errant));
    }
  }
  const double imu = found_->chosen().parameters.imu_scale;
  if (imu > kMisstatedImu) {
    doubts.push_back(
        {.grade = Grade::kDoubtful,
         .what =
             fmt::format("beside errors of {}, the noise of the IMU is {:.2g} "
                         "times as stated (limit {:.2g})",
                         found_->name, imu, kMisstatedImu),
         .value = imu,
         .limit = kMisstatedImu,
         .unit = "1",
         .causes = {"vibration, or noise of the IMU that is stated too small"},
         .remedies = {"'check --noise', and the noise that it finds"}});
  }
  return doubts;
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
  return BoundedParameters(likeliest.sequence, likeliest.parameters);
}

double ReceiverErrors::MeanSquareDistanceTo(const ReceiverErrors& other) const {
  return MeanSquareDistance(found_->chosen().smoothed,
                            other.found_->chosen().smoothed);
}

bool ReceiverErrors::IsApart(const ReceiverErrors& other,
                             const CovarianceSeries& P) const {
  return Separate(other.found_->chosen(), found_->chosen(), P).significant;
}

void ReceiverErrors::WidenTowards(const ReceiverErrors& other,
                                  double probability,
                                  CovarianceSeries* P) const {
  const int dim = found_->tape.dim();
  for (std::size_t k = 0; k < found_->tape.size(); ++k) {
    const ErrorVector d = (other.found_->chosen().smoothed[k].head(dim) -
                           found_->chosen().smoothed[k].head(dim));
    ErrorMatrix P_k = P->Get(k);
    P_k.topLeftCorner(dim, dim) += probability * d * d.transpose();
    P->Set(k, P_k);
  }
}

std::shared_ptr<const ErrorDecisions> ReceiverErrors::Decisions() const {
  return std::make_shared<const ErrorDecisions>(*found_);
}

std::string ReceiverErrors::InWords() const {
  const std::string what =
      found_->switching()
          ? DescribeSequence(found_->chosen().steps, found_->Times())
          : std::string(RegimeName(found_->regimes.kind)) + " errors";
  return found_->name + ": " + what;
}

bool IsAbsolute(const SensorKind& kind) {
  return kind.is_position || (kind.moves && !kind.of_vehicle) ||
         kind.is_height || kind.is_heading;
}

std::vector<int> AbsoluteSensors(const Timeline& timeline,
                                 const LinearTape& tape) {
  std::vector<int> rows(timeline.sensors().size(), 0);
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      if (!z.accepted || z.withheld) continue;
      int& most = rows[static_cast<std::size_t>(z.sensor)];
      most = std::max(most, static_cast<int>(z.residual.size()));
    }
  }
  std::vector<int> positions;
  std::vector<int> others;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] == 0 || rows[i] > 3) continue;
    const SensorKind& kind = *timeline.sensors()[i].kind;
    if (kind.is_position) {
      positions.push_back(static_cast<int>(i));
    } else if (IsAbsolute(kind)) {
      others.push_back(static_cast<int>(i));
    }
  }
  positions.insert(positions.end(), others.begin(), others.end());
  return positions;
}

ReceiverErrors FindReceiverErrors(const Problem& problem,
                                  const LinearTape& tape, int sensor,
                                  const SearchLimits& limits) {
  return ReceiverErrors(
      std::make_unique<const SensorFindings>(problem, tape, sensor, limits));
}

std::optional<ReceiverErrors> ApplyDecisions(const ErrorDecisions& decisions,
                                             const LinearTape& tape) {
  std::size_t fixes = 0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    fixes += HasFix(tape, k, decisions.sensor) ? 1 : 0;
  }
  if (decisions.stands() &&
      decisions.regimes.hypotheses.front().sequence.size() != fixes) {
    return std::nullopt;
  }
  return ReceiverErrors(
      std::make_unique<const SensorFindings>(decisions, tape));
}

}  // namespace hindsight
