#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "receiver_errors/errant_end.h"
#include "receiver_errors/receiver_errors.h"
#include "receiver_errors/regime_choice.h"
#include "receiver_errors/sensor_findings.h"
#include "receiver_errors/uniform_regimes.h"

namespace hindsight {
namespace {

Evidence DoubtOf(const std::string& name, const ErrantEnd& errant) {
  return {.grade = Grade::kDoubtful,
          .what = fmt::format(
              "{} errs from {:.0f} to {:.0f} s, or else all of its other fixes "
              "do: no other sensor tells positions",
              name, errant.begin, errant.end),
          .value = errant.LogOdds(),
          .limit = kLeastLogOdds,
          .unit = "logarithm of the odds",
          .causes = {"a receiver that errs from the first fix, or to the last"},
          .remedies = {"a stream with a position that is known at the start or "
                       "the end"}};
}

/// A start that is five sigmas better with the one than with the other tells which is off.
constexpr double kSureByStart = 12.5;

}  // namespace

std::vector<Evidence> ReceiverErrors::Doubts(double imu_scale) const {
  std::vector<Evidence> doubts;
  if (!found_->stands()) return doubts;
  const std::optional<ErrantEnd> errant = FindErrantEnd(*found_);
  if (errant && errant->IsDoubtful()) {
    doubts.push_back(DoubtOf(found_->name, *errant));
  }
  if (ErrsThroughout(*found_)) {
    doubts.push_back(
        {.grade = Grade::kDoubtful,
         .what = found_->name +
                 " errs from its first fix to its last, and no other sensor "
                 "tells positions",
         .causes = {"hypotheses by which one part or the other errs, between "
                    "which this one lies"},
         .remedies = {"a stream with a position that is known"}});
  }
  if (found_->other_errs > std::exp(-kLeastGain)) {
    doubts.push_back(
        {.grade = Grade::kDoubtful,
         .what = fmt::format("{} agrees nowhere with {}, which may be off in "
                             "its place",
                             found_->name, found_->beside),
         .value = found_->other_errs,
         .limit = std::exp(-kLeastGain),
         .unit = "probability",
         .causes = {"two receivers that err, one of them throughout"},
         .remedies = {"a stream with a position that is known"}});
  }
  const std::optional<double> by_start = LogOddsByStart(*found_);
  if (by_start && *by_start < kSureByStart) {
    doubts.push_back(
        {.grade = Grade::kDoubtful,
         .what = fmt::format(
             "{} is off from its first fix to its last against {}, and that "
             "it is not {}, or both, nothing but the start tells",
             found_->name, found_->beside, found_->beside),
         .value = *by_start,
         .limit = kSureByStart,
         .unit = "logarithm of the odds",
         .causes = {"positions in two datums or epochs",
                    "a base station, or "
                    "a lever arm, that is not where it is said to be"},
         .remedies = {"a stream with a position that is known, or 'datum' of "
                      "the one that is off"}});
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
  constexpr double kQuiet = 1.0 / kMisstatedImu;
  const double least = std::min(imu, imu_scale);
  if (least < kQuiet && HasVelocitySteps()) {
    doubts.push_back(
        {.grade = Grade::kDoubtful,
         .what = fmt::format(
             "beside errors of {}, the velocity of the IMU steps, but its "
             "noise is {:.2g} times as stated (limit {:.2g})",
             found_->name, least, kQuiet),
         .value = least,
         .limit = kQuiet,
         .unit = "1",
         .causes = {"errors of a sensor that are taken for those of an IMU "
                    "which hardly errs otherwise"},
         .remedies = {"'check --noise', and the noise that it finds"}});
  }
  return doubts;
}

}  // namespace hindsight
