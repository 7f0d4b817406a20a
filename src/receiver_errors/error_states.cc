#include "receiver_errors/error_states.h"

#include <algorithm>
#include <utility>

#include "receiver_errors/error_dynamics.h"
#include "receiver_errors/sensor_tape.h"
#include "receiver_errors/uniform_regimes.h"

namespace hindsight {
namespace {

/// What is left of an error where the receiver is good, in its sigma: exact
/// steps would leave the problem singular.
constexpr double kNoError = 1e-3;

/// Sigmas of e at the first node [m]; 0 where the receiver is good there.
Eigen::Vector3d FirstSigma(ErrorMode first, const ErrorParameters& p) {
  switch (first) {
    case ErrorMode::kGood:
      return Eigen::Vector3d::Zero();
    case ErrorMode::kSlight:
      return Eigen::Vector3d::Constant(p.slight_sigma);
    case ErrorMode::kBiased:
    case ErrorMode::kDrifting:
      break;
  }
  return {p.sigma, p.sigma, p.down * p.sigma};
}

}  // namespace

ErrorStates::ErrorStates(const LinearTape& tape, int receiver,
                         double stated_sigma, const std::string& unit,
                         ErrorRegimes::Kind kind,
                         const WeighedHypothesis& chosen)
    : tape_(tape),
      receiver_(receiver),
      rows_(RowsOf(tape, receiver)),
      unseen_(UnseenSinceFix(tape, receiver)),
      floor_(kNoError * stated_sigma),
      unit_(unit),
      kind_(kind),
      chosen_(chosen) {}

bool ErrorStates::HasRate() const {
  return std::any_of(
      chosen_.steps.begin(), chosen_.steps.end(),
      [](const ErrorStep& s) { return s.mode == ErrorMode::kDrifting; });
}

void ErrorStates::Extend(Problem* problem) const {
  ApplyToSensor(&problem->timeline);
  if (HasError()) AddError(problem);
}

void ErrorStates::AddError(Problem* problem) const {
  const Sensor& sensor =
      problem->timeline.sensors()[static_cast<std::size_t>(receiver_)];
  ErrorLayout& layout = problem->layout;
  AddBlock(BlockKind::kSensorError, sensor.name + "_error", unit_,
           FirstSigma(chosen_.steps.front().mode, chosen_.parameters)
               .cwiseMax(floor_),
           &layout);
  if (HasRate()) {
    AddBlock(BlockKind::kErrorRate, sensor.name + "_error_rate", unit_ + "/s",
             Eigen::Vector3d::Constant(chosen_.parameters.rate_sigma), &layout);
  }
  Prior& prior = problem->prior;
  const int added = HasRate() ? 6 : 3;
  prior.x.parameters.conservativeResize(layout.parameter_count());
  prior.x.parameters.tail(added).setZero();
  ErrorMatrix P = layout.InitialCovariance();
  P.topLeftCorner(prior.P.rows(), prior.P.cols()) = prior.P;
  prior.P = P;
  std::vector<std::vector<BlockStep>> steps;
  for (std::size_t k = 1; k < chosen_.steps.size(); ++k) {
    const auto before = problem->timeline.StepsAfter(k - 1);
    steps.emplace_back(before.begin(), before.end());
    const std::vector<BlockStep> own = StepsTo(k, chosen_.parameters);
    steps.back().insert(steps.back().end(), own.begin(), own.end());
  }
  problem->timeline.SetBlockSteps(std::move(steps));
}

void ErrorStates::Replace(const ErrorParameters& other,
                          Problem* problem) const {
  const Block* e = problem->layout.Find(BlockKind::kSensorError, receiver_);
  if (e == nullptr) return;
  problem->prior.P.diagonal().segment<3>(e->offset) =
      FirstSigma(chosen_.steps.front().mode, other)
          .cwiseMax(floor_)
          .cwiseAbs2();
  std::vector<std::vector<BlockStep>> steps;
  for (std::size_t k = 1; k < chosen_.steps.size(); ++k) {
    const auto all = problem->timeline.StepsAfter(k - 1);
    const std::vector<BlockStep> own = StepsTo(k, other);
    steps.emplace_back(all.begin(), all.end());
    for (BlockStep& step : steps.back()) {
      if (step.key == e->key) step = own.front();
    }
  }
  problem->timeline.SetBlockSteps(std::move(steps));
}

std::vector<State> ErrorStates::States(const ErrorLayout& layout) const {
  std::vector<State> states;
  for (std::size_t k = 0; k < tape_.size(); ++k) {
    State x = tape_.epoch(k).x_plus;
    const Eigen::Index count = x.parameters.size();
    x.parameters.conservativeResize(layout.parameter_count());
    x.parameters.tail(layout.parameter_count() - count).setZero();
    const auto smoothed = chosen_.smoothed[k];
    const int n = tape_.dim();
    ErrorVector d = ErrorVector::Zero(layout.dim());
    d.head(n) = smoothed.head(n);
    d.tail(layout.dim() - n) = smoothed.segment(n, layout.dim() - n);
    states.push_back(Retract(layout, x, d));
  }
  return states;
}

State ErrorStates::Moved(const ErrorLayout& layout, const State& x,
                         const ErrorVector& by) const {
  const int n = tape_.dim();
  ErrorVector d = ErrorVector::Zero(layout.dim());
  d.head(n) = by.head(n);
  int from = n;
  for (const BlockKind kind :
       {BlockKind::kSensorError, BlockKind::kErrorRate}) {
    const Block* block = HasError() ? layout.Find(kind, receiver_) : nullptr;
    if (block != nullptr) {
      d.segment<3>(block->offset) = by.segment<3>(from);
    }
    from += 3;
  }
  return Retract(layout, x, d);
}

void ErrorStates::ApplyToSensor(Timeline* timeline) const {
  const auto i = static_cast<std::size_t>(receiver_);
  Sensor sensor = timeline->sensors()[i];
  sensor.loss.kind = RobustLoss::Kind::kMixture;
  sensor.loss.scale = 1.0;
  sensor.loss.rows = rows_;
  sensor.loss.outlier_ratio = chosen_.parameters.outlier_ratio;
  sensor.loss.outlier_share = chosen_.parameters.outlier_share;
  timeline->SetSensor(i, sensor);
  timeline->ScaleSensor(receiver_,
                        std::max(kLeastSolved, chosen_.parameters.scale));
}

std::vector<ToldVelocityStep> ErrorStates::VelocitySteps() const {
  std::vector<ToldVelocityStep> steps;
  if (std::ranges::none_of(chosen_.steps, &ErrorStep::velocity_step)) {
    return steps;
  }
  const std::vector<UnseenTime> unseen = UnseenSincePosition(tape_, receiver_);
  const Block* velocity = tape_.layout().Find(BlockKind::kVelocity);
  const int n = tape_.dim();
  for (std::size_t k = 1; k < chosen_.steps.size(); ++k) {
    const ErrorStep& step = chosen_.steps[k];
    if (!step.velocity_step || unseen[k].length == 0.0) continue;
    const double variance =
        DynamicsOf(chosen_.parameters, step, 0.0, unseen_[k]).q_vv;
    const ErrorVector w = chosen_.smoothed[k].head(n) -
                          tape_.Phi(k) * chosen_.smoothed[k - 1].head(n) -
                          tape_.c(k);
    steps.push_back(
        {unseen[k].StepWithin(variance), w.segment<3>(velocity->offset)});
  }
  return steps;
}

void ErrorStates::AddBlock(BlockKind kind, const std::string& name,
                           const std::string& unit,
                           const Eigen::Vector3d& sigma0,
                           ErrorLayout* layout) const {
  Block block;
  block.key = {kind, receiver_};
  block.name = name;
  block.unit = unit;
  block.evolution =
      Evolution::GaussMarkov(chosen_.parameters.sigma, chosen_.parameters.tau);
  block.sigma0 = sigma0;
  layout->Add(block);
}

std::vector<BlockStep> ErrorStates::StepsTo(
    std::size_t k, const ErrorParameters& parameters) const {
  const ErrorStep& before = chosen_.steps[k - 1];
  const ErrorStep& step = chosen_.steps[k];
  const double dt = tape_.t(k) - tape_.t(k - 1);
  const ErrorDynamics d = DynamicsOf(parameters, step, dt, unseen_[k]);
  const double rate = parameters.rate_sigma * parameters.rate_sigma;
  BlockStep e = {.key = {BlockKind::kSensorError, receiver_},
                 .phi = d.ee,
                 .variance = d.q_ee + floor_ * floor_,
                 .down = std::max(d.down, kNoError)};
  BlockStep r = {{BlockKind::kErrorRate, receiver_}, 0.0, rate};
  // A rate is free before a drift that begins; one that follows another needs
  // an interval in which it is drawn anew.
  const bool drifts = step.mode == ErrorMode::kDrifting;
  const bool follows = before.mode == ErrorMode::kDrifting;
  if (drifts && !(step.anew && follows)) {
    e.rate = r.key;
    r.phi = 1.0;
    r.variance = rate * kDriftWalk * kDriftWalk * dt;
  }
  if (drifts && step.anew && !follows) {
    // What is left of w_e beside the r that is known from here on.
    e.rate_share = d.q_er / d.q_rr / dt;
    e.variance =
        std::max(0.0, d.q_ee - d.q_er * d.q_er / d.q_rr) + floor_ * floor_;
  }
  return {e, r};
}

}  // namespace hindsight
