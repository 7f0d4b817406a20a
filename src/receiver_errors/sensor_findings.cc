#include "receiver_errors/sensor_findings.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "measurements/sensor_kind.h"
#include "receiver_errors/errant_end.h"
#include "receiver_errors/search_tapes.h"
#include "receiver_errors/sequence_smoother.h"
#include "receiver_errors/uniform_regimes.h"

namespace hindsight {
namespace {

/// What a filter step of so many states takes, by one of a position, velocity,
/// attitude, the IMU's biases and scale factors and an error with its rate.
double CostOfStep(const SensorTape& tape) {
  constexpr double kUsual = 27.0;
  const double states = tape.dim() + 6;
  return std::max(1.0, states * states / (kUsual * kUsual));
}

/// Filter steps of a search; of long tapes so many a node. A search of ten minutes that is
/// to ask what else its errors may be needs more than the least, which an hour can afford.
double MostEffort(const SensorTape& tape) {
  constexpr double kAtLeast = 2.4e6;
  constexpr double kPerNode = 400.0;
  constexpr double kOfShort = 3.2e6;
  constexpr double kShort = 1200.0;  // nodes
  const auto nodes = static_cast<double>(tape.size());
  const double of_short = kOfShort * std::min(1.0, kShort / nodes);
  return std::max({kAtLeast, of_short, kPerNode * nodes}) / CostOfStep(tape);
}

/// As MostEffort, of the refinement at all fixes.
double RefinementEffort(const SensorTape& tape) {
  constexpr double kAtLeast = 3e5;
  constexpr double kPerNode = 60.0;
  return std::max(kAtLeast, kPerNode * static_cast<double>(tape.size())) /
         CostOfStep(tape);
}

/// Of normal points of a sensor. What measures velocities, heights or directions says of
/// each error by itself how large it is.
double IntervalOf(const Problem& problem, const LinearTape& tape, int sensor) {
  const SensorKind& kind =
      *problem.timeline.sensors()[static_cast<std::size_t>(sensor)].kind;
  return kind.is_position ? NormalPointInterval(tape) : kNormalPointInterval;
}

/// ln of the evidence of a fit without its likelihood.
double LogPriorOfFit(const RegimeProblem& problem, const ErrorRegimes& fit) {
  const Hypothesis& best = fit.hypotheses.front();
  return fit.log_evidence -
         ScoreSequence(problem.tape, best.parameters, best.sequence)
             .log_likelihood;
}

}  // namespace

SensorFindings::SensorFindings(const Problem& problem, const LinearTape& linear,
                               int index, const SearchLimits& limits,
                               std::vector<MetHypotheses> before)
    : ErrorDecisions(problem, linear, index), tape(linear) {
  constexpr double kSearch = 0.8;  // of the time, the rest refines
  SearchTapes tapes(tape, sensor, IntervalOf(problem, linear, index));
  const std::optional<NormalPoints>& points = tapes.points();
  const SensorTape& fixes = tapes.OfFixes();
  const SensorTape& searched = tapes.Searched();
  const double most = MostEffort(searched);
  SearchEffort effort(limits.share * most, [&limits](double fraction) {
    return !limits.go_on || limits.go_on(kSearch * fraction);
  });
  const RegimeProblem regime{
      .tape = searched,
      .stated_sigma = stated_sigma,
      .effort = &effort,
      .has_gauss_markov = problem.layout.Has(BlockKind::kColouredNoise, sensor),
      .is_tolerance = is_tolerance,
      .has_clock = problem.layout.Has(BlockKind::kTimeOffset, sensor),
      .met = std::move(before)};
  std::vector<ErrorRegimes> all = FitRegimes(regime);
  unfitted =
      effort.stopped() && all.back().kind != ErrorRegimes::Kind::kSwitching;
  for (const ErrorRegimes& one : all) {
    if (one.kind == ErrorRegimes::Kind::kSwitching) {
      met.push_back(LikelyOf(one));
    }
  }
  searched_fixes = all.front().hypotheses.front().sequence.size();
  choice = ChooseRegime(regime, all);
  log_prior = LogPriorOfFit(regime, all[choice.chosen]);
  for (const RegimeChoice::Undecided& one : choice.undecided) {
    undecided.push_back(all[one.index].hypotheses.front());
    Hypothesis& kept = undecided.back();
    kept.log_posterior = one.gain;
    if (points) kept.sequence = AtFixes(*points, kept.sequence);
  }
  open = choice.open;
  likeliest_noise = all[choice.noise].hypotheses.front();
  if (points) {
    likeliest_noise.sequence = AtFixes(*points, likeliest_noise.sequence);
  }
  stopped = effort.stopped();
  spent = std::min(limits.share, effort.spent() / most);
  SearchEffort rest(limits.share * RefinementEffort(fixes),
                    [&limits](double fraction) {
                      return !limits.go_on ||
                             limits.go_on(kSearch + (1.0 - kSearch) * fraction);
                    });
  if (points && stands()) {
    Refine(fixes, *points, std::move(all), &rest);
  } else if (points) {
    ChooseNoise(fixes, &rest);
  } else if (stands()) {
    regimes = WithAlternatives(std::move(all), choice.chosen);
  }
  // Averages may be likelier with what all measurements are not.
  const auto refuse = [&] {
    if (!stands()) return false;
    const std::string why = ObjectionOn(tapes.Whole(), regime.has_clock);
    if (!why.empty()) Refuse(tapes.Whole(), why);
    return !why.empty();
  };
  if (refuse()) ChooseNoise(fixes, &rest);
  if (refuse()) Withdraw();
  stopped |= rest.stopped();
  if (!stands()) return;
  gain = GainOn(tapes.Whole());
  WeighAlternatives(tapes.Whole());
}

SensorFindings::SensorFindings(const ErrorDecisions& decisions,
                               const LinearTape& linear)
    : ErrorDecisions(decisions), tape(linear) {
  if (stands()) WeighAlternatives(SensorTape(tape, sensor));
}

double SensorFindings::GainOn(const SensorTape& whole) const {
  const Hypothesis& best = regimes.hypotheses.front();
  ErrorParameters stated;
  stated.outlier_share = 0.0;
  return log_prior +
         ScoreSequence(whole, best.parameters, best.sequence).log_likelihood -
         ScoreSequence(whole, stated, ModeSequence(best.sequence.size()))
             .log_likelihood;
}

std::string SensorFindings::ObjectionOn(const SensorTape& whole,
                                        bool has_clock) const {
  const std::string bound = AtBound(regimes.hypotheses.front(), true);
  if (!bound.empty()) return "have " + bound + " at its bound";
  const double least =
      switching() && !has_clock ? kLeastGainOfSwitching : kLeastGain;
  const double gain_on = GainOn(whole);
  if (gain_on >= least) return "";
  return fmt::format("win by {:.2g} over errors as stated [ln of the evidence]",
                     gain_on);
}

void SensorFindings::Refuse(const SensorTape& whole, const std::string& why) {
  choice.refused.push_back(
      fmt::format("{} errors do not stand: on all measurements they {}",
                  RegimeName(regimes.kind), why));
  if (regimes.slight) open = LeftOpen(*regimes.slight, GainOn(whole));
}

void SensorFindings::Withdraw() {
  RegimeChoice none;
  none.refused = std::move(choice.refused);
  choice = std::move(none);
  gain = 0.0;
  undecided.clear();
  regimes = {};
  alternatives.clear();
  errant_start = false;
  other_errs = 0.0;
}

void SensorFindings::WeighAlternatives(const SensorTape& whole) {
  alternatives = WeighHypotheses(whole, regimes);
  central = MostCentral(alternatives);
  AddExchanged();
}

void SensorFindings::AddExchanged() {
  const std::optional<ErrantEnd> errant = FindErrantEnd(*this);
  const bool at_end = errant && errant->IsDoubtful();
  std::optional<WeighedHypothesis> exchanged =
      at_end ? Exchanged(*this, *errant) : ExchangedWithOther(*this);
  if (!exchanged) return;
  errant_start = at_end && errant->at_start;
  if (!at_end) other_errs = exchanged->weight;
  // What the search met of it counts already.
  double known = 0.0;
  for (const WeighedHypothesis& one : alternatives) {
    const bool nearer = MeanSquareDistance(one.smoothed, exchanged->smoothed) <
                        MeanSquareDistance(one.smoothed, chosen().smoothed);
    known += nearer ? one.weight : 0.0;
  }
  if (known >= exchanged->weight) return;
  exchanged->weight = (exchanged->weight - known) / (1.0 - known);
  for (WeighedHypothesis& one : alternatives) {
    one.weight *= 1.0 - exchanged->weight;
  }
  alternatives.push_back(*std::move(exchanged));
}

void SensorFindings::ChooseNoise(const SensorTape& fixes,
                                 SearchEffort* effort) {
  const RegimeProblem noise{fixes, stated_sigma, true, effort};
  std::vector<ErrorRegimes> all = FitNoise(noise);
  RegimeChoice of_noise = ChooseRegime(noise, all);
  choice.chosen = of_noise.chosen;
  choice.gain = of_noise.gain;
  log_prior = LogPriorOfFit(noise, all[choice.chosen]);
  std::move(of_noise.refused.begin(), of_noise.refused.end(),
            std::back_inserter(choice.refused));
  regimes = stands() ? WithAlternatives(std::move(all), choice.chosen)
                     : ErrorRegimes();
}

void SensorFindings::Refine(const SensorTape& fixes, const NormalPoints& points,
                            std::vector<ErrorRegimes> found,
                            SearchEffort* effort) {
  constexpr double kFarBehind = 12.0;  // ln
  const RegimeProblem problem{fixes, stated_sigma, false, effort};
  const ErrorRegimes& best = found[choice.chosen];
  std::vector<ErrorRegimes> all = {RefineAtFixes(problem, points, best)};
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool rival = i != choice.chosen &&
                       found[i].kind == ErrorRegimes::Kind::kSwitching &&
                       found[i].log_evidence > best.log_evidence - kFarBehind;
    if (rival && best.kind == ErrorRegimes::Kind::kSwitching &&
        !effort->IsSpent()) {
      all.push_back(RefineAtFixes(problem, points, found[i]));
    }
  }
  regimes = WithAlternatives(std::move(all), 0);
}

