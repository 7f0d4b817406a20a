#include "problems/reconstruction.h"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "alignment/start.h"
#include "base/error.h"
#include "base/processor_time.h"
#include "base/units.h"
#include "dataset/timeline_builder.h"
#include "filters/transport.h"
#include "filters/two_filter.h"
#include "problems/batch.h"
#include "problems/contradictions.h"
#include "problems/linearisation.h"
#include "problems/robust_batch.h"
#include "problems/sample_solution.h"
#include "problems/sensor_imm.h"
#include "problems/solution_builder.h"
#include "problems/verdict.h"

namespace hindsight {
namespace {

constexpr std::pair<Method, const char*> kMethods[] = {
    {Method::kEkf, "ekf"},
    {Method::kTwoFilter, "two_filter"},
    {Method::kTwoFilterConventional, "two_filter_conventional"},
    {Method::kTwoFilterEuler, "two_filter_euler"},
    {Method::kHInfinity, "hinf"},
    {Method::kModifiedHInfinity, "modified_hinf"},
    {Method::kRts, "rts"},
    {Method::kIterated, "iterated"},
    {Method::kBatch, "batch"},
    {Method::kGatedEkf, "gated_ekf"},
    {Method::kImm, "imm"},
    {Method::kImmSmoother, "imm_smoother"},
    {Method::kRobustBatch, "robust_batch"}};

bool HasGates(const Timeline& timeline) {
  for (const Sensor& sensor : timeline.sensors()) {
    if (sensor.gate_probability) return true;
  }
  return false;
}

/// Moves covariances from the tangent of the nominal they were computed about
/// into that at the smoothed states.
void TransportSeries(const ErrorLayout& layout, const std::vector<State>& from,
                     const std::vector<State>& to, CovarianceSeries* P) {
  for (std::size_t k = 0; k < P->size(); ++k) {
    ErrorMatrix P_k = P->Get(k);
    MoveCovariance(Transport(layout, from[k], to[k]), &P_k);
    P->Set(k, P_k);
  }
}

/// The nominal about which the tape's smoothed covariances are.
std::vector<State> NominalOf(const LinearTape& tape) {
  std::vector<State> nominal;
  nominal.reserve(tape.size());
  for (std::size_t k = 0; k < tape.size(); ++k) {
    nominal.push_back(tape.epoch(k).x_plus);
  }
  return nominal;
}

}  // namespace

const char* MethodName(Method method) {
  for (const auto& [value, name] : kMethods) {
    if (value == method) return name;
  }
  return "";
}

Method MethodFromName(const std::string& name) {
  std::string known;
  for (const auto& [value, text] : kMethods) {
    if (name == text) return value;
    known += (known.empty() ? "" : ", ") + std::string(text);
  }
  throw InputError("unknown method '" + name + "'; known are " + known);
}

bool DependsOnError(Method method) {
  return method != Method::kImm && method != Method::kImmSmoother &&
         method != Method::kRobustBatch;
}

struct Reconstruction::Impl {
  Impl(const Dataset& dataset_in, ReconstructionOptions options_in)
      : dataset(dataset_in),
        options(std::move(options_in)),
        start(FindStart(dataset, options.from, options.to)),
        timeline(BuildTimeline(dataset, MakeTimelineOptions())) {
    start.prior.x.t = timeline.node(0).t;
  }

  TimelineOptions MakeTimelineOptions() const {
    TimelineOptions timeline_options;
    timeline_options.t_begin = start.report.t;
    timeline_options.t_end = std::min(options.to, dataset.imu.t_end());
    timeline_options.extra_times = options.node_times;
    timeline_options.time_offsets = placed_offsets;
    timeline_options.with_scale_jacobians =
        start.layout.Has(BlockKind::kGyroScale) ||
        start.layout.Has(BlockKind::kAccelScale);
    if (timeline_options.t_end <= timeline_options.t_begin) {
      throw EstimationError("the start at " + std::to_string(start.report.t) +
                            " s leaves no interval to reconstruct");
    }
    return timeline_options;
  }

