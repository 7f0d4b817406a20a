#include "state/error_definition.h"

#include <cmath>
#include <utility>

#include "base/error.h"
#include "state/active_axes.h"

namespace hindsight {
namespace {

constexpr std::pair<ErrorDefinition, const char*> kNames[] = {
    {ErrorDefinition::kNavigation, "navigation"},
    {ErrorDefinition::kQuaternion, "quaternion"},
    {ErrorDefinition::kLeftInvariant, "left_invariant"}};

bool IsVelocityOrPosition(const Block& block) {
  return block.key.kind == BlockKind::kPosition ||
         block.key.kind == BlockKind::kVelocity;
}

/// The attitude part of d, NED.
Eigen::Vector3d Rotation(const ErrorLayout& layout, const ErrorVector& d) {
  const Block* attitude = layout.Find(BlockKind::kAttitude);
  return attitude == nullptr ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                             : Expand(*attitude, d);
}

/// d with M applied to its velocity and position parts.
ErrorVector TurnVelocityAndPosition(const ErrorLayout& layout,
                                    const Eigen::Matrix3d& M, ErrorVector d) {
  for (const Block& block : layout.blocks()) {
    if (IsVelocityOrPosition(block)) {
      Compress(block, M * Expand(block, d), &d);
    }
  }
  return d;
}

/// d with its attitude part of length r stretched to length f(r).
template <typename Function>
ErrorVector StretchRotation(const ErrorLayout& layout, ErrorVector d,
                            Function f) {
  const Eigen::Vector3d psi = Rotation(layout, d);
  const double r = psi.norm();
  if (r == 0.0) return d;
  Compress(*layout.Find(BlockKind::kAttitude), psi * (f(r) / r), &d);
  return d;
}

void AssignBlock(const Block& block, const Eigen::Matrix3d& full,
                 ErrorMatrix* T) {
  int row = block.offset;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!block.active[i]) continue;
    int column = block.offset;
    for (std::size_t j = 0; j < 3; ++j) {
      if (!block.active[j]) continue;
      (*T)(row, column++) =
          full(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
    ++row;
  }
}

}  // namespace

const char* ErrorName(ErrorDefinition error) {
  for (const auto& [value, name] : kNames) {
    if (value == error) return name;
  }
  return "";
}

ErrorDefinition ErrorFromName(const std::string& name) {
  std::string known;
  for (const auto& [value, text] : kNames) {
    if (name == text) return value;
    known += (known.empty() ? "" : ", ") + std::string(text);
  }
  throw InputError("unknown error definition '" + name + "'; known are " +
                   known);
}

State Retract(ErrorDefinition error, const ErrorLayout& layout, const State& x,
              const ErrorVector& d) {
  switch (error) {
    case ErrorDefinition::kQuaternion:
      return Retract(layout, x, StretchRotation(layout, d, [](double r) {
                       return 2.0 * std::atan(0.5 * r);
                     }));
    case ErrorDefinition::kLeftInvariant:
      return Retract(layout, x,
                     TurnVelocityAndPosition(
                         layout, LeftJacobian(Rotation(layout, d)), d));
    default:
      return Retract(layout, x, d);
  }
}

ErrorVector Local(ErrorDefinition error, const ErrorLayout& layout,
                  const State& reference, const State& x) {
  const ErrorVector d = Local(layout, reference, x);
  switch (error) {
    case ErrorDefinition::kQuaternion:
      return StretchRotation(layout, d,
                             [](double r) { return 2.0 * std::sin(0.5 * r); });
    case ErrorDefinition::kLeftInvariant:
      return TurnVelocityAndPosition(
          layout, LeftJacobianInverse(Rotation(layout, d)), d);
    default:
      return d;
  }
}

ErrorMatrix Transport(ErrorDefinition error, const ErrorLayout& layout,
                      const State& from, const ErrorVector& d,
                      const State& to) {
  ErrorMatrix T = Transport(layout, from, to);
  if (error == ErrorDefinition::kNavigation) return T;
  const Eigen::Vector3d psi = Rotation(layout, d);
  const Eigen::Matrix3d axes = to.C_en().transpose() * from.C_en();
  if (error == ErrorDefinition::kQuaternion) {
    if (const Block* attitude = layout.Find(BlockKind::kAttitude)) {
      const Eigen::Matrix3d turn =
          Eigen::Matrix3d::Identity() + 0.5 * Skew(psi);
      AssignBlock(*attitude, axes * turn / (1.0 + 0.25 * psi.squaredNorm()),
                  &T);
    }
    return T;
  }
  const Eigen::Matrix3d turn = axes * Exp(psi).toRotationMatrix();
  for (const Block& block : layout.blocks()) {
    if (IsVelocityOrPosition(block) || block.key.kind == BlockKind::kAttitude) {
      AssignBlock(block, turn, &T);
    }
  }
  return T;
}

}  // namespace hindsight
