#include "problems/reconstruction.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "alignment/gyro_drift.h"
#include "base/error.h"
#include "base/processor_time.h"
#include "dataset/magnetic_check.h"
#include "dataset/repeated_readings.h"
#include "evaluation/grade.h"
#include "filters/heading_profile.h"
#include "filters/iterated_smoother.h"
#include "filters/two_filter.h"
#include "problems/batch.h"
#include "problems/clock_choice.h"
#include "problems/disagreement.h"
#include "problems/error_tuning.h"
#include "problems/forward_stage.h"
#include "problems/linearisation.h"
#include "problems/node_placement.h"
#include "problems/robust_batch.h"
#include "problems/sample_solution.h"
#include "problems/sensor_imm.h"
#include "problems/solution_builder.h"

namespace hindsight {
namespace {

/// What the recording shows by itself, from the start to `to`.
std::vector<Evidence> ExamineRecording(const Dataset& dataset,
                                       const StartReport& start, double to) {
  std::vector<Evidence> all = FindRepeatedReadings(dataset, start.t, to);
  if (auto drift = FindGyroDrift(start, dataset.imu.noise)) {
    all.push_back(*std::move(drift));
  }
  for (std::string& warning : CheckMagnetometers(dataset)) {
    all.push_back({.rule = "magnetic_field",
                   .grade = Grade::kDoubtful,
                   .what = std::move(warning),
                   .is_cause = true});
  }
  return all;
}

}  // namespace

struct Reconstruction::Impl {
  Impl(const Dataset& dataset, const ReconstructionOptions& options)
      : clocks(ChooseClocks(dataset, options)),
        forward(*clocks.stage),
        recording(ExamineRecording(dataset, forward.start().report,
                                   forward.options().to)) {}

  Solution Finish(Solution solution, Method method, double seconds) {
    solution.method = MethodName(method);
    solution.forward = IsForward(method);
    solution.seconds = seconds;
    solution.rivals = clocks.rivals;
    if (forward.turned_round()) {
      solution.rivals.push_back(*forward.turned_round());
      SetProbabilities(&solution.rivals);
    }
    const Start& start = forward.start();
    if (!solution.observer) {
      WidenHeading(solution.layout,
                   std::min(forward.heading_credit(), own_credit,
                            [](const HeadingCredit& a, const HeadingCredit& b) {
                              return a.curvature < b.curvature;
                            }),
                   &solution.covariances);
    }
    Conclude(
        {.solution = solution,
         .sensors = forward.timeline().sensors(),
         .start = StartValues{.x = start.prior.x,
                              .P = start.prior.P,
                              .given = forward.dataset().initial,
                              .position = start.report.position,
                              .alignment = start.report.alignment},
         .linearisation = LinearisesOnce(method)
                              ? LinearisationErrorOf(method, solution,
                                                     forward.relinearised())
                              : std::nullopt,
         .unsettled =
             own_unsettled.empty() ? forward.unsettled() : own_unsettled,
         .recording = recording,
         .disagreement = DisagreementOf(method, solution)},
        forward.unobserved(), &solution);
    own_unsettled.clear();
    own_credit = {};
    return solution;
  }

  /// With a robust loss the two do not minimise the same cost.
  std::optional<Evidence> DisagreementOf(Method method,
                                         const Solution& solution) {
    if (method != Method::kIterated && method != Method::kBatch) {
      return std::nullopt;
    }
    for (const Sensor& sensor : forward.timeline().sensors()) {
      if (sensor.loss.kind != RobustLoss::Kind::kNone) return std::nullopt;
    }
    return optima.Compare(MethodName(method), solution);
  }

  /// What a method solves on: nodes, the measurements used there, and a
  /// trajectory to begin from.
  struct Stage {
    Timeline* timeline;
    const GateDecisions* decisions;
    const std::vector<State>* states;
  };

  /// Solves on the shared nodes, and on nodes of its own as long as the
  /// method's time offsets are elsewhere.
  template <typename Solver>
  Solution AtOwnNodes(const Solver& solve) {
    Solution solution = solve({&forward.timeline(), &forward.decisions(),
                               &forward.smoothed().states});
    std::optional<PlacedNodes> own;
    OffsetSearch search;
    for (int i = 1; forward.unsettled().empty(); ++i) {
      const std::vector<double>& offsets =
          own ? own->offsets : forward.offsets();
      const Timeline& timeline = own ? own->timeline : forward.timeline();
      const int sensor = FarthestFromNodes(
          solution.layout, offsets, solution.states.back(),
          solution.covariances.Get(solution.states.size() - 1));
      if (sensor < 0) break;
      if (i == kMaxPlacements) {
        own_unsettled =
            timeline.sensors()[static_cast<std::size_t>(sensor)].name;
        break;
      }
      own = forward.PlaceAnew(search.Next(solution.layout, timeline.sensors(),
                                          solution.states.back(), offsets),
                              solution.layout, solution.states, timeline,
                              own ? own->decisions : forward.decisions());
      solution = solve({&own->timeline, &own->decisions, &own->states});
    }
    return solution;
  }