std::unique_ptr<const SensorFindings> FindingsAgain(
    const ErrorDecisions& decisions, const LinearTape& tape) {
  std::size_t fixes = 0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    fixes += HasFix(tape, k, decisions.sensor) ? 1 : 0;
  }
  const auto is_other = [fixes](const Hypothesis& one) {
    return one.sequence.size() != fixes;
  };
  if ((decisions.stands() && is_other(decisions.regimes.hypotheses.front())) ||
      std::ranges::any_of(decisions.undecided, is_other) ||
      (!decisions.undecided.empty() && is_other(decisions.likeliest_noise))) {
    return nullptr;
  }
  return std::make_unique<const SensorFindings>(decisions, tape);
}

WeighedHypothesis SensorFindings::Smooth(const ErrorParameters& parameters,
                                         const ModeSequence& sequence) const {
  const SensorTape whole(tape, sensor);
  return {1.0, parameters, StepsByNode(whole, sequence),
          SmoothSequence(whole, parameters, sequence)};
}

std::vector<WeighedHypothesis> SensorFindings::SmoothUndecided() const {
  std::vector<WeighedHypothesis> all;
  for (const Hypothesis& one : undecided) {
    all.push_back(Smooth(one.parameters, one.sequence));
    all.back().weight = 1.0 / (1.0 + std::exp(-one.log_posterior));
  }
  return all;
}

WeighedHypothesis SensorFindings::SmoothNoise() const {
  return Smooth(likeliest_noise.parameters, likeliest_noise.sequence);
}

std::vector<double> SensorFindings::Times() const {
  std::vector<double> times;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    times.push_back(tape.t(k));
  }
  return times;
}

}  // namespace hindsight
