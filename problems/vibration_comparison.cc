#include "problems/vibration_comparison.h"

#include <cmath>

#include "base/error.h"
#include "geometry/so3.h"
#include "problems/attitude.h"

namespace hindsight {
namespace {

/// Sums over samples, turned into statistics at the end.
struct IntervalSums {
  VibrationStatistics s;
  long count = 0;

  void Add(const Eigen::Vector3d& psi, const Eigen::Vector3d& bias,
           const ErrorMatrix& P) {
    const Eigen::Matrix<double, 6, 1> sigma = P.diagonal().cwiseSqrt();
    s.rms += psi.cwiseAbs2();
    s.largest = s.largest.cwiseMax(psi.cwiseAbs());
    s.rms_total += psi.squaredNorm();
    s.bias_rms += bias.squaredNorm() / 3.0;
    for (int i = 0; i < 3; ++i) {
      s.inside += std::abs(psi(i)) <= 3.0 * sigma(i) ? 1.0 / 3.0 : 0.0;
      s.bias_inside +=
          std::abs(bias(i)) <= 3.0 * sigma(3 + i) ? 1.0 / 3.0 : 0.0;
    }
    ++count;
  }

  VibrationStatistics Finish() const {
    const double n = static_cast<double>(count);
    VibrationStatistics out = s;
    out.rms = (s.rms / n).cwiseSqrt();
    out.rms_total = std::sqrt(s.rms_total / n);
    out.bias_rms = std::sqrt(s.bias_rms / n);
    out.inside /= n;
    out.bias_inside /= n;
    return out;
  }
};

VibrationRow Row(const std::string& name, const std::string& rule,
                 double gate = 0.88, bool smoothed = false) {
  VibrationRow row;
  row.name = name;
  row.ahrs.rule = rule;
  row.ahrs.gate = gate;
  row.smoothed = smoothed;
  return row;
}

void AddRun(const Dataset& dataset, const Solution& solution,
            std::vector<IntervalSums>* sums) {
  const auto& intervals = VibrationIntervals();
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    const State& x = solution.states[k];
    const Eigen::Matrix3d C_ne = x.C_en().transpose();
    const TruthPoint truth = dataset.truth[k];
    const Eigen::Vector3d psi =
        Log(*truth.q_nb * (Eigen::Quaterniond(C_ne) * x.q_eb).conjugate());
    const Eigen::Vector3d bias = *truth.b_g - x.b_g;
    const ErrorMatrix P = solution.covariances.Get(k);
    for (std::size_t i = 0; i < intervals.size(); ++i) {
      // Stamps are multiples of 0.1 s but for rounding.
      const double t = x.t + 1e-9;
      if (t >= intervals[i].begin && t < intervals[i].end) {
        (*sums)[i].Add(psi, bias, P);
      }
    }
  }
}

}  // namespace

std::vector<VibrationRow> VibrationRows() {
  return {Row("fixed", "fixed"),
          Row("gate 0.3", "gate", 0.3),
          Row("gate 0.88", "gate", 0.88),
          Row("gate 3", "gate", 3.0),
          Row("held gate 0.88", "held_gate", 0.88),
          Row("adaptive", "adaptive"),
          Row("smnc", "smnc"),
          Row("gate 0.88, smoothed", "gate", 0.88, true),
          Row("smnc, smoothed", "smnc", 0.88, true)};
}

const std::vector<VibrationInterval>& VibrationIntervals() {
  static const std::vector<VibrationInterval> kIntervals = {
      {0.0, 5.0},   {5.0, 10.0},  {10.0, 40.0},
      {40.0, 45.0}, {45.0, 60.1}, {10.0, 60.1}};
  return kIntervals;
}

std::vector<VibrationResult> CompareUnderVibration(
    const std::function<Dataset(std::uint64_t)>& simulate, int runs,
    std::uint64_t first_seed, const std::function<void(int)>& done,
    const std::atomic<bool>* stop) {
  const std::vector<VibrationRow> rows = VibrationRows();
  std::vector<std::vector<IntervalSums>> sums(
      rows.size(), std::vector<IntervalSums>(VibrationIntervals().size()));
  for (int run = 0; run < runs; ++run) {
    if (stop != nullptr && *stop) throw Interrupted();
    Dataset dataset = simulate(first_seed + static_cast<std::uint64_t>(run));
    for (std::size_t r = 0; r < rows.size(); ++r) {
      dataset.ahrs.rule = rows[r].ahrs.rule;
      dataset.ahrs.gate = rows[r].ahrs.gate;
      dataset.ahrs.lambda = rows[r].ahrs.lambda;
      dataset.ahrs.samples = rows[r].ahrs.samples;
      AttitudeEstimation estimation(dataset, {});
      AddRun(dataset,
             estimation.Run(rows[r].smoothed ? "ahrs_smoother" : "ahrs"),
             &sums[r]);
    }
    if (done) done(run + 1);
  }
  std::vector<VibrationResult> results;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    results.push_back({rows[r].name, {}});
    for (const IntervalSums& s : sums[r])
      results.back().intervals.push_back(s.Finish());
  }
  return results;
}

}  // namespace hindsight