  Solution FromSmoothed(std::vector<State> states, CovarianceSeries P,
                        const Stage& stage) const {
    return SmoothedSolution(forward.start().layout, *stage.timeline,
                            std::move(states), std::move(P), *stage.decisions);
  }
  Solution FromSmoothed(std::vector<State> states, CovarianceSeries P) {
    return FromSmoothed(std::move(states), std::move(P),
                        {&forward.timeline(), &forward.decisions(), nullptr});
  }

  void JudgeHeading(const Solution& solution, const Stage& stage) {
    own_credit = CreditHeading(forward.start().layout, forward.start().prior,
                               solution.states, solution.covariances,
                               stage.timeline, *stage.decisions);
  }

  Solution RunEkf() {
    Solution solution = forward.TakeFiltered();
    const double seconds = solution.seconds;
    return Finish(std::move(solution), Method::kEkf, seconds);
  }

  /// The tape was released by the RTS pass; filtering again about the same
  /// decisions costs less than keeping it.
  Solution RunTwoFilter(Method method) {
    const LinearTape tape =
        forward.Filter(forward.decisions(), MethodName(method));
    const double t0 = ProcessorSeconds();
    TwoFilterResult result = method == Method::kTwoFilter
                                 ? SmoothTwoFilter(tape)
                                 : SmoothTwoFilterConventional(
                                       tape, method == Method::kTwoFilterEuler
                                                 ? ChartKind::kEuler
                                                 : ChartKind::kAdditive);
    SmoothedTrajectory& trajectory = result.trajectory;
    MoveToSmoothed(forward.start().layout, NominalOf(tape), &trajectory);
    const double seconds = ProcessorSeconds() - t0;
    Solution solution =
        FromSmoothed(std::move(trajectory.states), std::move(trajectory.P));
    solution.separation = std::move(result.separation);
    return Finish(std::move(solution), method, seconds);
  }

  Solution RunObserver(Method method, const CovarianceOptions& covariance) {
    const double t0 = ProcessorSeconds();
    const LinearTape tape = RunForwardFilter(
        {forward.options().error, covariance}, forward.start().layout,
        forward.start().prior, &forward.timeline(), {},
        forward.Progress(MethodName(method)));
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
    iteration.max_iterations = forward.options().max_iterations;
    iteration.callback = forward.Progress("iterated");
    Solution solution = AtOwnNodes([&](const Stage& stage) {
      IteratedResult result = SmoothIterated(
          forward.start().layout, forward.start().prior, *stage.states,
          stage.timeline, *stage.decisions, iteration);
      Solution one = FromSmoothed(std::move(result.trajectory.states),
                                  std::move(result.trajectory.P), stage);
      one.iterations = result.iterations;
      one.converged = result.converged;
      JudgeHeading(one, stage);
      return one;
    });
    return Finish(std::move(solution), Method::kIterated,
                  ProcessorSeconds() - t0);
  }

  BatchOptions MakeBatchOptions() const {
    BatchOptions batch;
    batch.max_iterations = forward.options().max_iterations;
    batch.callback = [this](double fraction) {
      if (forward.options().stop != nullptr && *forward.options().stop)
        throw Interrupted();
      if (forward.options().progress) {
        forward.options().progress("batch", fraction);
      }
    };
    return batch;
  }

  Solution RunBatch() {
    const double t0 = ProcessorSeconds();
    Solution solution = AtOwnNodes([&](const Stage& stage) {
      BatchResult result = SolveBatch(
          forward.start().layout, forward.start().prior, *stage.states,
          stage.timeline, *stage.decisions, MakeBatchOptions());
      Solution one =
          FromSmoothed(std::move(result.states), std::move(result.P), stage);
      one.iterations = result.iterations;
      one.converged = result.converged;
      JudgeHeading(one, stage);
      return one;
    });
    return Finish(std::move(solution), Method::kBatch, ProcessorSeconds() - t0);
  }

  Solution RunGatedEkf() {
    constexpr double kGate = 0.999;
    const double t0 = ProcessorSeconds();
    Timeline gated = forward.timeline();
    for (std::size_t i = 0; i < gated.sensors().size(); ++i) {
      Sensor sensor = gated.sensors()[i];
      if (!sensor.gate_probability) sensor.gate_probability = kGate;
      gated.SetSensor(i, sensor);
    }
    Solution solution = FilterSolution(RunForwardFilter(
        {forward.options().error, {}}, forward.start().layout,
        forward.start().prior, &gated, {}, forward.Progress("gated_ekf")));
    return Finish(std::move(solution), Method::kGatedEkf,
                  ProcessorSeconds() - t0);
  }

  /// Questions every position sensor.
  SensorImm MakeImm(const Timeline& timeline) const {
    const Start& start = forward.start();
    return MakeSensorImm(WithoutTrustIn(start.position_sensor, start),
                         timeline);
  }

