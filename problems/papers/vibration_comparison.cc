#include "problems/papers/vibration_comparison.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "evaluation/statistics.h"
#include "problems/free_rotation_trial.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

/// An accelerometer rule, or its smoother.
struct RuleRow {
  std::string name;
  std::string rule;
  double gate = 0.88;
  bool smoothed = false;
};

const std::vector<RuleRow>& Rules() {
  static const std::vector<RuleRow> rules = {
      {"fixed", "fixed"},
      {"gate 0.3", "gate", 0.3},
      {"gate 0.88", "gate"},
      {"gate 3", "gate", 3.0},
      {"held gate 0.88", "held_gate"},
      {"adaptive", "adaptive"},
      {"smnc", "smnc"},
      {"gate 0.88, smoothed", "gate", 0.88, true},
      {"smnc, smoothed", "smnc", 0.88, true}};
  return rules;
}

/// Where the disturbances begin and end [s]; stamps are multiples of 0.1 s but
/// for rounding.
constexpr std::array<std::pair<double, double>, 6> kIntervals = {
    {{0.0, 5.0},
     {5.0, 10.0},
     {10.0, 40.0},
     {40.0, 45.0},
     {45.0, 60.1},
     {10.0, 60.1}}};

void Judge(const Dataset& dataset, const Solution& solution,
           RunRecord* record) {
  constexpr double kWithin = 3.0;
  auto& series = record->series;
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    const State& x = solution.states[k];
    const Eigen::Vector3d psi = RotationError(dataset.truth[k], x);
    const Eigen::Vector3d bias = *dataset.truth[k].b_g - x.b_g;
    const ErrorMatrix P = solution.covariances.Get(k);
    const Eigen::Matrix<double, 6, 1> sigma = P.diagonal().cwiseSqrt();
    double inside = 0.0, bias_inside = 0.0;
    for (int i = 0; i < 3; ++i) {
      inside += std::abs(psi(i)) <= kWithin * sigma(i) ? 1.0 / 3.0 : 0.0;
      bias_inside +=
          std::abs(bias(i)) <= kWithin * sigma(3 + i) ? 1.0 / 3.0 : 0.0;
    }
    record->t.push_back(x.t);
    series["psi"].push_back(psi.norm());
    series["psi_any"].push_back(psi.cwiseAbs().maxCoeff());
    series["psi_n"].push_back(std::abs(psi.x()));
    series["psi_e"].push_back(std::abs(psi.y()));
    series["psi_d"].push_back(std::abs(psi.z()));
    series["bias"].push_back(bias.norm() / std::sqrt(3.0));
    series["inside"].push_back(inside);
    series["bias_inside"].push_back(bias_inside);
  }
}

std::vector<Figure> IntervalFigures(std::pair<double, double> interval) {
  const auto span = [&](const char* format) {
    return fmt::format(fmt::runtime(format), interval.first,
                       std::floor(interval.second));
  };
  const std::string suffix = span("_{:g}_{:g}s");
  const bool is_last = interval == kIntervals[4];
  const auto axes = [](Reduce reduce) {
    return Terms{
        {"n", "psi_n", reduce}, {"e", "psi_e", reduce}, {"d", "psi_d", reduce}};
  };
  std::vector<Figure> figures = {
      Single("rms_total" + suffix, kDegrees, span("{:g}-{:g} s\n3-D rms [deg]"),
             "{:.3f}", "psi", OfAll<Rms>),
      Single("max_any" + suffix, kDegrees, "max\n[deg]", "{:.2f}", "psi_any",
             OfAll<Largest>),
      Share("inside" + suffix, "inside\n[%]", "inside", OfAll<Mean>),
      Several("rms" + suffix, kDegrees, "", "", axes(OfAll<Rms>)),
      Several("max" + suffix, kDegrees, "", "", axes(OfAll<Largest>)),
      Single("bias_rms" + suffix, {"deg/h", kDegree / kHour},
             is_last ? "gyro bias\nrms [deg/h]" : "", "{:.2f}", "bias",
             OfAll<Rms>),
      Share("bias_inside" + suffix, is_last ? "inside\n[%]" : "", "bias_inside",
            OfAll<Mean>)};
  // A stamp belongs to the interval that begins there.
  for (Figure& figure : figures) {
    figure.range = {interval.first - 1e-9, interval.second - 2e-9};
  }
  return figures;
}

}  // namespace

StudyTable VibrationTable() {
  StudyTable table = {"cells", {"disturbance", "rule"}, {}, {}};
  for (const auto& interval : kIntervals) {
    for (Figure& figure : IntervalFigures(interval)) {
      table.figures.push_back(std::move(figure));
    }
  }
  return table;
}

Trial VibrationTrial() {
  return [](const Dataset& recording, CaseRun* run) {
    Dataset dataset = recording;
    for (const RuleRow& row : Rules()) {
      dataset.ahrs.rule = row.rule;
      dataset.ahrs.gate = row.gate;
      Reconstruction estimation(dataset, AttitudeAlone());
      run->Try({row.name}, [&](RunRecord* record) {
        Judge(dataset, estimation.Run(row.smoothed ? "ahrs_smoother" : "ahrs"),
              record);
      });
    }
  };
}

}  // namespace hindsight
