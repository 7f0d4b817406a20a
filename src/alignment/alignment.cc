#include "alignment/alignment.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "alignment/ahrs.h"
#include "alignment/course.h"
#include "alignment/given.h"
#include "alignment/gyrocompass.h"
#include "alignment/levelling.h"
#include "alignment/magnetic_heading.h"
#include "alignment/velocity_alignment.h"
#include "base/error.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr std::array<AlignmentMethod, 7> kMethods = {
    {{AlignmentKind::kGiven, AlignAsGiven, false},
     {AlignmentKind::kStatic, AlignAtRest},
     {AlignmentKind::kGyrocompass, AlignByGyrocompass},
     {AlignmentKind::kMagnetometer, AlignByMagnetometer},
     {AlignmentKind::kCourse, AlignByCourse},
     {AlignmentKind::kVelocity, AlignByVelocity},
     {AlignmentKind::kAhrs, AlignByAhrs, false}}};

bool TellsHeading(const AlignedAttitude& attitude) {
  return attitude.P(2, 2) < kUnknownHeadingSigma * kUnknownHeadingSigma;
}

std::string HeadingWords(const AlignedAttitude& attitude) {
  if (!TellsHeading(attitude)) return "heading open";
  char text[64];
  std::snprintf(text, sizeof(text), "heading to %.2g deg",
                std::sqrt(attitude.P(2, 2)) / kDegree);
  return text;
}

/// Whether two attitudes are more than five sigmas apart.
bool Contradict(const AlignedAttitude& a, const AlignedAttitude& b) {
  constexpr double kFiveSigmas = 25.0;
  const Eigen::Vector3d d = Log(a.q_nb * b.q_nb.conjugate());
  const Eigen::Matrix3d P = a.P + b.P;
  return d.dot(P.llt().solve(d)) > kFiveSigmas;
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

AlignmentChoice AlignBest(const AlignmentInput& input) {
  AlignmentChoice best;
  std::string others;
  bool found = false;
  constexpr double kWellKnown = 0.5 * kDegree;
  for (const AlignmentMethod& method : kMethods) {
    if (!method.in_auto) continue;
    if (found &&
        best.attitude.P.diagonal().maxCoeff() < kWellKnown * kWellKnown) {
      break;
    }
    AlignmentOutcome outcome = method.align(input);
    const std::string name = AlignmentName(method.kind);
    if (!outcome.found) {
      others += "; " + name + ": " + outcome.reason;
      continue;
    }
    // Where all leave the heading open, the first found stays. Motion that
    // fits no body whose x axis points forward refutes the course.
    constexpr double kNotably = 0.9;
    const bool refuted = found && best.kind == AlignmentKind::kCourse &&
                         method.kind == AlignmentKind::kVelocity &&
                         TellsHeading(*outcome.found) &&
                         Contradict(*outcome.found, best.attitude);
    const bool better =
        !found || refuted ||
        outcome.found->P.trace() < kNotably * best.attitude.P.trace();
    const AlignedAttitude& loser = better ? best.attitude : *outcome.found;
    if (found) {
      others += "; " + (better ? AlignmentName(best.kind) : name) + ": " +
                HeadingWords(loser) + (refuted ? ", but refuted" : "");
    }
    if (better) best = {method.kind, std::move(*outcome.found), ""};
    found = true;
  }
  if (!found) {
    best = {AlignmentKind::kStatic, LevelAttitude(input), ""};
    best.attitude.heading = "unknown";
  }
  best.why = HeadingWords(best.attitude) + ", the best of" +
             (others.empty() ? " one" : others.substr(1));
  return best;
}

}  // namespace

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
