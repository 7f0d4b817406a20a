#include "problems/forward_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/processor_time.h"
#include "base/units.h"
#include "evaluation/observability.h"
#include "problems/solution_builder.h"

namespace hindsight {

ForwardStage::ForwardStage(const Dataset& dataset,
                           const ReconstructionOptions& options)
    : ForwardStage(
          dataset, options,
          options.rests
              ? FindStart(dataset, options.from, options.to, *options.rests)
              : FindStart(dataset, options.from, options.to)) {}

namespace {

std::vector<double> GivenOffsets(const Dataset& dataset) {
  std::vector<double> offsets;
  for (const AidingStream& stream : dataset.streams) {
    offsets.push_back(stream.sensor.time_offset);
  }
  return offsets;
}

}  // namespace

ForwardStage::ForwardStage(const Dataset& dataset,
                           ReconstructionOptions options, Start start)
    : dataset_(dataset),
      options_(std::move(options)),
      offsets_(GivenOffsets(dataset)),
      start_(std::move(start)),
      problem_{start_.layout, start_.prior,
               BuildTimeline(dataset_, MakeTimelineOptions())} {
  start_.prior.x.t = problem_.prior.x.t = timeline().node(0).t;
}

TimelineOptions ForwardStage::MakeTimelineOptions() const {
  TimelineOptions timeline_options;
  timeline_options.t_begin = start_.report.t;
  timeline_options.t_end = std::min(options_.to, dataset_.imu.t_end());
  timeline_options.extra_times = options_.node_times;
  timeline_options.time_offsets = offsets_;
  timeline_options.with_scale_jacobians =
      start_.layout.Has(BlockKind::kGyroScale) ||
      start_.layout.Has(BlockKind::kAccelScale);
  if (timeline_options.t_end <= timeline_options.t_begin) {
    throw EstimationError("the start at " + std::to_string(start_.report.t) +
                          " s leaves no interval to reconstruct");
  }
  return timeline_options;
}

EpochCallback ForwardStage::Progress(const std::string& stage) const {
  return [this, stage](std::size_t done) {
    if (options_.stop != nullptr && *options_.stop) throw Interrupted();
    if (options_.progress && (done % 64 == 0 || done == timeline().size())) {
      options_.progress(stage, static_cast<double>(done) /
                                   static_cast<double>(timeline().size()));
    }
  };
}

void ForwardStage::Run() {
  if (!smoothed_) Settle(GivenOffsets(dataset_));
}

void ForwardStage::Settle(std::vector<double> offsets) {
  if (smoothed_ || offsets != offsets_) {
    offsets_ = std::move(offsets);
    problem_.timeline = BuildTimeline(dataset_, MakeTimelineOptions());
  }
  unsettled_.clear();
  relinearised_.reset();
  settled_tape_.reset();
  realigned_.reset();
  fit_.reset();
  heading_credit_ = {};
  turned_round_.reset();
  unobserved_.reset();
  RunOnce();
  if (!EstimatesTimeOffsets(start_.layout)) return;
  problem_.timeline.LinearizeTimeOffsets(start_.layout, smoothed_->states);
  OffsetSearch search;
  bool near = false;
  for (int i = 1;; ++i) {
    RunOnce();
    const int sensor =
        FarthestFromNodes(start_.layout, offsets_, smoothed_->states.back(),
                          smoothed_->P.Get(smoothed_->P.size() - 1));
    // The offsets were linearised along a trajectory from other nodes, so that
    // they may be near by chance: they count as settled once they are near
    // again when linearised along the trajectory of these nodes.
    if (sensor < 0 && near) return;
    near = sensor < 0;
    if (near) {
      problem_.timeline.LinearizeTimeOffsets(start_.layout, smoothed_->states);
      continue;
    }
    if (i >= kMaxPlacements) {
      unsettled_ = timeline().sensors()[static_cast<std::size_t>(sensor)].name;
      return;
    }
    PlacedNodes nodes =
        PlaceAnew(search.Next(start_.layout, timeline().sensors(),
                              smoothed_->states.back(), offsets_),
                  problem_, start_.layout, smoothed_->states);
    offsets_ = std::move(nodes.offsets);
    problem_ = std::move(nodes.problem);
  }
}

PlacedNodes ForwardStage::PlaceAnew(std::vector<double> offsets,
                                    const Problem& problem,
                                    const ErrorLayout& layout,
                                    const std::vector<State>& states) const {
  TimelineOptions options = MakeTimelineOptions();
  options.time_offsets = std::move(offsets);
  return PlaceNodesAnew(dataset_, options, problem, layout, states);
}

/// While the heading is unknown, a filter that resets its nominal linearises
/// its measurements about headings far apart, and its covariances show
/// information that is not in the data. What is not observed is then taken from
/// the covariances about one smoothed trajectory (Relinearise).
void ForwardStage::JudgeObservability() {
  constexpr double kKnownHeading = 20.0 * kDegree;
  Solution solution;
  solution.layout = start_.layout;
  solution.states = smoothed_->states;
  if (start_.report.attitude_sigma.z() > kKnownHeading) {
    solution.covariances = Relinearise();
  }
  if (solution.covariances.empty()) {
    solution.covariances = smoothed_->P;
    WidenHeading(start_.layout, heading_credit(), &solution.covariances);
  }
  unobserved_ = FindUnobserved(solution);
}

const std::vector<UnobservedSpan>& ForwardStage::unobserved() {
  if (!unobserved_) JudgeObservability();
  return *unobserved_;
}

const Relinearised& ForwardStage::relinearised() {
  if (!unobserved_) JudgeObservability();  // may fill relinearised_
  if (!relinearised_) Relinearise();
  return *relinearised_;
}

const std::vector<State>& ForwardStage::batch_start() {
  return relinearised().contracted && !has_losses() ? relinearised().states
                                                    : smoothed_->states;
}

const Fit& ForwardStage::fit() {
  if (fit_) return *fit_;
  const Relinearised& anew = relinearised();
  fit_ = settled_tape_
             ? JudgeFit(dataset_, anew, smoothed_->states, *settled_tape_,
                        &problem_, Progress("grading"))
             : JudgeFit(dataset_, anew, &problem_, Progress("grading"));
  settled_tape_.reset();
  return *fit_;
}

void ForwardStage::JudgeHeading(const SmoothedTrajectory& last) {
  heading_credit_ = CreditHeading(problem_, last.states, last.P);
  const std::string& alignment = start_.report.alignment;
  if (alignment != "velocity" && alignment != "static") return;
  const double log_odds = LogOddsOfTurnedRound(problem_, last.states, last.P);
  constexpr double kImpossible = 1e-6;  // odds
  if (std::exp(log_odds) < kImpossible) return;
  turned_round_ = RivalSolution{.description = "heading turned by 180 deg",
                                .differences = {{"heading", kPi, "rad"}},
                                .log_evidence = log_odds,
                                .final_state = std::nullopt};
}

const std::optional<RivalSolution>& ForwardStage::turned_round() {
  if (!relinearised_ && MayBeTurnedRound(problem_, smoothed_->states)) {
    Relinearise();
  }
  return turned_round_;
}

const HeadingCredit& ForwardStage::heading_credit() {
  if (!relinearised_ &&
      HeadingMayBeNoise(problem_, smoothed_->states, smoothed_->P)) {
    Relinearise();
  }
  return heading_credit_;
}

/// How far the smoothed trajectory goes until it rests is its linearisation
/// error. Returns the covariances, none if that fails.
CovarianceSeries ForwardStage::Relinearise() {
  relinearised_.emplace();
  heading_credit_ = {};
  turned_round_.reset();
  Relinearised& anew = *relinearised_;
  anew.smoother.largest = anew.smoother.rms =
      std::numeric_limits<double>::infinity();
  try {
    Rested rested = SmoothUntilItRests(smoothed_->states, &problem_,
                                       Progress("linearisation"));
    SmoothedTrajectory& last = rested.trajectory;
    JudgeHeading(last);
    WidenHeading(start_.layout, heading_credit_, &last.P);
    anew.variances = VariancesOf(start_.layout, last.P);
    anew.states = std::move(last.states);
    anew.smoother =
        Compare(start_.layout, smoothed_->states, smoothed_->P, anew);
    anew.smoother.settled = rested.step < 1.0;
    anew.is_near = rested.passes == 1 && rested.is_settled();
    anew.contracted = anew.is_near || rested.step < rested.first;
    if (anew.is_near) settled_tape_ = std::move(rested.tape);
    return std::move(last.P);
  } catch (const EstimationError&) {
    return {};
  }
}

std::vector<State> ForwardStage::SmoothedStates() {
  if (timeline().HasGates() || EstimatesTimeOffsets(start_.layout)) {
    Run();
    return smoothed_->states;
  }
  const LinearTape tape = Filter("ekf", &problem_);
  problem_.decisions = DecisionsOnTape(tape);
  return SmoothMeans(tape).states;
}

std::vector<State> ForwardStage::RestedStates(
    const std::vector<State>& smoothed) {
  try {
    return SmoothUntilItRests(smoothed, &problem_, Progress("linearisation"))
        .trajectory.states;
  } catch (const EstimationError&) {
    return {};
  }
}

Problem ForwardStage::CausalProblem() const {
  return {problem_.layout, problem_.prior, problem_.timeline};
}

LinearTape ForwardStage::Filter(const std::string& stage, Problem* problem,
                                std::span<const State> start) const {
  return RunForwardFilter({.error = options_.error,
                           .covariance = {},
                           .supposition = {},
                           .start = start},
                          problem, Progress(stage));
}

const Realigned& ForwardStage::realigned() {
  if (!realigned_) {
    realigned_ = Realign(start_.layout, relinearised(),
                         [this](std::span<const State> start) {
                           return Filter("rts", &problem_, start);
                         });
  }
  return *realigned_;
}

const SmoothedTrajectory& ForwardStage::smoothed_once() {
  return realigned().start.empty() ? *smoothed_ : realigned().trajectory;
}

LinearTape ForwardStage::FilterOnce(const std::string& stage) {
  return Filter(stage, &problem_, realigned().start);
}

Solution ForwardStage::TakeFiltered() {
  if (!filtered_) {
    const double t0 = ProcessorSeconds();
    Problem causal = CausalProblem();
    filtered_ = FilterSolution(Filter("ekf", &causal));
    filtered_->seconds = ProcessorSeconds() - t0;
  }
  Solution solution = std::move(*filtered_);
  filtered_.reset();
  return solution;
}

void ForwardStage::RunOnce() {
  const double t0 = ProcessorSeconds();
  // What an earlier one found is not of what this one fails at.
  smoothed_.reset();
  filtered_.reset();
  problem_.decisions.clear();
  LinearTape tape = Filter("ekf", &problem_);
  filtered_ = FilterSolution(tape);
  filtered_->seconds = ProcessorSeconds() - t0;
  problem_.decisions = DecisionsOnTape(tape);
  smoothed_ = SmoothOnce(std::move(tape));
  if (timeline().HasGates()) RepeatWithSmoothedGates();
  smoothing_seconds_ = ProcessorSeconds() - t0 - filtered_->seconds;
}

/// The innovation gate has judged each measurement by what came before it
/// alone. For the whole-interval methods all gates are decided again by the
/// smoothed trajectory, and the interval is smoothed with these decisions.
void ForwardStage::RepeatWithSmoothedGates() {
  GateDecisions again = DecideGates(problem_, *smoothed_);
  if (again == problem_.decisions) return;
  problem_.decisions = std::move(again);
  smoothed_ = SmoothOnce(Filter("rts", &problem_));
}

}  // namespace hindsight
