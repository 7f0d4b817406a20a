#include "problems/robust_batch.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "problems/error_search.h"

namespace hindsight {
namespace {

/// Sensors whose errors do not stand keep what their gates decided.
void RestoreGates(const ErrorSearch& search, const GateDecisions& gates,
                  Problem* problem) {
  for (std::size_t i = 0; i < gates.size(); ++i) {
    if (!search.HasErrors(problem->timeline.all_measurements()[i].sensor)) {
      problem->decisions[i] = gates[i];
    }
  }
}

Evidence DoubtOfUnconverged() {
  return {.grade = Grade::kDoubtful,
          .what =
              "errors of sensors were found, but the batch with them does "
              "not converge: the result is that of 'batch'",
          .causes = {"errors of another kind, or of several sensors at once"},
          .remedies = {"'--without', which leaves a sensor out"}};
}

std::string DescribeBlunders(const Problem& problem,
                             const std::vector<std::size_t>& blunders) {
  const Measurement& first =
      problem.timeline.all_measurements()[blunders.front()];
  return fmt::format(
      "{} positions that no vehicle reaches are left out, the first of {} at "
      "{:.1f} s",
      blunders.size(),
      problem.timeline.sensors()[static_cast<std::size_t>(first.sensor)].name,
      first.t);
}

/// What else explains the data, in another order of the sensors.
struct RivalSearch {
  std::vector<State> states;
  std::string words;
  double log_odds = 0.0;  ///< against it
};

struct Explained {
  ErrorSearch search;
  std::optional<RivalSearch> rival;
};

/// Another order of a search; false if nothing was found in it.
using Order = std::function<bool(ErrorSearch* search)>;

/// ln of the odds against an explanation in another order, which is searched; none if
/// there is no such. One in which no errors of velocities and positions come together
/// has to be likelier by odds of a thousand.
std::optional<double> LogOddsAgainst(const std::vector<State>& initial,
                                     const ErrorSearch& search,
                                     const Order& order, ErrorSearch* other) {
  try {
    if (!order(other) || other->ended()) return std::nullopt;
    const double log_odds =
        search.LogEvidence(initial) - other->LogEvidence(initial);
    const double most = other->HasCoincidences()
                            ? std::numeric_limits<double>::max()
                            : -kSureLogOdds;
    if (std::isfinite(log_odds) && log_odds <= most) return log_odds;
  } catch (const EstimationError&) {
    // Without its positions the recording tells no trajectory.
  }
  return std::nullopt;
}

/// In what other orders than Run's the errors are to be sought that it found, or not.
std::vector<Order> OtherOrders(const std::vector<State>& initial,
                               const ErrorSearch& search) {
  std::vector<Order> orders;
  if (search.MayBeOfAReceiver()) {
    orders.emplace_back([&initial](ErrorSearch* other) {
      return other->RunFromVelocities(initial);
    });
  }
  std::vector<int> suspects = search.SuspectsOfVehicle();
  if (!suspects.empty()) {
    orders.emplace_back([&initial, suspects](ErrorSearch* other) {
      return other->RunFromVehicle(suspects, initial);
    });
  }
  return orders;
}

/// The likeliest of the explanations. `share`: of the effort of a search.
Explained Explain(const Problem& problem, const std::vector<State>& initial,
                  const RobustBatchOptions& options, double share) {
  ErrorSearch search(problem, options, share);
  if (options.decisions != nullptr) {
    search.RunAsDecided(initial);
    return {std::move(search), std::nullopt};
  }
  search.Run(initial);
  std::optional<RivalSearch> rival;
  const std::vector<Order> orders =
      search.ended() ? std::vector<Order>() : OtherOrders(initial, search);
  for (const Order& order : orders) {
    if (search.ended()) break;
    ErrorSearch other(problem, options, 0.5 * share);
    const std::optional<double> odds =
        LogOddsAgainst(initial, search, order, &other);
    if (other.ended()) search.End();
    if (!odds) continue;
    if (*odds < 0.0) std::swap(search, other);
    if (!other.states()) continue;
    rival = {*other.states(), other.InWords(), std::abs(*odds)};
  }
  search.RunLast(initial);
  return {std::move(search), std::move(rival)};
}

/// Tells of a rival to odds of a thousand, where it leads elsewhere, and widens the
/// covariances by what it is worth.
void TellOtherOrder(const RivalSearch& rival, const std::string& words,
                    RobustBatchResult* result) {
  constexpr double kSigmas = 3.0;
  if (rival.log_odds >= kSureLogOdds) return;
  const double probability = 1.0 / (1.0 + std::exp(rival.log_odds));
  const Block* position = result->problem.layout.Find(BlockKind::kPosition);
  if (position == nullptr || position->dim != 3) return;
  const int at = position->offset;
  double farthest = 0.0;
  bool apart = false;
  for (std::size_t k = 0; k < rival.states.size(); ++k) {
    const State& x = result->batch.states[k];
    const Eigen::Vector3d d =
        x.C_en().transpose() * (rival.states[k].p_e - x.p_e);
    ErrorMatrix P = result->batch.P.Get(k);
    apart |=
        d.squaredNorm() > kSigmas * kSigmas * P.block<3, 3>(at, at).trace();
    farthest = std::max(farthest, d.norm());
    P.block<3, 3>(at, at) += probability * d * d.transpose();
    result->batch.P.Set(k, P);
  }
  if (!apart) return;
  result->other_order = Evidence(
      {.grade = Grade::kDoubtful,
       .what = fmt::format("{}; or else, {} likely and up to {:.3g} m "
                           "away, {}",
                           words, FormatProbability(probability), farthest,
                           rival.words),
       .value = probability,
       .unit = "probability",
       .causes = {"errors of positions and velocities that come together"},
       .remedies = {"'--without', which leaves one of them out"}});
}

/// With the errors that explain the data about `initial`.
RobustBatchResult SolveWith(const Explained& explained,
                            const std::vector<State>& initial,
                            const RobustBatchOptions& options) {
  const ErrorSearch& search = explained.search;
  RobustBatchResult result = {.problem = search.problem()};
  auto states = search.states();
  if (!states && !options.blunders.empty()) states = initial;
  if (states) {
    RestoreGates(search, options.gates, &result.problem);
    for (const std::size_t i : options.blunders) {
      result.problem.decisions[i] = 0;
    }
    BatchOptions batch = options.batch;
    batch.graduated = false;
    // About the edge of a mixture the last steps converge linearly.
    batch.max_iterations = std::max(batch.max_iterations, 200);
    result.batch = SolveBatch(*states, batch, &result.problem);
    result.stands = result.batch.converged;
  }
  if (states && !result.stands) {
    result.doubts.push_back(DoubtOfUnconverged());
  } else {
    search.Tell(&result);
    if (explained.rival && result.stands) {
      TellOtherOrder(*explained.rival, search.InWords(), &result);
    }
  }
  result.decisions = search.Decisions();
  result.log_prior = search.LogOfPrior();
  if (!options.blunders.empty()) {
    result.notes.push_back(DescribeBlunders(result.problem, options.blunders));
  }
  return result;
}

/// With errors sought once more, about the trajectory of another solution; none if
/// the data cannot be solved about it, or `ended` says that there was no time.
std::optional<RobustBatchResult> SolveAgain(const Problem& problem,
                                            const std::vector<State>& initial,
                                            const RobustBatchOptions& options,
                                            const bool& ended) {
  constexpr double kShare = 0.5;
  try {
    const Explained explained = Explain(problem, initial, options, kShare);
    if (ended) return std::nullopt;
    return SolveWith(explained, initial, options);
  } catch (const EstimationError&) {
    return std::nullopt;
  }
}

/// Whether the attitude of a solution is so far from that about which errors were
/// sought that what is quadratic in their distance, theta^2 / 2, is more than three
/// sigmas: then the search has judged another trajectory than the batch.
bool IsBeyondLinear(const std::vector<State>& nominal,
                    const RobustBatchResult& result) {
  constexpr double kSigmas = 3.0;
  const Block* attitude = result.problem.layout.Find(BlockKind::kAttitude);
  if (attitude == nullptr || attitude->dim != 3) return false;
  for (std::size_t k = 0; k < nominal.size(); ++k) {
    const double theta =
        nominal[k].q_eb.angularDistance(result.batch.states[k].q_eb);
    const ErrorMatrix P = result.batch.P.Get(k);
    const double variance =
        P.diagonal().segment<3>(attitude->offset).maxCoeff();
    if (0.5 * theta * theta > kSigmas * std::sqrt(variance)) return true;
  }
  return false;
}

/// The states of a solution over the layout without errors of sensors.
std::vector<State> WithoutErrors(const ErrorLayout& layout,
                                 std::vector<State> states) {
  for (State& x : states) {
    x.parameters.conservativeResize(layout.parameter_count());
  }
  return states;
}

}  // namespace

RobustBatchResult SolveRobustBatch(Problem problem,
                                   const std::vector<State>& initial,
                                   const RobustBatchOptions& options) {
  constexpr int kMostPasses = 3;
  bool ended = false;
  int pass = 0;
  RobustBatchOptions of_pass = options;
  if (options.go_on) {
    of_pass.go_on = [&](double fraction) {
      // Another pass takes half of what is left.
      ended |= !options.go_on(1.0 - std::exp2(-(pass + fraction)));
      return !ended;
    };
  }
  RobustBatchResult result =
      SolveWith(Explain(problem, initial, of_pass, 1.0), initial, of_pass);
  std::vector<State> nominal = initial;
  while (++pass < kMostPasses && result.stands &&
         options.decisions == nullptr && IsBeyondLinear(nominal, result)) {
    if (of_pass.go_on && !of_pass.go_on(0.0)) break;
    nominal = WithoutErrors(problem.layout, result.batch.states);
    std::optional<RobustBatchResult> again =
        SolveAgain(problem, nominal, of_pass, ended);
    if (!again || !again->stands) break;
    result = *std::move(again);
  }
  result.ended = ended;
  return result;
}

}  // namespace hindsight
