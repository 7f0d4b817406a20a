#include "problems/fit.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "base/chi_square.h"
#include "base/error.h"
#include "filters/constant_scores.h"
#include "filters/forward_filter.h"
#include "filters/mixture_innovations.h"
#include "filters/rts.h"
#include "filters/side_agreement.h"
#include "problems/explanations.h"

namespace hindsight {
namespace {

/// Number of the measurement of a stamp in its stream.
std::size_t IndexOf(const MeasurementSeries& series, double t) {
  const auto found = std::lower_bound(
      series.begin(), series.end(), t,
      [](const Measurement& z, double stamp) { return z.t < stamp; });
  return static_cast<std::size_t>(found - series.begin());
}

/// What names the measurements on a tape, and which of them are judged.
class Judgeable {
 public:
  Judgeable(const Timeline& timeline, const Dataset& dataset)
      : timeline_(timeline), dataset_(dataset) {}

  bool Judges(const TapeMeasurement& z) const {
    return z.accepted && !z.withheld &&
           timeline_.sensors()[static_cast<std::size_t>(z.sensor)].loss.kind ==
               RobustLoss::Kind::kNone;
  }

  NormalisedInnovation Of(std::size_t k, const TapeMeasurement& z,
                          RowVector rows, RowVector white) const {
    const auto sensor = static_cast<std::size_t>(z.sensor);
    const Measurement& measured =
        timeline_.measurements(k)[static_cast<std::size_t>(z.index)];
    std::vector<int> components;
    for (int row = 0; row < rows.size(); ++row) {
      components.push_back(ComponentOf(measured, row));
    }
    return {.t = timeline_.node(k).t,
            .sensor = z.sensor,
            .index =
                sensor < dataset_.streams.size()
                    ? IndexOf(dataset_.streams[sensor].measurements, measured.t)
                    : NormalisedInnovation::kOwn,
            .rows = std::move(rows),
            .white = std::move(white),
            .components = std::move(components)};
  }

 private:
  const Timeline& timeline_;
  const Dataset& dataset_;
};

std::vector<NormalisedInnovation> InnovationsOf(const LinearTape& tape,
                                                const Timeline& timeline,
                                                const Dataset& dataset) {
  const Judgeable judgeable(timeline, dataset);
  std::vector<NormalisedInnovation> all;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      if (!judgeable.Judges(z)) continue;
      all.push_back(judgeable.Of(
          k, z, z.innovation.cwiseQuotient(z.S.diagonal().cwiseSqrt()),
          Eigen::LLT<Eigen::MatrixXd>(z.S).matrixL().solve(z.innovation)));
    }
  }
  return all;
}

/// Of what `all` can tell, with the limit that any of them reaches by chance.
std::vector<AgreementFigure> FiguresOf(const std::vector<SideAgreement>& all,
                                       const LinearTape& tape) {
  std::vector<AgreementFigure> figures;
  for (const SideAgreement& one : all) {
    const char* block = one.block == BlockKind::kPosition   ? "position"
                        : one.block == BlockKind::kVelocity ? "velocity"
                                                            : "attitude";
    const char* words =
        one.of == SideAgreement::Of::kForwardAndBackward
            ? "{} differs from what is measured before to what is after"
            : "{} of the filter differs from that of the smoother";
    figures.push_back(
        {.what = fmt::format(fmt::runtime(words), block),
         .t = tape.epoch(one.epoch).t,
         .distance = one.distance,
         .limit = std::sqrt(ChiSquareQuantile(
             1.0 - kFalseAlarms / static_cast<double>(all.size()), one.dof))});
  }
  return figures;
}

/// Widens a sigma of a right model in one recording of twenty: no grade hangs on
/// it, and one that is too small misleads more than one that is too large.
constexpr double kNeedlesslyWidened = 0.05;

std::vector<ConstantExcess> ConstantsOf(const LinearTape& tape) {
  const ErrorLayout& layout = tape.layout();
  std::vector<int> components;
  for (const Block& block : layout.blocks()) {
    if (block.evolution.kind != Evolution::Kind::kConstant) continue;
    for (int i = 0; i < block.dim; ++i) components.push_back(block.offset + i);
  }
  const std::vector<double> factors =
      ExcessOfConstants(tape, components, kNeedlesslyWidened);
  std::vector<ConstantExcess> constants;
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (factors[i] > 1.0) {
      constants.push_back({layout.ComponentName(components[i]), factors[i]});
    }
  }
  return constants;
}