  EpochCallback Progress(const std::string& stage) const {
    return [this, stage](std::size_t done) {
      if (options.stop != nullptr && *options.stop) throw Interrupted();
      if (options.progress && (done % 64 == 0 || done == timeline.size())) {
        options.progress(stage, static_cast<double>(done) /
                                    static_cast<double>(timeline.size()));
      }
    };
  }

  /// Forward filter and RTS pass about it; run once, and again wherever the
  /// pass shows that measurements belong to other times.
  void RunForward() {
    if (rts) return;
    constexpr int kMaxPlacements = 6;
    for (const Sensor& sensor : timeline.sensors()) {
      placed_offsets.push_back(sensor.time_offset);
    }
    for (int i = 1;; ++i) {
      RunForwardOnce();
      const int moved = MoveOffsets();
      if (moved < 0) break;
      if (i == kMaxPlacements) {
        unsettled = timeline.sensors()[static_cast<std::size_t>(moved)].name;
        break;
      }
      timeline = BuildTimeline(dataset, MakeTimelineOptions());
      settled.reset();
    }
    JudgeLinearisation();
  }

  /// Looks at the interval as linearised anew about its smoothed trajectory
  /// where one linearisation may not do. From an unknown heading the
  /// covariances of a filter that resets its nominal feign information; and a
  /// filter that turned far was linearised far off.
  void JudgeLinearisation() {
    constexpr double kKnownHeading = 20.0 * kDegree;
    constexpr double kFarTurn = 5.0 * kDegree;
    Solution smoothed;
    smoothed.layout = start.layout;
    smoothed.states = rts->states;
    smoothed.covariances = rts->P;
    const bool knows_heading = start.report.attitude_sigma.z() <= kKnownHeading;
    const double turn = LargestTurn(ekf->states, rts->states);
    if (!knows_heading || turn > kFarTurn) {
      CovarianceSeries P = Relinearise(turn);
      if (!knows_heading && !P.empty()) smoothed.covariances = std::move(P);
    }
    unobserved = FindUnobserved(smoothed);
  }

  /// Returns the covariances of the new linearisation, none if none held.
  CovarianceSeries Relinearise(double turn) {
    IterationOptions iteration;
    iteration.max_iterations = 3;
    iteration.callback = Progress("observability");
    anew = Relinearised{turn, {}, std::numeric_limits<double>::infinity()};
    try {
      SmoothedTrajectory trajectory =
          SmoothIterated(start.layout, start.prior, rts->states, &timeline,
                         decisions, iteration)
              .trajectory;
      anew->states = std::move(trajectory.states);
      anew->smoother_sigmas =
          DistanceInSigmas(start.layout, rts->states, rts->P, anew->states);
      return std::move(trajectory.P);
    } catch (const EstimationError&) {
      return {};
    }
  }

  LinearTape RunKalman(const GateDecisions& gates,
                       const EpochCallback& callback) {
    return RunForwardFilter({options.error, {}}, start.layout, start.prior,
                            &timeline, gates, callback);
  }

  void RunForwardOnce() {
    const double t0 = ProcessorSeconds();
    LinearTape tape = RunKalman({}, Progress("ekf"));
    ekf = FilterSolution(tape);
    ekf->seconds = ProcessorSeconds() - t0;
    decisions = DecisionsOnTape(tape);
    rts = SmoothTape(std::move(tape));
    if (HasGates(timeline)) RepeatWithSmoothedGates();
    rts_seconds = ProcessorSeconds() - t0 - ekf->seconds;
  }

  /// Takes over every estimated time offset that is more than 20 ms from where
  /// the sensor's nodes were placed; the last such sensor, or -1.
  int MoveOffsets() {
    constexpr double kFarthest = 0.02;
    int moved = -1;
    for (std::size_t i = 0; i < placed_offsets.size(); ++i) {
      const Block* block =
          start.layout.Find(BlockKind::kTimeOffset, static_cast<int>(i));
      if (block == nullptr) continue;
      const double estimate = SettledParameters()(block->parameter_offset);
      if (std::abs(estimate - placed_offsets[i]) < kFarthest) continue;
      if (!std::isfinite(estimate)) {
        throw EstimationError("the time offset of " +
                              timeline.sensors()[i].name + " diverged");
      }
      placed_offsets[i] = estimate;
      moved = static_cast<int>(i);
    }
    return moved;
  }

