#include "evaluation/withheld_rule.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <unsupported/Eigen/FFT>
#include <utility>

#include "base/chi_square.h"

namespace hindsight {
namespace {

/// Sums x_i x_i-k over i for all lags k >= 0.
std::vector<double> Autocorrelation(std::vector<double> x) {
  const std::size_t n = x.size();
  std::size_t padded = 1;
  while (padded < 2 * n) padded *= 2;
  x.resize(padded);
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> spectrum;
  fft.fwd(spectrum, x);
  for (std::complex<double>& one : spectrum) one = std::norm(one);
  fft.inv(x, spectrum);
  x.resize(n);
  return x;
}

/// Independent ones among correlated N(0, 1), for their mean square.
double IndependentOf(const std::vector<double>& x) {
  const std::vector<double> products = Autocorrelation(x);
  double sum = 0.0;
  for (std::size_t lag = 1; lag < x.size(); ++lag) {
    const double rho = products[lag] / products[0];
    if (!(rho > 0.0)) break;
    sum += rho * rho;
  }
  return std::max(1.0, static_cast<double>(x.size()) / (1.0 + 2.0 * sum));
}

WithheldFigure FigureOf(const std::vector<double>& x, double tail) {
  WithheldFigure figure;
  figure.count = x.size();
  const auto n = static_cast<double>(x.size());
  double squares = 0.0;
  for (const double one : x) {
    figure.mean += one / n;
    squares += one * one / n;
    if (std::abs(one) > 3.0) figure.beyond += 1.0 / n;
  }
  figure.rms = std::sqrt(squares);
  if (!(squares > 0.0)) return figure;
  figure.independent = IndependentOf(x);
  figure.excess = std::sqrt(squares * figure.independent /
                            ChiSquareQuantile(1.0 - tail, figure.independent));
  return figure;
}

/// Takes out as many of those farthest off as a mixture of noise has outliers, to
/// three sigmas of their number.
void DropOutliers(double share, std::vector<ResidualRecord>* records) {
  const auto count = static_cast<double>(records->size());
  const double most = std::min(
      count, share * count + 3.0 * std::sqrt(share * (1.0 - share) * count));
  std::stable_sort(records->begin(), records->end(),
                   [](const ResidualRecord& a, const ResidualRecord& b) {
                     return a.nis < b.nis;
                   });
  records->resize(records->size() - static_cast<std::size_t>(most));
  std::stable_sort(records->begin(), records->end(),
                   [](const ResidualRecord& a, const ResidualRecord& b) {
                     return a.t < b.t;
                   });
}

/// Withheld measurements whose errors are said to be normal: none of a sensor
/// with a robust loss, but of a mixture all without its outliers; of one with a
/// gate those that pass it, if they are most.
std::vector<ResidualRecord> WithoutOutliers(const Judged& judged) {
  std::vector<ResidualRecord> kept;
  for (std::size_t i = 0; i < judged.sensors.size(); ++i) {
    const Sensor& sensor = judged.sensors[i];
    const bool mixture = sensor.loss.kind == RobustLoss::Kind::kMixture;
    if (sensor.loss.kind != RobustLoss::Kind::kNone && !mixture) continue;
    std::vector<ResidualRecord> all, passed;
    for (const ResidualRecord& record : judged.solution.residuals) {
      if (!record.withheld || record.sensor != static_cast<int>(i)) continue;
      all.push_back(record);
      if (!sensor.gate_probability ||
          record.nis <=
              ChiSquareQuantile(*sensor.gate_probability,
                                static_cast<double>(record.residual.size()))) {
        passed.push_back(record);
      }
    }
    if (mixture) DropOutliers(sensor.loss.outlier_share, &all);
    const auto& own = !mixture && 2 * passed.size() > all.size() ? passed : all;
    kept.insert(kept.end(), own.begin(), own.end());
  }
  return kept;
}

bool IsUsed(int sensor, const std::vector<ResidualRecord>& residuals) {
  return std::any_of(residuals.begin(), residuals.end(),
                     [sensor](const ResidualRecord& record) {
                       return record.sensor == sensor && record.accepted &&
                              !record.withheld;
                     });
}

}  // namespace

std::vector<WithheldFigure> TestWithheld(
    std::span<const ResidualRecord> residuals, double false_alarms) {
  std::map<std::pair<int, int>, std::vector<double>> all;
  for (const ResidualRecord& record : residuals) {
    if (!record.withheld) continue;
    for (int row = 0; row < record.residual.size(); ++row) {
      if (!(record.sigma(row) > 0.0)) continue;
      all[{record.sensor, row}].push_back(record.residual(row) /
                                          record.sigma(row));
    }
  }
  std::erase_if(all, [](const auto& entry) {
    return entry.second.size() < kFewestInnovations;
  });
  std::vector<WithheldFigure> figures;
  for (const auto& [key, x] : all) {
    figures.push_back(
        FigureOf(x, false_alarms / static_cast<double>(all.size())));
    figures.back().sensor = key.first;
    figures.back().row = key.second;
  }
  return figures;
}

void FindOddPredictions(const Judged& judged, std::vector<Evidence>* evidence) {
  if (judged.sensors.empty() || judged.solution.observer) return;
  const std::vector<WithheldFigure> figures =
      TestWithheld(WithoutOutliers(judged), kFalseAlarms);
  for (std::size_t sensor = 0; sensor < judged.sensors.size(); ++sensor) {
    const WithheldFigure* worst = nullptr;
    for (const WithheldFigure& figure : figures) {
      if (figure.sensor != static_cast<int>(sensor)) continue;
      if (worst == nullptr || figure.excess > worst->excess) worst = &figure;
    }
    if (worst == nullptr || worst->excess < kDoubtfulError) continue;
    const bool unusable =
        worst->excess >= kUnusableError &&
        IsUsed(static_cast<int>(sensor), judged.solution.residuals);
    evidence->push_back(
        {.grade = unusable ? Grade::kUnusable : Grade::kDoubtful,
         .what = fmt::format(
             "withheld measurements of {} are {:.1f} times as far from what is "
             "predicted as sigmas say, {:.1f} times what chance explains",
             judged.sensors[sensor].name, worst->rms, worst->excess),
         .value = worst->excess,
         .limit = unusable ? kUnusableError : kDoubtfulError,
         .unit = "sigma",
         .causes = {"sigmas of the IMU or of aiding that are too small",
                    "an error of what was withheld"},
         .remedies = {"'check --noise'"}});
  }
}

}  // namespace hindsight
