#include "problems/robust_batch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "problems/history_alternatives.h"
#include "problems/history_words.h"

namespace hindsight {
namespace {

/// What is left of an error where the receiver is good, in its sigma: exact
/// steps would leave the problem singular.
constexpr double kNoError = 1e-3;

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

class RobustProblem {
 public:
  RobustProblem(const LinearTape& tape, const ErrorLayout& layout,
                const Prior& prior, int receiver, double stated_sigma,
                ErrorRegimes::Kind kind, const HistoryAlternative& chosen)
      : tape_(tape),
        receiver_(receiver),
        floor_(kNoError * stated_sigma),
        kind_(kind),
        layout_(layout),
        prior_(prior),
        parameters_(chosen.parameters),
        steps_(chosen.steps) {}

  /// Layout and prior with e and r behind all other blocks, as far as the
  /// history has them.
  void Extend(const Sensor& sensor) {
    if (!HasError()) return;
    const ErrorMode first = steps_.front().mode;
    const double sigma = std::max(floor_, first == ErrorMode::kGood ? 0.0
                                          : first == ErrorMode::kSlight
                                              ? parameters_.slight_sigma
                                              : parameters_.sigma);
    AddBlock(BlockKind::kColouredNoise, sensor.name + "_error", "m", sigma);
    if (HasRate()) {
      AddBlock(BlockKind::kErrorRate, sensor.name + "_error_rate", "m/s",
               parameters_.rate_sigma);
    }
    const int added = HasRate() ? 6 : 3;
    prior_.x.parameters.conservativeResize(layout_.parameter_count());
    prior_.x.parameters.tail(added).setZero();
    ErrorMatrix P = layout_.InitialCovariance();
    P.topLeftCorner(prior_.P.rows(), prior_.P.cols()) = prior_.P;
    prior_.P = P;
  }

  std::vector<ColouredStep> ErrorSteps() const {
    std::vector<ColouredStep> out;
    if (!HasError()) return out;
    for (std::size_t k = 1; k < steps_.size(); ++k) out.push_back(Step(k));
    return out;
  }

  /// The smoothed trajectory of a history.
  std::vector<State> States(const std::vector<ErrorVector>& smoothed) const {
    std::vector<State> states;
    for (std::size_t k = 0; k < tape_.size(); ++k) {
      State x = tape_.epoch(k).x_plus;
      const Eigen::Index count = x.parameters.size();
      x.parameters.conservativeResize(layout_.parameter_count());
      x.parameters.tail(layout_.parameter_count() - count).setZero();
      states.push_back(
          Retract(layout_, x, ErrorVector(smoothed[k].head(layout_.dim()))));
    }
    return states;
  }

  const ErrorLayout& layout() const { return layout_; }
  const Prior& prior() const { return prior_; }

 private:
  bool HasError() const { return kind_ != ErrorRegimes::Kind::kWhite; }
  bool HasRate() const {
    return std::any_of(steps_.begin(), steps_.end(), [](const ErrorStep& s) {
      return s.mode == ErrorMode::kDrifting;
    });
  }

  void AddBlock(BlockKind kind, const std::string& name, const char* unit,
                double sigma0) {
    Block block;
    block.key = {kind, receiver_};
    block.name = name;
    block.unit = unit;
    block.evolution =
        Evolution::GaussMarkov(parameters_.sigma, parameters_.tau);
    block.sigma0.setConstant(sigma0);
    layout_.Add(block);
  }

  /// The step of the error over the interval into node k.
  ColouredStep Step(std::size_t k) const {
    const double dt = tape_.epoch(k).t - tape_.epoch(k - 1).t;
    const ErrorDynamics d = DynamicsOf(parameters_, steps_[k], dt);
    ColouredStep out;
    out.sensor = receiver_;
    out.phi = d.ee;
    out.variance = d.q_ee + floor_ * floor_;
    // A rate is free before a drift that begins; one that follows another needs
    // an interval in which it is drawn anew.
    const bool drifts = steps_[k].mode == ErrorMode::kDrifting;
    const bool follows = steps_[k - 1].mode == ErrorMode::kDrifting;
    out.drifts = drifts && !(steps_[k].anew && follows);
    if (drifts && steps_[k].anew && !follows) out.variance = floor_ * floor_;
    return out;
  }

