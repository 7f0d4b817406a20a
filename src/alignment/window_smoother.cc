#include "alignment/window_smoother.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "alignment/window_data.h"
#include "base/error.h"
#include "dataset/bias_sigma.h"

namespace hindsight {
namespace {

/// Gyro bias walks of a warm-up: 0.1 are 0.8 deg/s in a minute [rad/s/sqrt(s)].
constexpr std::array<double, 5> kDriftingWalks = {
    0.003 * kDegree, 0.01 * kDegree, 0.03 * kDegree, 0.1 * kDegree,
    0.3 * kDegree};
constexpr double kNotably = 5.0;  // odds of 150 to 1
/// Of WarmUpWalk: beyond five a priori sigmas in a minute a misfit is no drift.
constexpr double kFastestDrift = 5.0;

/// Largest mean normalised squared innovation of a solution that the next may
/// begin from: the others may lie in a wrong minimum, which holds what begins
/// there.
constexpr double kExplained = 2.0;

/// What is lost or gained in log-likelihood before one walk counts as better.
double Notably(double nis) { return kNotably * std::max(1.0, nis); }

}  // namespace

double WarmUpWalk(const AlignmentInput& input) {
  constexpr double kMinute = 60.0;
  return GyroBiasSigma(input.dataset.initial).maxCoeff() / std::sqrt(kMinute);
}

WindowSmoother::WindowSmoother(const AlignmentInput& input, double t_end,
                               std::optional<AttitudePrior> known)
    : input_(input),
      t_end_(t_end),
      known_(std::move(known)),
      data_(CutOut(input, t_end)) {}

std::optional<WindowSolution> WindowSmoother::Smooth(const WindowStart& start,
                                                     double least_walk) {
  const double usual = std::max(data_.imu.noise.gyro_bias_walk, least_walk);
  const Trial* best = Likeliest(start, usual);
  if (best == nullptr) return std::nullopt;
  if (best->walk > usual) best = LargestWalk(start, best);
  if (best != solved_) {
    solution_ = WithCovariances(*best);
    solved_ = best;
  }
  return solution_;
}

const WindowSmoother::Trial* WindowSmoother::Likeliest(const WindowStart& start,
                                                       double usual) {
  const Trial* best = Try(start, usual);
  for (const double walk : kDriftingWalks) {
    if (walk < 2.0 * usual) continue;
    if (walk > kFastestDrift * WarmUpWalk(input_)) break;
    const Trial* found = Try(start, walk);
    if (found == nullptr) continue;
    if (best != nullptr) {
      const double gain = found->log_likelihood - best->log_likelihood;
      if (gain < 0.0) break;
      if (gain < Notably(found->nis)) continue;
    }
    best = found;
  }
  return best;
}

const WindowSmoother::Trial* WindowSmoother::LargestWalk(
    const WindowStart& start, const Trial* likeliest) {
  const double most = WarmUpWalk(input_);
  const Trial* largest = likeliest;
  std::vector<double> walks(kDriftingWalks.begin(), kDriftingWalks.end());
  std::erase_if(walks, [&](double walk) { return walk >= most; });
  walks.push_back(most);
  for (const double walk : walks) {
    if (walk <= likeliest->walk) continue;
    const Trial* found = Try(start, walk);
    if (found == nullptr) continue;
    if (found->log_likelihood <
        likeliest->log_likelihood - Notably(likeliest->nis)) {
      break;
    }
    largest = found;
  }
  return largest;
}

const WindowSmoother::Trial* WindowSmoother::Try(const WindowStart& start,
                                                 double walk) {
  if (const auto it = trials_.find(walk); it != trials_.end()) {
    return &it->second;
  }
  WindowModel model(input_, t_end_, known_, data_, walk);
  std::optional<Trial> trial;
  if (next_) trial = Settle(*next_, &model);
  if (!trial) {
    next_ = Begin(start, &model);
    if (next_) trial = Settle(*next_, &model);
  }
  if (!trial) {
    next_.reset();
    return nullptr;
  }
  if (trial->innovation_nis < kExplained) {
    next_->states = trial->states;
  } else {
    next_.reset();
  }
  return &trials_.emplace(walk, *std::move(trial)).first->second;
}

std::optional<WindowSmoother::Beginning> WindowSmoother::Begin(
    const WindowStart& start, WindowModel* model) {
  try {
    SmoothedTrajectory rough = model->FilterFrom(start);
    return Beginning{rough.states.front(), std::move(rough.states),
                     std::move(rough.P)};
  } catch (const EstimationError&) {
    return std::nullopt;  // diverged
  }
}

std::optional<WindowSmoother::Trial> WindowSmoother::Settle(
    const Beginning& from, WindowModel* model) {
  try {
    IteratedResult result = model->Settle(from.near, from.states, from.rough);
    if (!result.converged) return std::nullopt;
    std::vector<State>& states = result.trajectory.states;
    const double nis = model->Nis(states);
    return Trial{.walk = model->gyro_bias_walk(),
                 .near = from.near,
                 .states = std::move(states),
                 .nis = nis,
                 .innovation_nis = result.nis,
                 .log_likelihood = result.log_likelihood};
  } catch (const EstimationError&) {
    return std::nullopt;  // diverged
  }
}

WindowSolution WindowSmoother::WithCovariances(const Trial& trial) const {
  WindowModel model(input_, t_end_, known_, data_, trial.walk);
  SmoothedTrajectory smoothed = model.Smooth(trial.near, trial.states);
  WindowSolution out;
  out.layout = model.layout();
  out.gyro_bias_walk = trial.walk;
  out.log_likelihood = trial.log_likelihood;
  out.nis = trial.nis;
  const double scale = std::max(1.0, out.nis);
  out.P = CovarianceSeries(out.layout.dim(), smoothed.P.size());
  for (std::size_t k = 0; k < out.P.size(); ++k) {
    out.P.Set(k, ErrorMatrix(scale * smoothed.P.Get(k)));
  }
  out.states = std::move(smoothed.states);
  return out;
}

}  // namespace hindsight