  Solution RunImmMethod(Method method) {
    const double t0 = ProcessorSeconds();
    const EpochCallback progress = forward.Progress("imm");
    Solution solution = AtOwnNodes([&](const Stage& stage) {
      SensorImm imm = MakeImm(*stage.timeline);
      return method == Method::kImm
                 ? ImmFilterSolution(imm, RunImm(imm.models, imm.options,
                                                 &imm.timeline, progress))
                 : ImmSmootherSolution(imm, SmoothSensorImm(&imm, progress));
    });
    return Finish(std::move(solution), method, ProcessorSeconds() - t0);
  }

  Solution RunRobustBatch() {
    const double t0 = ProcessorSeconds();
    int receiver = -1;
    for (std::size_t i = forward.timeline().sensors().size(); i-- > 0;) {
      if (forward.timeline().sensors()[i].type == SensorType::kPosition) {
        receiver = static_cast<int>(i);
      }
    }
    if (receiver < 0) {
      throw EstimationError("robust_batch needs a position sensor");
    }
    constexpr int kOwnStates = 6;
    if (forward.start().layout.parameter_count() + kOwnStates >
        kMaxParameters) {
      throw EstimationError(
          "robust_batch adds 6 values to those estimated: expected at most " +
          std::to_string(kMaxParameters - kOwnStates) + " of them");
    }
    return Finish(AtOwnNodes([&](const Stage& stage) {
                    return SolveRobustly(receiver, stage);
                  }),
                  Method::kRobustBatch, ProcessorSeconds() - t0);
  }

  Solution SolveRobustly(int receiver, const Stage& stage) const {
    GateDecisions used = *stage.decisions;
    for (std::size_t i = 0; i < used.size(); ++i) {
      const Measurement& z = stage.timeline->all_measurements()[i];
      if (z.sensor == receiver) used[i] = static_cast<char>(!z.withheld);
    }
    // The EKF's trajectory may be so far off after an outlier that a
    // linearisation about it is of no use.
    SensorImm imm = MakeImm(*stage.timeline);
    const ImmSmoothed rough =
        SmoothSensorImm(&imm, forward.Progress("robust_batch")).smoothed;
    const Start start = WithoutTrustIn(receiver, forward.start());
    RobustBatchResult result =
        SolveRobustBatch(start.layout, start.prior, rough.trajectory.states,
                         receiver, *stage.timeline, used, MakeBatchOptions(),
                         forward.Progress("robust_batch"));
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
    solution.mode_names = {"good", "biased", "drifting", "slight"};
    solution.notes = std::move(result.notes);
    const ScoredHistory& likeliest = result.regimes.histories.front();
    solution.bounded =
        BoundedParameters(likeliest.history, likeliest.parameters);
    return solution;
  }

  ClockChoice clocks;
  ForwardStage& forward;
  std::vector<Evidence> recording;  ///< what it shows by itself
  OptimumComparison optima;
  /// Sensor whose time offset a method's own nodes did not settle; empty: none.
  std::string own_unsettled;
  /// CreditHeading of a method's own result, which may lie elsewhere than
  /// the forward stage's.
  HeadingCredit own_credit;
};

Reconstruction::Reconstruction(const Dataset& dataset,
                               ReconstructionOptions options)
    : impl_(std::make_unique<Impl>(dataset, options)) {}

Reconstruction::~Reconstruction() = default;

Solution Reconstruction::Run(Method method) {
  impl_->forward.Run();
  switch (method) {
    case Method::kEkf:
      return impl_->RunEkf();
    case Method::kTwoFilter:
    case Method::kTwoFilterConventional:
    case Method::kTwoFilterEuler:
      return impl_->RunTwoFilter(method);
    case Method::kHInfinity:
      return impl_->RunObserver(method, impl_->forward.options().h_infinity);
    case Method::kModifiedHInfinity:
      return impl_->RunObserver(method,
                                impl_->forward.options().modified_h_infinity);
    case Method::kRts:
      return impl_->Finish(impl_->FromSmoothed(impl_->forward.smoothed().states,
                                               impl_->forward.smoothed().P),
                           method, impl_->forward.smoothing_seconds());
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
  impl_->forward.Run();
  return impl_->forward.unobserved();
}

const StartReport& Reconstruction::start() const {
  return impl_->forward.start().report;
}

Solution Reconstruction::Sample(const Solution& solution,
                                const std::vector<double>& times) const {
  const ReconstructionOptions& options = impl_->forward.options();
  const Method method = MethodFromName(solution.method);
  return SampleSolution(solution, impl_->forward.dataset().imu, times,
                        method == Method::kHInfinity ? options.h_infinity
                        : method == Method::kModifiedHInfinity
                            ? options.modified_h_infinity
                            : CovarianceOptions());
}

Solution Solve(const Dataset& dataset, const ReconstructionOptions& options) {
  Reconstruction reconstruction(dataset, options);
  return reconstruction.Run(options.method);
}

}  // namespace hindsight
