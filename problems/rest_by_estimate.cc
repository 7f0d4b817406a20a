#include "problems/rest_by_estimate.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "alignment/start.h"
#include "base/error.h"
#include "base/units.h"
#include "dataset/timeline_builder.h"
#include "filters/forward_filter.h"
#include "filters/rts.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

// A prediction of zero velocity with this sigma is sixty times as likely if the
// vehicle stands as if it moves with any horizontal speed up to 3 m/s [m/s].
constexpr double kKnownTo = 0.3;
constexpr double kGate = 0.999;
constexpr double kKnownHeading = 20.0 * kDegree;
constexpr int kMostRounds = 3;

enum class Standing { kOpen, kAtRest, kMoving };

/// A window of an undecided span.
struct Candidate {
  double middle() const { return 0.5 * (window.begin + window.end); }

  TimeInterval window;
  Standing standing = Standing::kOpen;
};

void SortByTime(std::vector<TimeInterval>* spans) {
  std::sort(spans->begin(), spans->end(),
            [](const TimeInterval& a, const TimeInterval& b) {
              return a.begin < b.begin;
            });
}

class EstimatedRest {
 public:
  EstimatedRest(Dataset* dataset, double from, double to)
      : dataset_(*dataset), from_(from), to_(to), rest_(FindRest(*dataset)) {
    for (const TimeInterval& span : rest_.undecided) {
      for (const TimeInterval& window : WindowsOf(span, dataset_.stationary)) {
        candidates_.push_back({window});
      }
    }
    zero_.gate_probability = kGate;
    zero_.kind = &ZeroVelocityKind();
  }

  Rest Decide() {
    try {
      for (int i = 0; i < kMostRounds && HasOpen(); ++i) {
        if (!DecideMore()) break;
      }
    } catch (const EstimationError&) {
      // What is open stays open.
    }
    dataset_.streams.resize(streams_);
    Rest rest = Conclude();
    LeaveOutContradicted(dataset_, &rest);
    return rest;
  }

 private:
  bool HasOpen() const {
    return std::any_of(
        candidates_.begin(), candidates_.end(),
        [](const Candidate& c) { return c.standing == Standing::kOpen; });
  }

  /// One forward pass and one back; returns whether a window was newly found to
  /// be at rest.
  bool DecideMore() {
    dataset_.streams.resize(streams_);
    AddRestStreams(Conclude(), &dataset_);
    const Start start = FindStart(dataset_, from_, to_);
    if (start.report.attitude_sigma.z() > kKnownHeading) return false;
    AddHypotheses();
    TimelineOptions options;
    options.t_begin = start.report.t;
    options.t_end = std::min(to_, dataset_.imu.t_end());
    options.with_scale_jacobians = start.layout.Has(BlockKind::kGyroScale) ||
                                   start.layout.Has(BlockKind::kAccelScale);
    Problem problem = {start.layout, start.prior,
                       BuildTimeline(dataset_, options)};
    problem.prior.x.t = problem.timeline.node(0).t;
    supposition_ = {static_cast<int>(dataset_.streams.size()) - 1, kKnownTo};
    LinearTape tape = RunForwardFilter({.error = ErrorDefinition::kNavigation,
                                        .covariance = {},
                                        .supposition = supposition_},
                                       &problem);
    bool found = JudgePredictions(problem.timeline, tape);
    if (HasOpen()) {
      found |= JudgeSmoothed(problem, SmoothRts(std::move(tape)));
    }
    return found;
  }

  /// A zero velocity in every window that is open, as the last stream.
  void AddHypotheses() {
    AidingStream& stream = dataset_.streams.emplace_back();
    stream.sensor = zero_;
    const int index = static_cast<int>(dataset_.streams.size()) - 1;
    for (const Candidate& candidate : candidates_) {
      if (candidate.standing != Standing::kOpen) continue;
      stream.measurements.push_back(
          {candidate.middle(), index, false,
           ZeroVelocity{dataset_.stationary.velocity_sigma}});
    }
  }

