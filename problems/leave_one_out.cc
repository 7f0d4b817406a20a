#include "problems/leave_one_out.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "base/error.h"
#include "evaluation/given_values.h"
#include "filters/forward_filter.h"
#include "filters/rts.h"
#include "problems/explanations.h"
#include "problems/judged_innovations.h"

namespace hindsight {
namespace {

/// Of how far an a priori value is from what the data say, how uncertain it is taken
/// to be: its pull is left a hundredth.
constexpr double kLoosened = 10.0;

class Leaving {
 public:
  Leaving(const Dataset& dataset, const Relinearised& solution,
          const LinearTape& all, Problem* problem,
          const EpochCallback& callback)
      : dataset_(dataset),
        solution_(solution),
        with_(SmoothMeans(all)),
        problem_(problem),
        callback_(callback) {}

  LeftOutSensor Find(std::span<const int> sensors,
                     const std::vector<Explanation>& explanations) {
    LeftOutSensor out;
    if (const std::optional<double> effect = EffectWithoutPrior()) {
      out.sensors.emplace_back(kPriorValues);
      out.effect = *effect;
    }
    // Without the only sensor there is nothing that could not fit.
    if (sensors.size() < 2) return out;
    for (const int sensor : sensors) {
      const std::string& name =
          problem_->timeline.sensors()[static_cast<std::size_t>(sensor)].name;
      if (IsBetterExplainedByTheImu(name, explanations)) continue;
      const std::optional<double> effect = EffectWithout(sensor);
      if (!effect) continue;
      out.sensors.push_back(name);
      out.effect = *effect;
      out.onset = OnsetOf(name, explanations);
    }
    return out;
  }

 private:
  /// Without the sensor that shows an error of the IMU all would fit as well:
  /// then what the error is decides whose it is.
  static bool IsBetterExplainedByTheImu(
      const std::string& sensor, const std::vector<Explanation>& explanations) {
    double own = 0.0, others = 0.0;
    for (const Explanation& one : explanations) {
      if (one.sensor == sensor) own = std::max(own, one.z);
      if (one.sensor.empty()) others = std::max(others, one.z);
    }
    return others > own;
  }

  static std::optional<double> OnsetOf(
      const std::string& sensor, const std::vector<Explanation>& explanations) {
    for (const Explanation& one : explanations) {
      if (one.sensor == sensor) return one.onset;
    }
    return std::nullopt;
  }

  std::optional<double> EffectWithout(int sensor) {
    const GateDecisions before = problem_->decisions;
    const std::vector<Measurement>& measurements =
        problem_->timeline.all_measurements();
    problem_->decisions.resize(measurements.size(), 1);
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      if (measurements[i].sensor == sensor) problem_->decisions[i] = 0;
    }
    const std::optional<double> effect = EffectIfFits();
    problem_->decisions = before;
    return effect;
  }

  /// Without what the prior says of the components that end far from it; none if
  /// none does.
  std::optional<double> EffectWithoutPrior() {
    const ErrorMatrix before = problem_->prior.P;
    const ErrorVector off =
        Local(problem_->layout, problem_->prior.x, solution_.states.front());
    const double limit = StrainLimit(static_cast<int>(off.size()));
    bool strained = false;
    for (int i = 0; i < off.size(); ++i) {
      const double variance = problem_->prior.P(i, i);
      if (off(i) * off(i) <= limit * limit * variance) continue;
      problem_->prior.P(i, i) += kLoosened * kLoosened * off(i) * off(i);
      strained = true;
    }
    const std::optional<double> effect =
        strained ? EffectIfFits() : std::nullopt;
    problem_->prior.P = before;
    return effect;
  }

  /// Of the problem as it is now, against all of it.
  std::optional<double> EffectIfFits() {
    try {
      const LinearTape tape =
          RunLinearizedFilter(solution_.states, problem_, callback_);
      if (Fits(tape)) return Distance(tape);
    } catch (const EstimationError&) {
      // The rest does not even make a filter.
    }
    return std::nullopt;
  }

  bool Fits(const LinearTape& tape) const {
    return LargestExcess(TestInnovations(
               InnovationsOf(tape, problem_->timeline, dataset_),
               kFalseAlarms)) < 1.0 &&
           !ExplanationSearch(*problem_, solution_.states, tape, kFalseAlarms,
                              callback_)
                .found_any();
  }

  double Distance(const LinearTape& tape) const {
    if (!tape.layout().has_canonical_head()) {
      return std::numeric_limits<double>::infinity();
    }
    const SmoothedTrajectory without = SmoothMeans(tape);
    NavigationVariances squares = NavigationVariances::Zero();
    for (std::size_t k = 0; k < tape.size(); ++k) {
      const NavigationVariances apart =
          without.d[k].head<9>() - with_.d[k].head<9>();
      squares +=
          apart.cwiseProduct(apart).cwiseQuotient(solution_.variances[k]);
    }
    return std::sqrt(squares.maxCoeff() / static_cast<double>(tape.size()));
  }

  const Dataset& dataset_;
  const Relinearised& solution_;
  const SmoothedTrajectory with_;
  Problem* problem_;
  const EpochCallback& callback_;
};

}  // namespace

LeftOutSensor LeaveOneOut(const Dataset& dataset, const Relinearised& solution,
                          const LinearTape& all, std::span<const int> sensors,
                          const std::vector<Explanation>& explanations,
                          Problem* problem, const EpochCallback& callback) {
  return Leaving(dataset, solution, all, problem, callback)
      .Find(sensors, explanations);
}

}  // namespace hindsight
