#include "filters/forward_filter.h"

#include <string>
#include <utility>

#include "base/error.h"
#include "filters/transport.h"
#include "measurements/distance_link.h"

namespace hindsight {

namespace {

/// One pass over the timeline; the two public filters differ in where the
/// nominal comes from and whether the update moves it.
class ForwardPass {
 public:
  ForwardPass(const ForwardModel& model, const ErrorLayout& layout,
              const Prior& prior, Timeline* timeline,
              const GateDecisions& decisions)
      : layout_(layout),
        timeline_(*timeline),
        rule_(*timeline, decisions),
        error_(model.error),
        policy_(model.covariance, layout),
        tape_(layout, model.error),
        x_(prior.x),
        P_(prior.P),
        dx_(ErrorVector::Zero(layout.dim())) {
    tape_.Reserve(timeline->size());
    transition_.c = ErrorVector::Zero(layout.dim());
    rule_.Suppose(model.supposition);
    if (!policy_.is_kalman()) tape_.ForbidSmoothing();
  }

  /// Expresses the prior about another nominal: the prior's mean becomes an
  /// error, its covariance moves into the new tangent.
  void StartAbout(const State& nominal) {
    const State prior_mean = x_;
    rule_.AboutFixedNominal();
    x_ = nominal;
    dx_ = Local(layout_, nominal, prior_mean);
    MoveCovariance(Transport(layout_, prior_mean, nominal), &P_);
  }

  /// Time update of the interval that ends at node k, to the predicted state.
  void PredictTo(std::size_t k) {
    const ImuSummary& summary =
        timeline_.Summary(k - 1, CalibrationOf(layout_, x_));
    State predicted = Predict(layout_, x_, summary);
    PredictDistances(layout_, timeline_, k - 1, x_, &predicted);
    LinearizeTransition(layout_, summary, x_, predicted, &transition_);
    transition_.c.setZero();
    LinearizeDistances(layout_, timeline_, k - 1, x_, predicted, &transition_);
    Propagate(predicted, summary.dt());
  }

  /// Time update to a given nominal, with its defect.
  void PredictTo(std::size_t k, const State& nominal) {
    const ImuSummary& summary =
        timeline_.Summary(k - 1, CalibrationOf(layout_, x_));
    LinearizeTransition(layout_, summary, x_, nominal, &transition_);
    LinearizeDistances(layout_, timeline_, k - 1, x_, nominal, &transition_);
    Propagate(nominal, summary.dt());
  }

  /// Measurement update at node k and a new epoch on the tape.
  void UpdateAt(std::size_t k, bool reset) {
    TapeEpoch epoch;
    epoch.t = timeline_.node(k).t;
    epoch.x_minus = x_;
    epoch.c = transition_.c;
    epoch.dx_minus = dx_;
    const ErrorMatrix P_minus = P_;
    const auto measurements = timeline_.measurements(k);
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      Use(k, measurements[i], static_cast<int>(i));
    }
    if (k > 0) policy_.Bound(epoch.t, StepTo(k), &dx_, &P_);
    epoch.dx_plus = dx_;
    if (reset) {
      epoch.reset = true;
      x_ = Retract(error_, layout_, x_, dx_);
      x_.t = epoch.t;
      if (!measurements.empty()) {
        MoveCovariance(Transport(error_, layout_, epoch.x_minus, dx_, x_), &P_);
      }
      dx_.setZero();
    }
    if (!dx_.allFinite() || !x_.p_e.allFinite() || !P_.allFinite()) {
      throw EstimationError(
          "filter diverged at t = " + std::to_string(epoch.t) + " s");
    }
    epoch.x_plus = x_;
    tape_.Append(std::move(epoch), transition_, P_minus, P_);
  }

  LinearTape TakeTape() {
    tape_.SetBound(policy_.record());
    return std::move(tape_);
  }

 private:
  double StepTo(std::size_t k) const {
    return timeline_.node(k).t - timeline_.node(k - 1).t;
  }

  void Propagate(const State& nominal, double dt) {
    dx_ = (transition_.Phi * dx_ + transition_.c).eval();
    policy_.Predict(transition_, dt, &P_);
    x_ = nominal;
  }

  void Use(std::size_t k, const Measurement& z, int index) {
    Evaluate(z, timeline_.Context(k, z, layout_, x_), &linearized_);
    Innovation innovation;
    const MeasurementVerdict verdict =
        rule_.Judge(k, index, dx_, P_, &linearized_, &innovation);
    TapeMeasurement header;
    header.index = index;
    header.sensor = z.sensor;
    header.withheld = z.withheld;
    header.accepted = verdict.accepted;
    header.weight = verdict.weight;
    tape_.Record(header, linearized_, innovation);
    if (header.accepted) Update(linearized_, innovation, &dx_, &P_);
  }

  const ErrorLayout& layout_;
  Timeline& timeline_;
  MeasurementRule rule_;
  ErrorDefinition error_;
  CovariancePolicy policy_;
  LinearTape tape_;
  State x_;
  ErrorMatrix P_;
  ErrorVector dx_;
  Transition transition_;
  LinearizedMeasurement linearized_;
};

}  // namespace

LinearTape RunForwardFilter(const ForwardModel& model,
                            const ErrorLayout& layout, const Prior& prior,
                            Timeline* timeline, const GateDecisions& decisions,
                            const EpochCallback& callback) {
  ForwardPass pass(model, layout, prior, timeline, decisions);
  for (std::size_t k = 0; k < timeline->size(); ++k) {
    if (k > 0) pass.PredictTo(k);
    pass.UpdateAt(k, /*reset=*/true);
    if (callback) callback(k + 1);
  }
  return pass.TakeTape();
}

LinearTape RunExtendedKalmanFilter(const ErrorLayout& layout,
                                   const Prior& prior, Timeline* timeline,
                                   const GateDecisions& decisions,
                                   const EpochCallback& callback) {
  return RunForwardFilter({}, layout, prior, timeline, decisions, callback);
}

LinearTape RunLinearizedFilter(const ErrorLayout& layout, const Prior& prior,
                               std::span<const State> nominal,
                               Timeline* timeline,
                               const GateDecisions& decisions,
                               const EpochCallback& callback) {
  ForwardPass pass({}, layout, prior, timeline, decisions);
  pass.StartAbout(nominal.front());
  for (std::size_t k = 0; k < timeline->size(); ++k) {
    if (k > 0) pass.PredictTo(k, nominal[k]);
    pass.UpdateAt(k, /*reset=*/false);
    if (callback) callback(k + 1);
  }
  return pass.TakeTape();
}

}  // namespace hindsight
