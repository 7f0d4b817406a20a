#include "problems/explained_errors.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "base/error.h"
#include "problems/constant_rival.h"

namespace hindsight {
namespace {

/// Another order of a search.
struct Order {
  double share;  ///< of the effort of the first order
  /// The search begins from what the first has met as well: not where it is what the first
  /// has found that is in doubt.
  bool begins_from_met;
  /// False if nothing was found.
  std::function<bool(ErrorSearch* search)> run;
};

/// ln of the odds against an explanation in another order, which is searched; none if
/// there is no such. One in which no errors of velocities and positions come together
/// has to be likelier by odds of a thousand.
std::optional<double> LogOddsAgainst(const std::vector<State>& initial,
                                     const ErrorSearch& search,
                                     const Order& order, ErrorSearch* other) {
  try {
    if (!order.run(other) || other->ended()) return std::nullopt;
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
  constexpr double kHalf = 0.5;
  std::vector<Order> orders;
  if (search.MayBeOfAReceiver()) {
    orders.push_back({kHalf, false, [&initial](ErrorSearch* other) {
                        return other->RunFromVelocities(initial);
                      }});
  }
  std::vector<int> suspects = search.SuspectsOfVehicle();
  if (!suspects.empty()) {
    orders.push_back({kHalf, true, [&initial, suspects](ErrorSearch* other) {
                        return other->RunFromVehicle(suspects, initial);
                      }});
  }
  std::vector<int> beside = search.SuspectsBeside();
  if (!beside.empty()) {
    // With half of it a jump and a drift that ends it is not found where the first
    // order finds it without the others.
    orders.push_back(
        {1.0, false,
         [&initial, beside, first = search.first_sensor()](ErrorSearch* other) {
           return other->RunFromOne(first, beside, initial);
         }});
  }
  const std::vector<int> alike = search.ReceiversThatMayErrAlike();
  if (!alike.empty()) {
    const std::vector<int> others(alike.begin() + 1, alike.end());
    orders.push_back(
        {1.0, false,
         [&initial, others, first = alike.front()](ErrorSearch* other) {
           return other->RunFromOne(first, others, initial);
         }});
  }
  return orders;
}

/// ln of the evidence that a constant gains, 0 if none gains any.
double LogGainOf(const std::optional<ConstantRival>& constant) {
  return constant ? std::max(0.0, constant->log_gain) : 0.0;
}

/// In place of a search that has found errors one in which nothing stands, if a constant
/// that is not estimated explains more than they and the likeliest constant beside them.
/// Whether it does.
bool ConstantExplainsMore(const Problem& problem,
                          const std::vector<State>& initial,
                          const RobustBatchOptions& options,
                          ErrorSearch* search) {
  if (!search->states() || search->ended()) return false;
  ErrorSearch plain(problem, options, 1.0);
  const std::optional<ConstantRival> constant =
      LikeliestConstant(plain.problem(), initial, options.callback);
  const double gain = LogGainOf(constant);
  const double constant_alone = plain.LogEvidence(initial) + gain;
  const double errors_alone = search->LogEvidence(initial);
  if (gain == 0.0 || constant_alone < errors_alone) return false;
  const double both = errors_alone + LogGainOf(LikeliestConstant(
                                         search->problem(), *search->states(),
                                         options.callback));
  if (constant_alone < both) return false;
  plain.Disbelieve(search->InWords(),
                   "it explains more that " + constant->what);
  *search = std::move(plain);
  return true;
}

}  // namespace

ExplainedErrors ExplainErrors(const Problem& problem,
                              const std::vector<State>& initial,
                              const RobustBatchOptions& options, double share) {
  ErrorSearch search(problem, options, share);
  if (options.decisions != nullptr) {
    search.RunAsDecided(initial);
    return {std::move(search), std::nullopt, std::nullopt};
  }
  search.Run(initial);
  std::optional<RivalSearch> rival;
  const std::vector<Order> orders =
      search.ended() ? std::vector<Order>() : OtherOrders(initial, search);
  for (const Order& order : orders) {
    if (search.ended()) break;
    ErrorSearch other(problem, options, order.share * share);
    if (order.begins_from_met) other.BeginFrom(search.Decisions());
    const std::optional<double> odds =
        LogOddsAgainst(initial, search, order, &other);
    if (other.ended()) search.End();
    if (!odds) continue;
    if (*odds < 0.0) std::swap(search, other);
    if (!other.states()) continue;
    rival = {*other.states(), other.InWords(), std::abs(*odds)};
  }
  if (ConstantExplainsMore(problem, initial, options, &search)) rival.reset();
  std::optional<ErrorSearch> without_last;
  if (!options.last.empty()) without_last = search;
  search.RunLast(initial);
  return {std::move(search), std::move(rival), std::move(without_last)};
}

}  // namespace hindsight