  const LinearTape& tape_;
  int receiver_;
  double floor_;
  ErrorRegimes::Kind kind_;
  ErrorLayout layout_;
  Prior prior_;
  const ErrorParameters& parameters_;
  const std::vector<ErrorStep>& steps_;  ///< by node
};

void ApplyToSensor(const ErrorParameters& p, int receiver, Timeline* timeline) {
  const auto i = static_cast<std::size_t>(receiver);
  Sensor sensor = timeline->sensors()[i];
  sensor.loss.kind = RobustLoss::Kind::kMixture;
  sensor.loss.scale = 1.0;
  sensor.loss.rows = 3;
  sensor.loss.outlier_ratio = p.outlier_ratio;
  sensor.loss.outlier_share = p.outlier_share;
  timeline->SetSensor(i, sensor);
  timeline->ScaleSensor(receiver, p.scale);
}

/// Widens P by what the other histories say, and finds the modes'
/// probabilities.
void AddAlternatives(int dim, const std::vector<HistoryAlternative>& all,
                     const HistoryAlternative& chosen,
                     RobustBatchResult* result) {
  const std::size_t nodes = chosen.steps.size();
  result->probabilities.assign(nodes, Eigen::VectorXd::Zero(4));
  for (std::size_t k = 0; k < nodes; ++k) {
    for (const HistoryAlternative& one : all) {
      result->probabilities[k](static_cast<int>(one.steps[k].mode)) +=
          one.weight;
    }
    ErrorMatrix P = result->batch.P.Get(k);
    P.topLeftCorner(dim, dim) += Spread(all, chosen, k, dim);
    result->batch.P.Set(k, P);
  }
}

std::vector<std::string> Notes(const std::string& sensor,
                               ErrorRegimes::Kind kind,
                               const HistoryAlternative& chosen) {
  const ErrorParameters& p = chosen.parameters;
  const auto has = [&](ErrorMode mode) {
    return std::any_of(chosen.steps.begin(), chosen.steps.end(),
                       [&](const ErrorStep& s) { return s.mode == mode; });
  };
  char text[200];
  std::snprintf(text, sizeof(text),
                "%s: %s errors, sigma %.3g times as stated, outliers %.3g %% "
                "of %.3g times that",
                sensor.c_str(), RegimeName(kind), p.scale,
                100.0 * p.outlier_share, p.outlier_ratio);
  std::vector<std::string> notes = {text};
  if (has(ErrorMode::kBiased)) {
    std::snprintf(text, sizeof(text),
                  "%s: Gauss-Markov error of %.3g m, correlation time %.3g s",
                  sensor.c_str(), p.sigma, p.tau);
    notes.emplace_back(text);
  }
  if (has(ErrorMode::kSlight)) {
    std::snprintf(text, sizeof(text), "%s: slight errors of %.3g m",
                  sensor.c_str(), p.slight_sigma);
    notes.emplace_back(text);
  }
  if (has(ErrorMode::kDrifting)) {
    std::snprintf(text, sizeof(text), "%s: errors that grow by %.3g m/s",
                  sensor.c_str(), p.rate_sigma);
    notes.emplace_back(text);
  }
  return notes;
}

/// What happened, and what else may have, as far as it matters.
void TellHistory(const LinearTape& tape, const std::string& sensor,
                 const std::vector<HistoryAlternative>& all,
                 const HistoryAlternative& chosen, RobustBatchResult* result) {
  constexpr double kWorthTelling = 1e-3;
  if (result->regimes.kind != ErrorRegimes::Kind::kSwitching) return;
  std::vector<double> times;
  for (std::size_t k = 0; k < tape.size(); ++k)
    times.push_back(tape.epoch(k).t);
  result->notes.push_back(sensor + ": " + DescribeHistory(chosen.steps, times));
  const RivalHistory rival = FindRival(all, chosen, result->batch.P);
  if (rival.probability < kWorthTelling) return;
  char text[120];
  std::snprintf(text, sizeof(text),
                "%s: or, with a probability of %.2g %%, up to %.3g m away: ",
                sensor.c_str(), 100.0 * rival.probability, rival.distance);
  result->notes.push_back(text + DescribeHistory(rival.history->steps, times));
}

}  // namespace

double RobustBatchResult::Trust(std::size_t k) const {
  return regimes.kind == ErrorRegimes::Kind::kSwitching ? probabilities[k](0)
                                                        : 1.0;
}

RobustBatchResult SolveRobustBatch(const ErrorLayout& layout,
                                   const Prior& prior,
                                   const std::vector<State>& initial,
                                   int receiver, Timeline timeline,
                                   const GateDecisions& decisions,
                                   const BatchOptions& options,
                                   const EpochCallback& callback) {
  const LinearTape tape = RunLinearizedFilter(layout, prior, initial, &timeline,
                                              decisions, callback);
  const double stated = StatedSigma(timeline, receiver);
  ErrorRegimes regimes = ChooseRegimes(
      {tape, receiver, stated, layout.Has(BlockKind::kColouredNoise, receiver),
       [&callback, &tape] {
         if (callback) callback(tape.size());
       }});
  const std::vector<HistoryAlternative> alternatives =
      WeighHistories(tape, receiver, regimes);
  const HistoryAlternative& chosen = MostCentral(alternatives);
  const Sensor sensor = timeline.sensors()[static_cast<std::size_t>(receiver)];
  RobustProblem problem(tape, layout, prior, receiver, stated, regimes.kind,
                        chosen);
  problem.Extend(sensor);
  std::vector<std::string> notes = Notes(sensor.name, regimes.kind, chosen);
  ApplyToSensor(chosen.parameters, receiver, &timeline);
  timeline.SetColouredSteps(problem.ErrorSteps());
  BatchOptions batch = options;
  batch.graduated = false;
  // About the edge of a mixture the last steps converge linearly.
  batch.max_iterations = std::max(batch.max_iterations, 200);
  BatchResult solved =
      SolveBatch(problem.layout(), problem.prior(),
                 problem.States(chosen.smoothed), &timeline, decisions, batch);
  RobustBatchResult result{problem.layout(),    std::move(solved),
                           std::move(timeline), decisions,
                           std::move(regimes),  {},
                           std::move(notes)};
  TellHistory(tape, sensor.name, alternatives, chosen, &result);
  AddAlternatives(tape.dim(), alternatives, chosen, &result);
  return result;
}

}  // namespace hindsight
