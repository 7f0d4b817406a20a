#include "filters/forward_filter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <limits>

#include "base/error.h"
#include "filters/transport.h"
#include "measurements/distance_link.h"

namespace hindsight {

double GateLimit(const Sensor& sensor, int rows) {
  if (!sensor.gate_probability) {
    return std::numeric_limits<double>::infinity();
  }
  return boost::math::quantile(boost::math::chi_squared(rows),
                               *sensor.gate_probability);
}

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
        decisions_(decisions),
        error_(model.error),
        policy_(model.covariance, layout),
        tape_(layout, model.error),
        x_(prior.x),
        P_(prior.P),
        dx_(ErrorVector::Zero(layout.dim())) {
    tape_.Reserve(timeline->size());
    transition_.c = ErrorVector::Zero(layout.dim());
    if (!policy_.is_kalman()) tape_.ForbidSmoothing();
    for (const Sensor& sensor : timeline_.sensors()) {
      for (int rows = 1; rows <= kMaxRows; ++rows) {
        gate_limits_.push_back(GateLimit(sensor, rows));
      }
    }
  }

  /// Expresses the prior about another nominal: the prior's mean becomes an
  /// error, its covariance moves into the new tangent.
  void StartAbout(const State& nominal) {
    const State prior_mean = x_;
    fixed_nominal_ = true;
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
    Innovation innovation = Innovate(linearized_, dx_, P_);
    const RobustLoss& loss =
        timeline_.sensors()[static_cast<std::size_t>(z.sensor)].loss;
    if (loss.kind != RobustLoss::Kind::kNone && !z.withheld) {
      linearized_.R /= std::max(loss.Weight(RobustArgument(innovation)), 1e-9);
      innovation = Innovate(linearized_, dx_, P_);
    }
    TapeMeasurement header;
    header.index = index;
    header.sensor = z.sensor;
    header.withheld = z.withheld;
    header.accepted = !z.withheld && Accept(k, z, index, innovation);
    tape_.Record(header, linearized_, innovation);
    if (header.accepted) Update(linearized_, innovation, &dx_, &P_);
  }

  /// What the robust loss is asked about. About a fixed nominal it is the
  /// residual there, which makes the pass a step of iteratively reweighted
  /// least squares; a filter that only knows the past must allow for its own
  /// uncertainty.
  double RobustArgument(const Innovation& innovation) const {
    if (!fixed_nominal_) return innovation.nis;
    return Eigen::LLT<RowMatrix>(linearized_.R)
        .matrixL()
        .solve(linearized_.residual)
        .squaredNorm();
  }

  bool Accept(std::size_t k, const Measurement& z, int index,
              const Innovation& innovation) const {
    if (!decisions_.empty()) {
      return decisions_[static_cast<std::size_t>(
                 timeline_.node(k).first_measurement + index)] != 0;
    }
    const auto rows = innovation.residual.size();
    return innovation.nis <= gate_limits_[static_cast<std::size_t>(
                                 z.sensor * kMaxRows + rows - 1)];
  }

  const ErrorLayout& layout_;
  Timeline& timeline_;
  const GateDecisions& decisions_;
  ErrorDefinition error_;
  CovariancePolicy policy_;
  LinearTape tape_;
  State x_;
  ErrorMatrix P_;
  ErrorVector dx_;
  Transition transition_;
  LinearizedMeasurement linearized_;
  std::vector<double> gate_limits_;
  bool fixed_nominal_ = false;
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
