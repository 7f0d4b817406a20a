#include "evaluation/curved_errors.h"

#include <fmt/core.h>

#include <cmath>

#include "base/units.h"

namespace hindsight {
namespace {

/// Of one epoch.
struct Bend {
  double excess = 0.0;  ///< e^2 - 1
  double deflection = 0.0;
  double heading_sigma = 0.0;  ///< [rad]
  double t = 0.0;
};

/// `offset` is that of position or velocity, `h` that of the heading's error.
Bend BendOf(const CovarianceSeries& P, std::size_t k, int offset, int h) {
  const double variance = P.At(k, h, h);
  const Eigen::Vector2d with_heading(P.At(k, offset, h),
                                     P.At(k, offset + 1, h));
  const double length = with_heading.norm();
  if (!(length > 0.0) || !(variance > 0.0)) return {};
  const Eigen::Vector2d across(-with_heading.y() / length,
                               with_heading.x() / length);
  Eigen::Matrix2d P_part;
  P_part << P.At(k, offset, offset), P.At(k, offset, offset + 1),
      P.At(k, offset + 1, offset), P.At(k, offset + 1, offset + 1);
  const double deflection = 0.5 * length;
  return {.excess = 3.0 * deflection * deflection / across.dot(P_part * across),
          .deflection = deflection,
          .heading_sigma = std::sqrt(variance)};
}

}  // namespace

void FindCurvedErrors(const Judged& judged, std::vector<Evidence>* evidence) {
  const Solution& solution = judged.solution;
  const Block* attitude = solution.layout.Find(BlockKind::kAttitude);
  if (attitude == nullptr || solution.observer ||
      solution.covariances.size() != solution.states.size()) {
    return;
  }
  struct Part {
    BlockKind kind;
    const char* name;
    const char* unit;
  };
  for (const Part& part : {Part{BlockKind::kPosition, "positions", "m"},
                           Part{BlockKind::kVelocity, "velocities", "m/s"}}) {
    const Block* block = solution.layout.Find(part.kind);
    if (block == nullptr) continue;
    Bend largest;
    double sum = 0.0;
    for (std::size_t k = 0; k < solution.states.size(); ++k) {
      Bend bend =
          BendOf(solution.covariances, k, block->offset, attitude->offset + 2);
      sum += bend.excess;
      if (!(bend.excess > largest.excess)) continue;
      largest = bend;
      largest.t = solution.states[k].t;
    }
    const double excess =
        solution.forward ? sum / static_cast<double>(solution.states.size())
                         : largest.excess;
    const double e = std::sqrt(1.0 + excess);
    if (!(e >= kDoubtfulError)) continue;
    evidence->push_back(
        {.grade = Grade::kDoubtful,
         .what = fmt::format(
             "with a heading known to {:.2g} deg {} lie along an arc, at "
             "{:.1f} s "
             "{:.2g} {} off any ellipse: errors of {:.2g} sigma (limit {:.2g})",
             largest.heading_sigma / kDegree, part.name, largest.t,
             largest.deflection, part.unit, e, kDoubtfulError),
         .value = e,
         .limit = kDoubtfulError,
         .unit = "sigma",
         .t_begin = largest.t,
         .t_end = largest.t,
         .causes = {"dead reckoning from a heading that nothing tells"},
         .remedies = {"a position at the end, or a better known heading"}});
    return;
  }
}

}  // namespace hindsight