  /// Constants after a few iterations about the smoothed trajectory: one pass
  /// may still be far off where the start was.
  const ParameterVector& SettledParameters() {
    if (!settled) {
      IterationOptions iteration;
      iteration.max_iterations = 4;
      iteration.callback = Progress("calibration");
      settled = SmoothIterated(start.layout, start.prior, rts->states,
                               &timeline, decisions, iteration)
                    .trajectory.states.back()
                    .parameters;
    }
    return *settled;
  }

  SmoothedTrajectory SmoothTape(LinearTape tape) const {
    const std::vector<State> about = NominalOf(tape);
    SmoothedTrajectory smoothed = SmoothRts(std::move(tape));
    TransportSeries(start.layout, about, smoothed.states, &smoothed.P);
    smoothed.d = {};
    return smoothed;
  }

  /// The innovation gate knows only the past; what the whole interval says of a
  /// measurement decides for all whole-interval methods.
  void RepeatWithSmoothedGates() {
    const GateDecisions smoothed =
        DecideGates(start.layout, timeline, *rts, decisions);
    if (smoothed == decisions) return;
    decisions = smoothed;
    rts = SmoothTape(RunKalman(decisions, Progress("rts")));
  }

  Solution Finish(Solution solution, Method method, double seconds) {
    solution.method = MethodName(method);
    solution.seconds = seconds;
    Conclude(timeline.sensors(), unobserved,
             LinearisedTooFarOff(method, solution, anew), &solution);
    for (std::string& note :
         FindContradictions(timeline.sensors(), start.prior, solution)) {
      solution.notes.push_back(std::move(note));
    }
    if (!unsettled.empty()) {
      solution.usable = false;
      solution.verdict =
          "not usable: the time offset of " + unsettled + " does not settle";
    }
    return solution;
  }

  Solution FromSmoothed(std::vector<State> states, CovarianceSeries P) const {
    return SmoothedSolution(start.layout, timeline, std::move(states),
                            std::move(P), decisions);
  }

  /// Hands out the forward pass's solution, which a day makes too large to keep
  /// twice; whoever asks again has it filtered again.
  Solution RunEkf() {
    if (!ekf) {
      const double t0 = ProcessorSeconds();
      ekf = FilterSolution(RunKalman({}, Progress("ekf")));
      ekf->seconds = ProcessorSeconds() - t0;
    }
    Solution solution = std::move(*ekf);
    ekf.reset();
    const double seconds = solution.seconds;
    return Finish(std::move(solution), Method::kEkf, seconds);
  }

  /// The tape was released by the RTS pass; filtering again about the same
  /// decisions costs less than keeping it.
  Solution RunTwoFilter(Method method) {
    const LinearTape tape = RunKalman(decisions, Progress(MethodName(method)));
    const double t0 = ProcessorSeconds();
    TwoFilterResult result = method == Method::kTwoFilter
                                 ? SmoothTwoFilter(tape)
                                 : SmoothTwoFilterConventional(
                                       tape, method == Method::kTwoFilterEuler
                                                 ? ChartKind::kEuler
                                                 : ChartKind::kAdditive);
    SmoothedTrajectory& trajectory = result.trajectory;
    TransportSeries(start.layout, NominalOf(tape), trajectory.states,
                    &trajectory.P);
    const double seconds = ProcessorSeconds() - t0;
    Solution solution =
        FromSmoothed(std::move(trajectory.states), std::move(trajectory.P));
    solution.separation = std::move(result.separation);
    return Finish(std::move(solution), method, seconds);
  }

