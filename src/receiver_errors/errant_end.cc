#include "receiver_errors/errant_end.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "receiver_errors/sensor_findings.h"
#include "receiver_errors/sensor_tape.h"

namespace hindsight {
namespace {

std::size_t FirstFix(const SensorFindings& found) {
  std::size_t first = 0;
  while (!HasFix(found.tape, first, found.sensor)) ++first;
  return first;
}

/// Whether the sensor errs at each node. Before its first fix it does what it does
/// there.
std::vector<char> ErrsAt(const SensorFindings& found) {
  const WeighedHypothesis& chosen = found.chosen();
  const int n = found.tape.dim();
  std::vector<char> errs;
  for (std::size_t k = 0; k < chosen.steps.size(); ++k) {
    const ErrorMode mode = chosen.steps[k].mode;
    const bool large = found.IsLarge(chosen.smoothed[k].segment<3>(n).norm());
    errs.push_back(mode != ErrorMode::kGood &&
                   (mode != ErrorMode::kSlight || large));
  }
  const std::size_t first = FirstFix(found);
  std::fill_n(errs.begin(), first, errs[first]);
  return errs;
}

bool ErrsEverywhere(const SensorFindings& found) {
  return std::ranges::all_of(ErrsAt(found),
                             [](char errs) { return errs != 0; });
}

ErrantEnd Between(const LinearTape& tape, std::size_t first, std::size_t past) {
  const std::size_t last = tape.size() - 1;
  ErrantEnd out;
  out.first = first;
  out.past = past;
  out.at_start = first == 0;
  if (past == first) return out;
  out.begin = tape.t(first);
  out.end = tape.t(past - 1);
  out.share = (out.end - out.begin) / (tape.t(last) - tape.t(0));
  return out;
}

/// Of the sensor's errors at the nodes of a stretch [m].
struct ErrorOfStretch {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double deviation = 0.0;  ///< root mean square of the distance from it
};

ErrorOfStretch ErrorOver(const SensorFindings& found, const ErrantEnd& at) {
  const int n = found.tape.dim();
  const ErrorTrajectory& smoothed = found.chosen().smoothed;
  ErrorOfStretch out;
  double squares = 0.0;
  for (std::size_t k = at.first; k < at.past; ++k) {
    out.mean += smoothed[k].segment<3>(n);
    squares += smoothed[k].segment<3>(n).squaredNorm();
  }
  const auto count = static_cast<double>(at.past - at.first);
  out.mean /= count;
  out.deviation =
      std::sqrt(std::max(0.0, squares / count - out.mean.squaredNorm()));
  return out;
}

/// Whether it is the same within a third of itself.
bool IsConstant(const ErrorOfStretch& error) {
  constexpr double kConstant = 1.0 / 3.0;
  return error.deviation <= kConstant * error.mean.norm();
}

/// How far the vehicle is elsewhere if the fixes are right by which it is off.
std::optional<Eigen::Vector3d> MoveBy(const SensorFindings& found,
                                      const ErrantEnd& at,
                                      const Eigen::Vector3d& error) {
  for (std::size_t k = at.first; k < at.past; ++k) {
    for (const TapeMeasurement& z : found.tape.measurements(k)) {
      if (z.sensor != found.sensor || z.H.rows() != 3) continue;
      return z.H.leftCols<3>().inverse() * error;
    }
  }
  return std::nullopt;
}

/// ln of how much less likely the start is, moved so, by what is known of the
/// position a priori.
double LogLossAtStart(const SensorFindings& found,
                      const Eigen::Vector3d& moved) {
  const Eigen::Vector3d off = (found.chosen().smoothed.front().head<3>() -
                               found.tape.epoch(0).dx_minus.head<3>());
  const Eigen::Matrix3d information =
      found.tape.P_minus(0).topLeftCorner<3, 3>().inverse();
  const Eigen::Vector3d there = off + moved;
  return 0.5 * (there.dot(information * there) - off.dot(information * off));
}

/// The chosen hypothesis with the sensor good in a stretch in which it is off by a
/// constant, and all else moved by that; steps as they are. The weight is by ln of the
/// odds against it beside those of the start. Nothing where the error of the stretch
/// varies by more than a third of itself.
std::optional<WeighedHypothesis> GoodIn(const SensorFindings& found,
                                        const ErrantEnd& stretch,
                                        double log_odds) {
  const ErrorOfStretch error = ErrorOver(found, stretch);
  if (!IsConstant(error)) return std::nullopt;
  const auto moved = MoveBy(found, stretch, error.mean);
  if (!moved) return std::nullopt;
  WeighedHypothesis out = found.chosen();
  out.weight = 1.0 / (1.0 + std::exp(log_odds + LogLossAtStart(found, *moved)));
  const int n = found.tape.dim();
  for (std::size_t k = 0; k < out.steps.size(); ++k) {
    out.smoothed[k].head<3>() += *moved;
    out.smoothed[k].segment<3>(n) -= error.mean;
  }
  return out;
}

}  // namespace

double ErrantEnd::LogOdds() const {
  return kEndsOfAnError * (1.0 - 2.0 * share);
}

bool ErrantEnd::IsDoubtful() const { return LogOdds() < kLeastLogOdds; }

std::optional<ErrantEnd> FindErrantEnd(const SensorFindings& found) {
  if (!found.alone || !found.switching()) return std::nullopt;
  const std::vector<char> errs = ErrsAt(found);
  const auto at_start = static_cast<std::size_t>(
      std::find(errs.begin(), errs.end(), 0) - errs.begin());
  if (at_start == errs.size()) return std::nullopt;
  const auto at_end = static_cast<std::size_t>(
      std::find(errs.rbegin(), errs.rend(), 0) - errs.rbegin());
  const ErrantEnd begin = Between(found.tape, 0, at_start);
  const ErrantEnd end = Between(found.tape, errs.size() - at_end, errs.size());
  const ErrantEnd& longer = end.share > begin.share ? end : begin;
  if (longer.share <= 0.0) return std::nullopt;
  return longer;
}

bool ErrsThroughout(const SensorFindings& found) {
  return found.alone && found.switching() && ErrsEverywhere(found);
}

std::optional<WeighedHypothesis> Exchanged(const SensorFindings& found,
                                           const ErrantEnd& errant) {
  const double well = LogOddsOfBeginningWell();
  std::optional<WeighedHypothesis> out = GoodIn(
      found, errant, errant.LogOdds() + (errant.at_start ? -well : well));
  if (!out) return std::nullopt;
  for (std::size_t k = 0; k < out->steps.size(); ++k) {
    const bool good = k >= errant.first && k < errant.past;
    const bool anew = k == (errant.at_start ? errant.past : 0);
    out->steps[k] = {good ? ErrorMode::kGood : ErrorMode::kBiased, anew};
  }
  return out;
}

std::optional<WeighedHypothesis> ExchangedWithOther(
    const SensorFindings& found) {
  if (found.beside.empty() || !found.switching() || !ErrsEverywhere(found)) {
    return std::nullopt;
  }
  const std::vector<ErrorStep>& steps = found.chosen().steps;
  std::size_t jump = FirstFix(found) + 1;
  while (jump < steps.size() && !steps[jump].anew &&
         steps[jump].mode == steps[jump - 1].mode) {
    ++jump;
  }
  if (jump >= steps.size()) return std::nullopt;
  const ErrantEnd stretch = Between(found.tape, 0, jump);
  std::optional<WeighedHypothesis> out =
      GoodIn(found, stretch,
             LogOddsOfAnotherBias() + kEndsOfAnError * (1.0 - stretch.share));
  if (!out) return std::nullopt;
  std::fill_n(out->steps.begin(), jump, ErrorStep{});
  out->steps[jump].anew = true;
  return out;
}

std::optional<double> LogOddsByStart(const SensorFindings& found) {
  if (found.beside.empty() || !ErrsEverywhere(found)) return std::nullopt;
  const ErrantEnd all = Between(found.tape, 0, found.tape.size());
  const ErrorOfStretch error = ErrorOver(found, all);
  if (!IsConstant(error) || !found.IsLarge(error.mean.norm())) {
    return std::nullopt;
  }
  const auto moved = MoveBy(found, all, error.mean);
  if (!moved) return std::nullopt;
  return LogLossAtStart(found, *moved);
}

}  // namespace hindsight