/// The largest excess of the innovations over what chance explains.
double LargestExcess(const std::vector<InnovationFigure>& figures) {
  double largest = 0.0;
  for (const InnovationFigure& one : figures) {
    largest = std::max(largest, one.excess);
  }
  return largest;
}

/// Leaves out one sensor at a time, about the same states.
class LeaveOneOut {
 public:
  LeaveOneOut(const Dataset& dataset, const Relinearised& solution,
              const LinearTape& all, Problem* problem,
              const EpochCallback& callback)
      : dataset_(dataset),
        solution_(solution),
        with_(SmoothMeans(all)),
        problem_(problem),
        callback_(callback) {}

  LeftOutSensor Find(const Fit& fit, double misfit) {
    LeftOutSensor out;
    out.misfit = misfit;
    std::set<int> judged;
    for (const InnovationFigure& one : fit.figures) judged.insert(one.sensor);
    // Without the only sensor there is nothing that could not fit.
    if (judged.size() < 2) return out;
    for (const int sensor : judged) {
      const std::string& name =
          problem_->timeline.sensors()[static_cast<std::size_t>(sensor)].name;
      if (IsBetterExplainedByTheImu(name, fit.explanations)) continue;
      const std::optional<double> effect = EffectIfFits(sensor);
      if (!effect) continue;
      out.sensors.push_back(name);
      out.effect = *effect;
      out.onset = OnsetOf(name, fit.explanations);
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

  std::optional<double> EffectIfFits(int sensor) {
    const GateDecisions before = problem_->decisions;
    const std::vector<Measurement>& measurements =
        problem_->timeline.all_measurements();
    problem_->decisions.resize(measurements.size(), 1);
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      if (measurements[i].sensor == sensor) problem_->decisions[i] = 0;
    }
    std::optional<double> effect;
    try {
      const LinearTape tape =
          RunLinearizedFilter(solution_.states, problem_, callback_);
      if (Fits(tape)) effect = Distance(tape);
    } catch (const EstimationError&) {
      // The rest does not even make a filter.
    }
    problem_->decisions = before;
    return effect;
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

/// What does not fit most, over its limit; less than one if all fits.
double Misfit(const Fit& fit) {
  double worst = LargestExcess(fit.figures) / kDoubtfulError;
  for (const Explanation& one : fit.explanations) {
    if (one.effect >= kDoubtfulShift)
      worst = std::max(worst, one.z / one.limit);
  }
  return worst;
}

}  // namespace

Fit JudgeFit(const Dataset& dataset, const Relinearised& solution,
             Problem* problem, const EpochCallback& callback) {
  Fit fit;
  if (solution.states.empty()) return fit;
  try {
    const LinearTape tape =
        RunLinearizedFilter(solution.states, problem, callback);
    fit.innovations = InnovationsOf(tape, problem->timeline, dataset);
    fit.figures = TestInnovations(fit.innovations, kFalseAlarms);
    const ExplanationSearch search(*problem, solution.states, tape,
                                   kFalseAlarms, callback);
    fit.explanations = search.Tell(solution);
    fit.agreement =
        FiguresOf(AgreementOfSides(tape, search.state_scores()), tape);
    fit.constants = ConstantsOf(tape);
    const double misfit = Misfit(fit);
    if (misfit >= 1.0) {
      fit.contradiction =
          LeaveOneOut(dataset, solution, tape, problem, callback)
              .Find(fit, misfit);
    }
    fit.tested = true;
  } catch (const EstimationError&) {
    // What a smoother could not hold is told by evidence of its own.
  }
  return fit;
}

Fit JudgeFit(const Dataset& dataset, const Timeline& timeline,
             const ImmTape& tape) {
  const Judgeable judgeable(timeline, dataset);
  Fit fit;
  for (const MixtureInnovation& one : MixtureInnovations(tape)) {
    const TapeMeasurement& z =
        tape.tapes.front().measurements(one.epoch)[one.measurement];
    if (!judgeable.Judges(z)) continue;
    fit.innovations.push_back(
        judgeable.Of(one.epoch, z, one.scores, one.scores));
  }
  fit.figures = TestInnovations(fit.innovations, kFalseAlarms);
  fit.tested = true;
  return fit;
}

}  // namespace hindsight
