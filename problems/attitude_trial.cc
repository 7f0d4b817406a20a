#include "problems/attitude_trial.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <utility>

#include "base/chi_square.h"
#include "base/units.h"
#include "evaluation/statistics.h"
#include "geometry/so3.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

/// Where the disturbances begin and end [s]; stamps are multiples of 0.1 s but
/// for rounding.
constexpr std::array<std::pair<double, double>, 6> kIntervals = {
    {{0.0, 5.0},
     {5.0, 10.0},
     {10.0, 40.0},
     {40.0, 45.0},
     {45.0, 60.1},
     {10.0, 60.1}}};

Eigen::Vector3d RotationError(const TruthPoint& truth, const State& x) {
  const Eigen::Quaterniond q_ne(Eigen::Matrix3d(x.C_en().transpose()));
  return Log(*truth.q_nb * (q_ne * x.q_eb).conjugate());
}

/// Share of the components within three sigmas.
double ShareInside(const Eigen::Vector3d& e, const Eigen::Vector3d& sigma) {
  constexpr double kWithin = 3.0;
  return static_cast<double>(
             (e.cwiseAbs().array() <= kWithin * sigma.array()).count()) /
         3.0;
}

void Judge(const Dataset& dataset, const Solution& solution, std::size_t every,
           RunRecord* record) {
  auto& series = record->series;
  for (std::size_t k = 0; k < solution.states.size(); k += every) {
    const State& x = solution.states[k];
    const Eigen::Vector3d psi = RotationError(dataset.truth[k], x);
    const Eigen::Vector3d bias = *dataset.truth[k].b_g - x.b_g;
    const ErrorMatrix P = solution.covariances.Get(k);
    const Eigen::Matrix3d P_psi = P.topLeftCorner<3, 3>();
    const ErrorVector sigma = P.diagonal().cwiseSqrt();
    record->t.push_back(x.t);
    series["psi"].push_back(psi.norm());
    series["psi_any"].push_back(psi.cwiseAbs().maxCoeff());
    series["psi_n"].push_back(std::abs(psi.x()));
    series["psi_e"].push_back(std::abs(psi.y()));
    series["psi_d"].push_back(std::abs(psi.z()));
    series["tilt"].push_back(psi.head<2>().norm());
    series["nees"].push_back(psi.dot(P_psi.llt().solve(psi)));
    series["inside"].push_back(ShareInside(psi, sigma.segment<3>(0)));
    series["bias"].push_back(bias.norm() / std::sqrt(3.0));
    series["bias_inside"].push_back(ShareInside(bias, sigma.segment<3>(3)));
  }
}

double ShareInEllipsoid(const RunCell& cell, const std::string& nees,
                        const TimeRange& range) {
  constexpr double kThreeSigmas = 0.9973;
  static const double kLimit = ChiSquareQuantile(kThreeSigmas, 3.0);
  std::vector<double> inside;
  for (const double value : cell.Pooled(nees, range)) {
    inside.push_back(value <= kLimit ? 1.0 : 0.0);
  }
  return Mean(inside);
}

std::vector<Figure> IntervalFigures(std::pair<double, double> interval) {
  const auto span = [&](const char* format) {
    return fmt::format(fmt::runtime(format), interval.first,
                       std::floor(interval.second));
  };
  const std::string suffix = span("_{:g}_{:g}s");
  const bool is_last = interval == kIntervals[4];
  const auto axes = [](const Reduce& reduce) {
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

std::vector<AttitudeWay> AccelerometerRules() {
  return {{"fixed", "ahrs", "fixed"},
          {"gate 0.3", "ahrs", "gate", 0.3},
          {"gate 0.88", "ahrs", "gate"},
          {"gate 3", "ahrs", "gate", 3.0},
          {"held gate 0.88", "ahrs", "held_gate"},
          {"adaptive", "ahrs", "adaptive"},
          {"smnc", "ahrs", "smnc"},
          {"gate 0.88, smoothed", "ahrs_smoother", "gate"},
          {"smnc, smoothed", "ahrs_smoother", "smnc"}};
}

std::vector<AttitudeWay> AttitudeMethods() {
  return {{"ahrs", "ahrs"}, {"ahrs_smoother", "ahrs_smoother"}};
}

Trial AttitudeTrial(const std::vector<AttitudeWay>& ways, std::size_t every) {
  return [ways, every](const Dataset& recording, CaseRun* run) {
    Dataset dataset = recording;
    for (const AttitudeWay& way : ways) {
      if (!way.rule.empty()) {
        dataset.ahrs.rule = way.rule;
        dataset.ahrs.gate = way.gate;
      }
      run->Try({way.name}, [&](RunRecord* record) {
        Reconstruction estimation(dataset, AttitudeAlone());
        Judge(dataset, estimation.Run(way.method), every, record);
      });
    }
  };
}

StudyTable VibrationTable() {
  StudyTable table = {"cells", {"rule"}, {}, {}};
  for (const auto& interval : kIntervals) {
    for (Figure& figure : IntervalFigures(interval)) {
      table.figures.push_back(std::move(figure));
    }
  }
  return table;
}

StudyTable FreeRotationTable(double begin, double end) {
  const double middle = 0.5 * (begin + end);
  constexpr double kHalfStep = 0.05;
  StudyTable table = {"cells", {"method"}, {}, {}};
  table.figures = {
      Single("heading_rms", kDegrees, "heading\nrms [deg]", "{:.3f}", "psi_d",
             OfAll<Rms>),
      Single("tilt_rms", kDegrees, "tilt\nrms [deg]", "{:.3f}", "tilt",
             OfAll<Rms>),
      Single("nees", kPlain, "NEES (3)\nattitude", "{:.2f}", OfAll<Mean>),
      Share("inside", "inside\n[%]", "nees", ShareInEllipsoid)};
  for (Figure& figure : table.figures) figure.range = {begin, end};
  table.figures[2].range = {middle - kHalfStep, middle + kHalfStep};
  return table;
}

}  // namespace hindsight
