#include "alignment/alignment.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <utility>

#include "alignment/ahrs.h"
#include "alignment/course.h"
#include "alignment/given.h"
#include "alignment/gyrocompass.h"
#include "alignment/judgement.h"
#include "alignment/levelling.h"
#include "alignment/magnetic_heading.h"
#include "alignment/measured_heading.h"
#include "alignment/velocity_alignment.h"
#include "base/error.h"
#include "dataset/bias_sigma.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr std::array<AlignmentMethod, 8> kMethods = {
    {{AlignmentKind::kGiven, AlignAsGiven, false},
     {AlignmentKind::kStatic, AlignAtRest},
     {AlignmentKind::kGyrocompass, AlignByGyrocompass},
     {AlignmentKind::kHeading, AlignByHeading},
     {AlignmentKind::kMagnetometer, AlignByMagnetometer},
     {AlignmentKind::kCourse, AlignByCourse},
     {AlignmentKind::kVelocity, AlignByVelocity},
     {AlignmentKind::kAhrs, AlignByAhrs, false}}};

std::string HeadingWords(const AlignedAttitude& attitude) {
  if (!TellsHeading(attitude)) return "heading open";
  return fmt::format("heading to {:.2g} deg",
                     std::sqrt(attitude.P(2, 2)) / kDegree);
}

bool IsGiven(const InitialState& initial) {
  return initial.euler.has_value() || initial.heading.has_value();
}

AlignmentChoice AlignBy(AlignmentKind kind, const AlignmentInput& input) {
  for (const AlignmentMethod& method : kMethods) {
    if (method.kind != kind) continue;
    const AlignmentOutcome outcome = method.align(input);
    if (!outcome.found) {
      throw EstimationError("alignment " + AlignmentName(kind) + ": " +
                            outcome.reason);
    }
    return {kind, *outcome.found, "given by the configuration"};
  }
  throw EstimationError("alignment " + AlignmentName(kind) +
                        " is not available");
}

/// An attitude that a method has found.
struct Candidate {
  AlignmentKind kind = AlignmentKind::kStatic;
  AlignedAttitude attitude;
  bool refuted = false;
};

/// The candidate with the smallest covariance of those not refuted. Where all
/// leave the heading open, the first found stays.
std::size_t Favourite(const std::vector<Candidate>& candidates) {
  constexpr double kNotably = 0.9;
  std::size_t best = candidates.size();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].refuted) continue;
    if (best == candidates.size() ||
        candidates[i].attitude.P.trace() <
            kNotably * candidates[best].attitude.P.trace()) {
      best = i;
    }
  }
  return best;
}

/// Settles what contradicts the favourite; returns the one that stands.
std::size_t Settle(const AlignmentInput& input,
                   std::vector<Candidate>* candidates) {
  std::vector<Candidate>& all = *candidates;
  std::size_t best = Favourite(all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i == best || all[i].refuted ||
        !Contradict(all[best].attitude, all[i].attitude)) {
      continue;
    }
    const double ratio =
        Judge(input, all[best].attitude, all[i].attitude).value_or(0.0);
    if (std::abs(ratio) < kDecided) {
      const Eigen::Vector3d d = Difference(all[i].attitude, all[best].attitude);
      all[best].attitude.P += d * d.transpose();
      continue;
    }
    all[ratio > 0.0 ? i : best].refuted = true;
    if (ratio > 0.0) continue;
    best = Favourite(all);
    i = static_cast<std::size_t>(-1);  // the new favourite against all others
  }
  return best;
}

AlignmentChoice AlignBest(const AlignmentInput& input) {
  constexpr double kWellKnown = 0.5 * kDegree;
  std::vector<Candidate> candidates;
  std::string others;
  for (const AlignmentMethod& method : kMethods) {
    if (!method.in_auto) continue;
    AlignmentOutcome outcome = method.align(input);
    if (!outcome.found) {
      others += "; " + AlignmentName(method.kind) + ": " + outcome.reason;
      continue;
    }
    candidates.push_back({method.kind, std::move(*outcome.found)});
    if (candidates[Favourite(candidates)].attitude.P.diagonal().maxCoeff() <
        kWellKnown * kWellKnown) {
      break;
    }
  }
  if (candidates.empty()) {
    candidates.push_back({AlignmentKind::kStatic, LevelAttitude(input)});
    candidates.front().attitude.heading = "unknown";
  }
  const std::size_t best = Settle(input, &candidates);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (i == best) continue;
    others += "; " + AlignmentName(candidates[i].kind) + ": " +
              HeadingWords(candidates[i].attitude) +
              (candidates[i].refuted ? ", but refuted" : "");
  }
  return {candidates[best].kind, candidates[best].attitude,
          HeadingWords(candidates[best].attitude) + ", the best of" +
              (others.empty() ? " one" : others.substr(1))};
}

}  // namespace

GyroBiasPrior GyroBiasBefore(const AlignmentInput& input) {
  const InitialState& given = input.dataset.initial;
  return input.b_g_before.value_or(
      GyroBiasPrior{given.gyro_bias, GyroBiasSigma(given)});
}

bool TellsHeading(const AlignedAttitude& attitude) {
  return attitude.P(2, 2) < kUnknownHeadingSigma * kUnknownHeadingSigma;
}

Eigen::Vector3d Difference(const AlignedAttitude& a, const AlignedAttitude& b) {
  Eigen::Quaterniond d = a.q_nb * b.q_nb.conjugate();
  if (!TellsHeading(a) || !TellsHeading(b)) {
    const double turn = 2.0 * std::atan2(d.z(), d.w());
    const Eigen::Quaterniond level = Exp(-turn * Eigen::Vector3d::UnitZ());
    // The one that is open is turned: by what remains the other still differs.
    d = TellsHeading(a) ? d * level : level * d;
  }
  return Log(d);
}

bool Contradict(const AlignedAttitude& a, const AlignedAttitude& b) {
  constexpr double kFiveSigmas = 25.0;
  const Eigen::Vector3d d = Difference(a, b);
  const Eigen::Matrix3d P = a.P + b.P;
  return d.dot(P.llt().solve(d)) > kFiveSigmas;
}

std::span<const AlignmentMethod> AlignmentMethods() { return kMethods; }

std::string AlignmentName(AlignmentKind kind) {
  return AlignmentNames()[static_cast<std::size_t>(kind)];
}

AlignmentChoice Align(const AlignmentInput& input) {
  const InitialState& initial = input.dataset.initial;
  if (initial.alignment != AlignmentKind::kAuto) {
    return AlignBy(initial.alignment, input);
  }
  if (IsGiven(initial)) return AlignBy(AlignmentKind::kGiven, input);
  return AlignBest(input);
}

}  // namespace hindsight
