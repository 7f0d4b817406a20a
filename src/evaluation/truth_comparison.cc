#include "evaluation/truth_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "evaluation/interpolation.h"

namespace hindsight {
namespace {

constexpr double kLeastTruthSpacing = 0.1;  // [s]
constexpr std::size_t kMostTruthPoints = 50000;
/// Stamps of two files for one instant [s].
constexpr double kSameStamp = 1e-6;

/// Columns that every point has.
SolutionTable TableFromTruth(const TruthSeries& truth) {
  const auto all = [&truth](const auto& part) {
    return std::all_of(
        truth.begin(), truth.end(),
        [&part](const TruthPoint& point) { return (point.*part).has_value(); });
  };
  const bool position = all(&TruthPoint::p_e);
  const bool velocity = all(&TruthPoint::v_n);
  const bool attitude = all(&TruthPoint::q_nb);
  SolutionTable table;
  for (const TruthPoint& point : truth) {
    table.t.push_back(point.t);
    if (position) table.p_e.push_back(*point.p_e);
    const Eigen::Matrix3d C_en = table.C_en(table.size() - 1);
    if (velocity) table.v_e.emplace_back(C_en * *point.v_n);
    if (attitude) {
      table.q_eb.push_back(Eigen::Quaterniond(C_en) * *point.q_nb);
    }
  }
  return table;
}

/// The reference at given times, interpolated; those outside its span or in its
/// gaps are left out.
TruthSeries TruthAt(const TruthSeries& truth, const std::vector<double>& times,
                    double max_gap) {
  const SolutionTable table = TableFromTruth(truth);
  const TrajectoryInterpolator interpolator(table, max_gap);
  TruthSeries points;
  for (const double t : times) {
    const std::optional<InterpolatedState> x = interpolator.At(t);
    if (!x) continue;
    TruthPoint point;
    point.t = t;
    point.p_e = x->p_e;
    const Eigen::Matrix3d C_ne =
        x->p_e ? Eigen::Matrix3d(NedAxes(*x->p_e).transpose())
               : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    if (x->v_e) point.v_n = C_ne * *x->v_e;
    if (x->q_eb) point.q_nb = Eigen::Quaterniond(C_ne) * *x->q_eb;
    points.push_back(point);
  }
  return points;
}

bool IsSparser(const SolutionTable& solution, const TruthSeries& truth) {
  if (solution.size() < 2 || truth.size() < 2) return false;
  const double rows = (solution.t.back() - solution.t.front()) /
                      static_cast<double>(solution.size() - 1);
  const double points = (truth.back().t - truth.front().t) /
                        static_cast<double>(truth.size() - 1);
  return rows > 1.5 * points;
}

}  // namespace

SolutionTruth TruthOf(const Dataset& dataset, const Solution& solution) {
  SolutionTruth truth{.points = dataset.truth,
                      .lever_arm_b = dataset.truth_lever_arm_b};
  if (!dataset.truth_stream || solution.states.empty()) return truth;
  const auto stream = static_cast<int>(*dataset.truth_stream);
  const ErrorLayout& layout = solution.layout;
  const ParameterVector& values = solution.states.back().parameters;
  if (const Block* arm = layout.Find(BlockKind::kLeverArm, stream)) {
    truth.lever_arm_b = values.segment<3>(arm->parameter_offset);
  }
  if (const Block* clock = layout.Find(BlockKind::kTimeOffset, stream)) {
    const double configured =
        dataset.streams[*dataset.truth_stream].sensor.time_offset;
    const double correction = values(clock->parameter_offset) - configured;
    for (TruthPoint& point : truth.points.Edited()) point.t += correction;
  }
  return truth;
}

void ThinTruth(TruthSeries* truth) {
  double last = -std::numeric_limits<double>::infinity();
  truth->EraseIf([&last](const TruthPoint& point) {
    // A truth at 10 Hz is kept whole, whatever its stamps' rounding.
    if (point.t < last + 0.999 * kLeastTruthSpacing) return true;
    last = point.t;
    return false;
  });
  const std::size_t every =
      (truth->size() + kMostTruthPoints - 1) / kMostTruthPoints;
  if (every < 2) return;
  std::size_t k = 0;
  truth->EraseIf([&](const TruthPoint&) { return k++ % every != 0; });
}

bool HasRowsAtTruth(const SolutionTable& solution, const TruthSeries& truth) {
  if (solution.size() == 0) return false;
  const std::vector<double>& t = solution.t;
  return std::all_of(truth.begin(), truth.end(), [&t](const TruthPoint& point) {
    if (point.t < t.front() - kSameStamp || point.t > t.back() + kSameStamp)
      return true;
    const auto row = std::lower_bound(t.begin(), t.end(), point.t - kSameStamp);
    return row != t.end() && *row <= point.t + kSameStamp;
  });
}

ComparedTruth TruthToCompare(const SolutionTable& solution,
                             const TruthSeries& truth,
                             const TrajectoryErrorOptions& options) {
  ComparedTruth compared = {truth};
  ThinTruth(&compared.points);
  if (HasRowsAtTruth(solution, compared.points) ||
      !IsSparser(solution, truth)) {
    return compared;
  }
  return {TruthAt(truth, solution.t, options.max_gap), true};
}

TruthComparison CompareWithTruth(const SolutionTable& solution,
                                 const TruthSeries& truth,
                                 const TrajectoryErrorOptions& options) {
  TruthComparison out{.truth = TruthToCompare(solution, truth, options),
                      .errors = {},
                      .statistics = {}};
  out.errors = ComputeTrajectoryErrors(solution, out.truth.points, options);
  out.statistics = SummarizeErrors(out.errors, out.truth.points);
  if (out.truth.at_solution_rows) {
    out.statistics.at_solution_rows = true;
    out.statistics.truth_count = solution.size();
  }
  return out;
}

}  // namespace hindsight
