#include <fmt/core.h>

#include <algorithm>

#include "receiver_errors/receiver_errors.h"
#include "receiver_errors/sensor_findings.h"

namespace hindsight {
namespace {

/// Fixes from `begin` to `end`, in all of which the sensor errs.
struct ErrantEnd {
  double begin = 0.0;  ///< [s]
  double end = 0.0;
  double share = 0.0;  ///< of the recording
};

/// Whether the sensor errs at each node: is biased or drifting, or by its slight
/// errors more than three stated sigmas off. Before its first fix it does what it
/// does there.
std::vector<char> ErrsAt(const SensorFindings& found) {
  constexpr double kSigmas = 3.0;
  const WeighedHypothesis& chosen = found.chosen();
  const int n = found.tape.dim();
  std::vector<char> errs;
  for (std::size_t k = 0; k < chosen.steps.size(); ++k) {
    const ErrorMode mode = chosen.steps[k].mode;
    const bool large =
        chosen.smoothed[k].segment<3>(n).norm() > kSigmas * found.stated_sigma;
    errs.push_back(mode != ErrorMode::kGood &&
                   (mode != ErrorMode::kSlight || large));
  }
  std::size_t first = 0;
  while (!HasFix(found.tape, first, found.sensor)) ++first;
  std::fill_n(errs.begin(), first, errs[first]);
  return errs;
}

/// The longer one of the stretches with the first and the last node in which it
/// errs; nothing where it does not, or does throughout.
ErrantEnd LongestErrantEnd(const std::vector<char>& errs,
                           const std::vector<double>& times) {
  const auto at_start = static_cast<std::size_t>(
      std::find(errs.begin(), errs.end(), 0) - errs.begin());
  if (at_start == errs.size()) return {};
  const auto at_end = static_cast<std::size_t>(
      std::find(errs.rbegin(), errs.rend(), 0) - errs.rbegin());
  const auto between = [&times](std::size_t from, std::size_t to) {
    const double share =
        (times[to] - times[from]) / (times.back() - times.front());
    return ErrantEnd{times[from], times[to], share};
  };
  const ErrantEnd begin = between(0, at_start > 0 ? at_start - 1 : 0);
  const ErrantEnd end = between(times.size() - std::max<std::size_t>(at_end, 1),
                                times.size() - 1);
  return end.share > begin.share ? end : begin;
}

/// ln of the odds a priori against the hypothesis with the good and the erroneous
/// fixes exchanged, of which the likelihood is the same: an erroneous stretch of
/// the share s has not ended with the probability exp(-kEndsOfAnError s).
double LogOddsOf(const ErrantEnd& errant) {
  return kEndsOfAnError * (1.0 - 2.0 * errant.share);
}
/// Twenty to one.
constexpr double kLeastLogOdds = 3.0;

Evidence DoubtOf(const std::string& name, const ErrantEnd& errant) {
  return {.grade = Grade::kDoubtful,
          .what = fmt::format(
              "{} errs from {:.0f} to {:.0f} s, or else all of its other fixes "
              "do: no other sensor tells positions",
              name, errant.begin, errant.end),
          .value = LogOddsOf(errant),
          .limit = kLeastLogOdds,
          .unit = "logarithm of the odds",
          .causes = {"a receiver that errs from the first fix, or to the last"},
          .remedies = {"a stream with a position that is known at the start or "
                       "the end"}};
}

}  // namespace

std::vector<Evidence> ReceiverErrors::Doubts() const {
  std::vector<Evidence> doubts;
  if (found_->stopped) {
    doubts.push_back({.grade = Grade::kDoubtful,
                      .what = "the search for errors of " + found_->name +
                              " was ended before it was done (--max-time)",
                      .causes = {"less time than the recording needs"},
                      .remedies = {"a larger --max-time"}});
  }
  if (!found_->stands()) return doubts;
  if (found_->alone && found_->switching()) {
    const ErrantEnd errant = LongestErrantEnd(ErrsAt(*found_), found_->Times());
    if (errant.share > 0.0 && LogOddsOf(errant) < kLeastLogOdds) {
      doubts.push_back(DoubtOf(found_->name, errant));
    }
  }
  const double imu = found_->chosen().parameters.imu_scale;
  if (imu > kMisstatedImu) {
    doubts.push_back(
        {.grade = Grade::kDoubtful,
         .what =
             fmt::format("beside errors of {}, the noise of the IMU is {:.2g} "
                         "times as stated (limit {:.2g})",
                         found_->name, imu, kMisstatedImu),
         .value = imu,
         .limit = kMisstatedImu,
         .unit = "1",
         .causes = {"vibration, or noise of the IMU that is stated too small"},
         .remedies = {"'check --noise', and the noise that it finds"}});
  }
  return doubts;
}

}  // namespace hindsight