  Solution RunObserver(Method method, const CovarianceOptions& covariance) {
    const double t0 = ProcessorSeconds();
    const LinearTape tape =
        RunForwardFilter({options.error, covariance}, start.layout, start.prior,
                         &timeline, {}, Progress(MethodName(method)));
    Solution solution = FilterSolution(tape);
    const bool has_gamma = covariance.rule == RiccatiRule::kHInfinity;
    const ObserverFigures figures = {
        .gamma = has_gamma ? covariance.gamma : 0.0,
        .alpha = has_gamma ? 0.0 : covariance.alpha,
        .delta = has_gamma ? 0.0 : covariance.delta,
        .steps = static_cast<int>(tape.size()) - 1,
        .back_offs = tape.bound().back_offs,
        .least_information = tape.bound().least_information};
    if (figures.back_offs > 0) {
      solution.notes.push_back(
          "no bounded gain at " + std::to_string(figures.back_offs) + " of " +
          std::to_string(figures.steps) +
          " steps, which it took without the weight of L'L");
    }
    solution.observer = figures;
    return Finish(std::move(solution), method, ProcessorSeconds() - t0);
  }

  Solution RunIterated() {
    const double t0 = ProcessorSeconds();
    IterationOptions iteration;
    iteration.max_iterations = options.max_iterations;
    iteration.callback = Progress("iterated");
    IteratedResult result =
        SmoothIterated(start.layout, start.prior, rts->states, &timeline,
                       decisions, iteration);
    Solution solution = FromSmoothed(std::move(result.trajectory.states),
                                     std::move(result.trajectory.P));
    solution.iterations = result.iterations;
    solution.converged = result.converged;
    return Finish(std::move(solution), Method::kIterated,
                  ProcessorSeconds() - t0);
  }

  BatchOptions MakeBatchOptions() const {
    BatchOptions batch;
    batch.max_iterations = options.max_iterations;
    batch.callback = [this](int iteration) {
      if (options.stop != nullptr && *options.stop) throw Interrupted();
      if (options.progress) {
        options.progress(
            "batch", static_cast<double>(iteration) / options.max_iterations);
      }
    };
    return batch;
  }

  Solution RunBatch() {
    const double t0 = ProcessorSeconds();
    BatchResult result = SolveBatch(start.layout, start.prior, rts->states,
                                    &timeline, decisions, MakeBatchOptions());
    Solution solution =
        FromSmoothed(std::move(result.states), std::move(result.P));
    solution.iterations = result.iterations;
    solution.converged = result.converged;
    return Finish(std::move(solution), Method::kBatch, ProcessorSeconds() - t0);
  }

  Solution RunGatedEkf() {
    constexpr double kGate = 0.999;
    const double t0 = ProcessorSeconds();
    Timeline gated = timeline;
    for (std::size_t i = 0; i < gated.sensors().size(); ++i) {
      Sensor sensor = gated.sensors()[i];
      if (!sensor.gate_probability) sensor.gate_probability = kGate;
      gated.SetSensor(i, sensor);
    }
    return Finish(FilterSolution(RunForwardFilter(
                      {options.error, {}}, start.layout, start.prior, &gated,
                      {}, Progress("gated_ekf"))),
                  Method::kGatedEkf, ProcessorSeconds() - t0);
  }

  Solution RunImmMethod(Method method) {
    const double t0 = ProcessorSeconds();
    const SensorImm imm = MakeSensorImm(start, timeline, decisions);
    const ImmResult result =
        RunImm(imm.models, imm.options, &timeline, Progress("imm"));
    Solution solution =
        method == Method::kImm
            ? ImmFilterSolution(imm, result)
            : ImmSmootherSolution(imm, timeline, SmoothImm(result.tape));
    return Finish(std::move(solution), method, ProcessorSeconds() - t0);
  }