  Candidate* CandidateOf(const Measurement& z) {
    return &*std::lower_bound(candidates_.begin(), candidates_.end(), z.t,
                              [](const Candidate& candidate, double t) {
                                return candidate.middle() < t;
                              });
  }

  /// Judges a window by the innovation of its zero velocity, whose covariance
  /// is S; returns whether it is at rest.
  template <typename Matrix>
  bool Judge(const Matrix& S, double nis, const Measurement& z) {
    if (!supposition_.IsDecisive(S)) return false;
    const bool at_rest = nis <= GateLimit(zero_, Rows(z));
    CandidateOf(z)->standing = at_rest ? Standing::kAtRest : Standing::kMoving;
    return at_rest;
  }

  bool JudgePredictions(const Timeline& timeline, const LinearTape& tape) {
    bool found = false;
    for (std::size_t k = 0; k < tape.size(); ++k) {
      for (const TapeMeasurement& m : tape.measurements(k)) {
        if (m.sensor != supposition_.sensor) continue;
        found |=
            Judge(m.S, m.nis,
                  timeline.measurements(k)[static_cast<std::size_t>(m.index)]);
      }
    }
    return found;
  }

  bool JudgeSmoothed(const Problem& problem,
                     const SmoothedTrajectory& smoothed) {
    const ErrorLayout& layout = problem.layout;
    const Timeline& timeline = problem.timeline;
    bool found = false;
    LinearizedMeasurement linearized;
    const ErrorVector none = ErrorVector::Zero(layout.dim());
    for (std::size_t k = 0; k < timeline.size(); ++k) {
      for (const Measurement& z : timeline.measurements(k)) {
        if (z.sensor != supposition_.sensor ||
            CandidateOf(z)->standing != Standing::kOpen) {
          continue;
        }
        Evaluate(z, timeline.Context(k, z, layout, smoothed.states[k]),
                 &linearized);
        const Innovation innovation =
            Innovate(linearized, none, smoothed.P.Get(k));
        found |= Judge(innovation.S, innovation.nis, z);
      }
    }
    return found;
  }

  std::vector<TimeInterval>* ListOf(Standing standing, Rest* rest) const {
    switch (standing) {
      case Standing::kAtRest:
        return &rest->at_rest;
      case Standing::kMoving:
        return &rest->moving;
      default:
        return &rest->undecided;
    }
  }

  /// What is decided so far, neighbouring windows with the same decision
  /// joined.
  Rest Conclude() const {
    Rest rest = rest_;
    rest.undecided.clear();
    auto candidate = candidates_.begin();
    for (const TimeInterval& span : rest_.undecided) {
      TimeInterval part = {span.begin, span.begin};
      Standing standing = Standing::kOpen;
      const auto close = [&] {
        if (part.end > part.begin) ListOf(standing, &rest)->push_back(part);
      };
      for (;
           candidate != candidates_.end() && candidate->window.begin < span.end;
           ++candidate) {
        if (candidate->standing != standing) {
          close();
          part.begin = candidate->window.begin;
          standing = candidate->standing;
        }
        part.end = candidate->window.end;
      }
      if (standing != Standing::kOpen) {
        close();
        part.begin = part.end;
        standing = Standing::kOpen;
      }
      part.end = span.end;
      close();
    }
    SortByTime(&rest.at_rest);
    SortByTime(&rest.moving);
    SortByTime(&rest.undecided);
    return rest;
  }

  Dataset& dataset_;
  double from_;
  double to_;
  std::size_t streams_ = dataset_.streams.size();
  Sensor zero_;
  Supposition supposition_;
  Rest rest_;
  std::vector<Candidate> candidates_;
};

}  // namespace

Rest DecideRest(Dataset* dataset, double from, double to) {
  return EstimatedRest(dataset, from, to).Decide();
}

void AddDecidedRest(double from, double to, Dataset* dataset) {
  if (!dataset->stationary.enabled) return;
  AddRestStreams(DecideRest(dataset, from, to), dataset);
}

}  // namespace hindsight
