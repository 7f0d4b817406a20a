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

std::vector<NormalisedInnovation> InnovationsOf(const LinearTape& tape,
                                                const Timeline& timeline,
                                                const Dataset& dataset) {
  std::vector<NormalisedInnovation> all;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      if (!z.accepted || z.withheld) continue;
      // Whose errors have a robust loss are not said to be normal.
      if (timeline.sensors()[static_cast<std::size_t>(z.sensor)].loss.kind !=
          RobustLoss::Kind::kNone) {
        continue;
      }
      const auto sensor = static_cast<std::size_t>(z.sensor);
      const double stamp =
          timeline.measurements(k)[static_cast<std::size_t>(z.index)].t;
      const std::size_t index =
          sensor < dataset.streams.size()
              ? IndexOf(dataset.streams[sensor].measurements, stamp)
              : NormalisedInnovation::kOwn;
      all.push_back(
          {tape.epoch(k).t, z.sensor, index,
           z.innovation.cwiseQuotient(z.S.diagonal().cwiseSqrt()),
           Eigen::LLT<Eigen::MatrixXd>(z.S).matrixL().solve(z.innovation)});
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

std::vector<ConstantExcess> ConstantsOf(const LinearTape& tape) {
  const ErrorLayout& layout = tape.layout();
  std::vector<int> components;
  for (const Block& block : layout.blocks()) {
    if (block.evolution.kind != Evolution::Kind::kConstant) continue;
    for (int i = 0; i < block.dim; ++i) components.push_back(block.offset + i);
  }
  const std::vector<double> factors =
      ExcessOfConstants(tape, components, kFalseAlarms);
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
              const LinearTape& all, Problem* problem)
      : dataset_(dataset), solution_(solution), all_(all), problem_(problem) {}

  /// Fills the sensors, and the effect.
  void Find(const std::vector<InnovationFigure>& figures, LeftOutSensor* out) {
    std::set<int> judged;
    for (const InnovationFigure& one : figures) judged.insert(one.sensor);
    // Without the only sensor there is nothing that could not fit.
    if (judged.size() < 2) return;
    for (const int sensor : judged) {
      const std::optional<double> effect = EffectIfFits(sensor);
      if (!effect) continue;
      out->sensors.push_back(
          problem_->timeline.sensors()[static_cast<std::size_t>(sensor)].name);
      out->effect = *effect;
    }
  }

 private:
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
      const LinearTape tape = RunLinearizedFilter(solution_.states, problem_);
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
           !ExplanationSearch(*problem_, solution_.states, tape, kFalseAlarms)
                .found_any();
  }

  double Distance(const LinearTape& tape) const {
    const SmoothedTrajectory with = SmoothMeans(all_);
    const SmoothedTrajectory without = SmoothMeans(tape);
    NavigationVariances squares = NavigationVariances::Zero();
    if (!tape.layout().has_canonical_head()) {
      return std::numeric_limits<double>::infinity();
    }
    for (std::size_t k = 0; k < tape.size(); ++k) {
      const NavigationVariances apart =
          without.d[k].head<9>() - with.d[k].head<9>();
      squares +=
          apart.cwiseProduct(apart).cwiseQuotient(solution_.variances[k]);
    }
    return std::sqrt(squares.maxCoeff() / static_cast<double>(tape.size()));
  }

  const Dataset& dataset_;
  const Relinearised& solution_;
  const LinearTape& all_;
  Problem* problem_;
};

/// What does not fit most, over its limit; less than one if all fits.
LeftOutSensor Misfit(const Fit& fit) {
  LeftOutSensor worst{.sensors = {},
                      .misfit = LargestExcess(fit.figures) / kDoubtfulError,
                      .onset = std::nullopt};
  for (const Explanation& one : fit.explanations) {
    if (one.effect < kDoubtfulShift || one.z / one.limit < worst.misfit) {
      continue;
    }
    worst.misfit = one.z / one.limit;
    worst.onset = one.onset;
  }
  return worst;
}

}  // namespace

Fit JudgeFit(const Dataset& dataset, const Relinearised& solution,
             Problem* problem) {
  Fit fit;
  if (solution.states.empty()) return fit;
  try {
    const LinearTape tape = RunLinearizedFilter(solution.states, problem);
    fit.innovations = InnovationsOf(tape, problem->timeline, dataset);
    fit.figures = TestInnovations(fit.innovations, kFalseAlarms);
    const ExplanationSearch search(*problem, solution.states, tape,
                                   kFalseAlarms);
    fit.explanations = search.Tell(solution);
    fit.agreement =
        FiguresOf(AgreementOfSides(tape, search.state_scores()), tape);
    fit.constants = ConstantsOf(tape);
    LeftOutSensor misfit = Misfit(fit);
    if (misfit.misfit >= 1.0) {
      LeaveOneOut(dataset, solution, tape, problem).Find(fit.figures, &misfit);
      fit.contradiction = std::move(misfit);
    }
  } catch (const EstimationError&) {
    // What a smoother could not hold is told by evidence of its own.
  }
  return fit;
}

}  // namespace hindsight
