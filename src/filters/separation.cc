#include "filters/separation.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "filters/kalman.h"
#include "state/euler_error.h"

namespace hindsight {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kMostScales = 1e6;

}  // namespace

BackwardSide::BackwardSide(const LinearTape& tape, std::size_t k,
                           const Information::Estimate& alone,
                           const ErrorVector& scale)
    : tape_(tape),
      k_(k),
      difference_(alone.mean),
      P_b_(alone.P),
      P_f_(tape.P_plus(k)),
      most_(kMostScales * scale) {}

bool BackwardSide::Knows(int component) const {
  const double variance = P_b_(component, component);
  return variance > 0.0 && variance < most_(component) * most_(component);
}

double BackwardSide::Distance() const {
  const Block& position = *tape_.layout().Find(BlockKind::kPosition);
  const int first = position.offset;
  const int count = position.dim;
  for (int i = 0; i < count; ++i) {
    if (!Knows(first + i)) return kNothing;
  }
  ErrorMatrix P = P_b_.block(first, first, count, count) +
                  P_f_.block(first, first, count, count);
  Symmetrize(&P);
  const ErrorVector e = difference_.segment(first, count);
  return std::sqrt(e.dot(P.ldlt().solve(e)));
}

void BackwardSide::FillVector(BlockKind kind, int first,
                              FilterSeparation* out) const {
  const Block* block = tape_.layout().Find(kind);
  if (block == nullptr) return;
  int i = block->offset;
  for (int axis = 0; axis < 3; ++axis) {
    if (!block->active[static_cast<std::size_t>(axis)]) continue;
    if (Knows(i)) {
      out->difference(first + axis) = -difference_(i);
      out->sigma(first + axis) = std::sqrt(P_f_(i, i) + P_b_(i, i));
    }
    ++i;
  }
}

void BackwardSide::FillAngles(FilterSeparation* out) const {
  constexpr int kFirst = 6;
  const Block* block = tape_.layout().Find(BlockKind::kAttitude);
  if (block == nullptr || block->dim != 3) return;
  const int i = block->offset;
  if (!Knows(i) || !Knows(i + 1)) return;
  // Roll and pitch do not change with a turn about the vertical: they can be
  // told even where nothing is known of that.
  Eigen::Matrix3d P_b = P_b_.block<3, 3>(i, i);
  if (!Knows(i + 2)) P_b(2, 2) = std::numeric_limits<double>::max();
  const Eigen::Vector3d euler = tape_.epoch(k_).x_plus.euler();
  const Eigen::Matrix3d P = P_b + P_f_.block<3, 3>(i, i);
  const Eigen::Vector3d alone = EulerSigma(euler, P_b);
  const Eigen::Vector3d sigma = EulerSigma(euler, P);
  const Eigen::Vector3d angles =
      EulerErrorJacobian(euler) * difference_.segment<3>(i);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(alone(axis) < kUnknownAngleSigma)) continue;
    out->difference(kFirst + axis) = std::remainder(-angles(axis), 2.0 * kPi);
    out->sigma(kFirst + axis) = sigma(axis);
  }
}

FilterSeparation BackwardSide::Components() const {
  FilterSeparation out;
  out.difference.setConstant(kNothing);
  out.sigma.setConstant(kNothing);
  FillVector(BlockKind::kPosition, 0, &out);
  FillVector(BlockKind::kVelocity, 3, &out);
  FillAngles(&out);
  return out;
}

OneSidedState BackwardSide::Alone() const {
  const TapeEpoch& epoch = tape_.epoch(k_);
  ErrorVector d = difference_;
  if (!epoch.reset) d += epoch.dx_plus;
  OneSidedState out = {tape_.StateAt(epoch, d), P_b_.diagonal()};
  for (int i = 0; i < static_cast<int>(out.sigma.size()); ++i) {
    out.sigma(i) = Knows(i) ? std::sqrt(out.sigma(i)) : kNothing;
  }
  return out;
}

}  // namespace hindsight