  Solution RunRobustBatch() {
    const double t0 = ProcessorSeconds();
    int receiver = -1;
    for (std::size_t i = timeline.sensors().size(); i-- > 0;) {
      if (timeline.sensors()[i].type == SensorType::kPosition) {
        receiver = static_cast<int>(i);
      }
    }
    if (receiver < 0) {
      throw EstimationError("robust_batch needs a position sensor");
    }
    GateDecisions used = decisions;
    for (std::size_t i = 0; i < used.size(); ++i) {
      const Measurement& z = timeline.all_measurements()[i];
      if (z.sensor == receiver) used[i] = static_cast<char>(!z.withheld);
    }
    // The EKF's trajectory may be so far off after an outlier that a
    // linearisation about it is of no use.
    const SensorImm imm = MakeSensorImm(start, timeline, decisions);
    const ImmSmoothed rough = SmoothImm(
        RunImm(imm.models, imm.options, &timeline, Progress("robust_batch"))
            .tape);
    RobustBatchResult result = SolveRobustBatch(
        start.layout, start.prior, rough.trajectory.states, receiver, timeline,
        used, MakeBatchOptions(), Progress("robust_batch"));
    Solution solution = SmoothedSolution(
        result.layout, result.timeline, std::move(result.batch.states),
        std::move(result.batch.P), result.decisions);
    std::size_t record = 0;
    for (std::size_t k = 0; k < result.timeline.size(); ++k) {
      for (const Measurement& z : result.timeline.measurements(k)) {
        ResidualRecord& r = solution.residuals[record++];
        if (z.sensor == receiver && !z.withheld) r.weight *= result.Trust(k);
      }
    }
    solution.iterations = result.batch.iterations;
    solution.converged = result.batch.converged;
    solution.mode_probabilities = std::move(result.probabilities);
    solution.mode_names = {"good", "biased", "drifting"};
    solution.notes = std::move(result.notes);
    return Finish(std::move(solution), Method::kRobustBatch,
                  ProcessorSeconds() - t0);
  }

  const Dataset& dataset;
  ReconstructionOptions options;
  /// Time offsets the nodes are placed by; empty: those of the sensors.
  std::vector<double> placed_offsets;
  /// Sensor whose estimated time offset went on moving; empty: none.
  std::string unsettled;
  std::optional<ParameterVector> settled;
  /// Spans that the data leave undetermined.
  std::vector<UnobservedSpan> unobserved;
  std::optional<Relinearised> anew;
  Start start;
  Timeline timeline;
  std::optional<Solution> ekf;
  std::optional<SmoothedTrajectory> rts;
  double rts_seconds = 0.0;
  GateDecisions decisions;
};

Reconstruction::Reconstruction(const Dataset& dataset,
                               ReconstructionOptions options)
    : impl_(std::make_unique<Impl>(dataset, std::move(options))) {}

Reconstruction::~Reconstruction() = default;

Solution Reconstruction::Run(Method method) {
  impl_->RunForward();
  switch (method) {
    case Method::kEkf:
      return impl_->RunEkf();
    case Method::kTwoFilter:
    case Method::kTwoFilterConventional:
    case Method::kTwoFilterEuler:
      return impl_->RunTwoFilter(method);
    case Method::kHInfinity:
      return impl_->RunObserver(method, impl_->options.h_infinity);
    case Method::kModifiedHInfinity:
      return impl_->RunObserver(method, impl_->options.modified_h_infinity);
    case Method::kRts:
      return impl_->Finish(
          impl_->FromSmoothed(impl_->rts->states, impl_->rts->P), method,
          impl_->rts_seconds);
    case Method::kIterated:
      return impl_->RunIterated();
    case Method::kBatch:
      return impl_->RunBatch();
    case Method::kGatedEkf:
      return impl_->RunGatedEkf();
    case Method::kImm:
    case Method::kImmSmoother:
      return impl_->RunImmMethod(method);
    case Method::kRobustBatch:
      return impl_->RunRobustBatch();
  }
  throw std::logic_error("unknown method");
}

std::vector<UnobservedSpan> Reconstruction::Unobserved() {
  impl_->RunForward();
  return impl_->unobserved;
}

const StartReport& Reconstruction::start() const { return impl_->start.report; }

Solution Reconstruction::Sample(const Solution& solution,
                                const std::vector<double>& times) const {
  return SampleSolution(solution, impl_->dataset.imu, times);
}

Solution Solve(const Dataset& dataset, const ReconstructionOptions& options) {
  Reconstruction reconstruction(dataset, options);
  return reconstruction.Run(options.method);
}

}  // namespace hindsight
