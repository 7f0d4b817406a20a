#include "filters/mixing.h"

#include <Eigen/Cholesky>

#include "base/error.h"
#include "filters/kalman.h"

namespace hindsight {
namespace {

using Indices = Eigen::Array<int, Eigen::Dynamic, 1, 0, kMaxErrorDim, 1>;

/// Axis of a block's i-th active component.
int AxisOf(const Block& block, int i) {
  for (int axis = 0;; ++axis) {
    if (block.active[static_cast<std::size_t>(axis)] && i-- == 0) return axis;
  }
}

int ComponentOf(const Block& block, int axis) {
  if (!block.active[static_cast<std::size_t>(axis)]) return -1;
  int component = block.offset;
  for (int a = 0; a < axis; ++a) {
    if (block.active[static_cast<std::size_t>(a)]) ++component;
  }
  return component;
}

}  // namespace

ComponentMap SharedComponents(const ErrorLayout& target,
                              const ErrorLayout& source) {
  ComponentMap shared(static_cast<std::size_t>(target.dim()), -1);
  for (const Block& block : target.blocks()) {
    const Block* other = source.Find(block.key.kind, block.key.sensor);
    if (other == nullptr) continue;
    for (int i = 0; i < block.dim; ++i) {
      shared[static_cast<std::size_t>(block.offset + i)] =
          ComponentOf(*other, AxisOf(block, i));
    }
  }
  return shared;
}

Gaussian Transfer(const Gaussian& from, const Gaussian& own,
                  const ComponentMap& shared) {
  const auto n = static_cast<Eigen::Index>(shared.size());
  Indices s(n);       // components of own that are shared
  Indices e(n);       // the others
  Indices s_from(n);  // the shared ones in from
  Eigen::Index shared_count = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const int component = shared[static_cast<std::size_t>(i)];
    if (component < 0) {
      e(i - shared_count) = static_cast<int>(i);
    } else {
      s(shared_count) = static_cast<int>(i);
      s_from(shared_count++) = component;
    }
  }
  s.conservativeResize(shared_count);
  s_from.conservativeResize(shared_count);
  e.conservativeResize(n - shared_count);
  Gaussian out = own;
  const ErrorMatrix P_ss = from.P(s_from, s_from);
  out.mean(s) = from.mean(s_from);
  out.P(s, s) = P_ss;
  if (e.size() == 0 || s.size() == 0) return out;

  const ErrorMatrix own_ss = own.P(s, s);
  const ErrorMatrix own_se = own.P(s, e);
  const Eigen::LLT<ErrorMatrix> llt(own_ss);
  if (llt.info() != Eigen::Success) {
    throw EstimationError(
        "covariance of a model is not positive definite over the states it "
        "shares");
  }
  const ErrorMatrix Gt = llt.solve(own_se);
  const ErrorMatrix P_se = P_ss * Gt;
  out.mean(e) =
      own.mean(e) + Gt.transpose() * (from.mean(s_from) - own.mean(s));
  out.P(s, e) = P_se;
  out.P(e, s) = P_se.transpose();
  out.P(e, e) = own.P(e, e) - Gt.transpose() * own_se + Gt.transpose() * P_se;
  Symmetrize(&out.P);
  return out;
}

Gaussian Merge(const std::vector<Gaussian>& parts,
               const Eigen::Ref<const Eigen::VectorXd>& weights) {
  Gaussian out;
  const Eigen::Index n = parts.front().mean.size();
  out.mean = ErrorVector::Zero(n);
  out.P = ErrorMatrix::Zero(n, n);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    out.mean += weights(static_cast<Eigen::Index>(i)) * parts[i].mean;
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double w = weights(static_cast<Eigen::Index>(i));
    if (w == 0.0) continue;
    const ErrorVector e = parts[i].mean - out.mean;
    out.P.noalias() += w * parts[i].P;
    out.P.noalias() += (w * e) * e.transpose();
  }
  return out;
}

}  // namespace hindsight
