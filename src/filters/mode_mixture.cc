#include "filters/mode_mixture.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "base/error.h"

namespace hindsight {
namespace {

void CheckNavigation(const ErrorLayout& layout, const ComponentMap& in_first) {
  for (const Block& block : layout.blocks()) {
    if (block.parameter_offset >= 0) continue;
    for (int i = block.offset; i < block.offset + block.dim; ++i) {
      if (in_first[static_cast<std::size_t>(i)] < 0) {
        throw std::logic_error("the first model of an IMM lacks " +
                               layout.ComponentName(i));
      }
    }
  }
}

}  // namespace

ModeMixture::ModeMixture(const ImmOptions& options,
                         const std::vector<const ErrorLayout*>& layouts)
    : options_(options), mu_(options.start) {
  for (const ErrorLayout* layout : layouts) {
    std::vector<ComponentMap>& shared = shared_.emplace_back();
    for (const ErrorLayout* other : layouts) {
      shared.push_back(SharedComponents(*layout, *other));
    }
    CheckNavigation(*layout, shared.front());
  }
}

std::vector<Gaussian> ModeMixture::SeenBy(
    std::size_t j, const std::vector<Gaussian>& errors) const {
  std::vector<Gaussian> parts;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    parts.push_back(i == j ? errors[j]
                           : Transfer(errors[i], errors[j], shared_[j][i]));
  }
  return parts;
}

void ModeMixture::Switch(std::vector<Gaussian>* errors) {
  if (size() == 1) return;
  const Eigen::MatrixXd joint =
      mu_.asDiagonal() * options_.transition;  // of modes i, then j
  std::vector<Gaussian> mixed;
  for (std::size_t j = 0; j < size(); ++j) {
    const Eigen::VectorXd column = joint.col(static_cast<Eigen::Index>(j));
    mixed.push_back(Merge(SeenBy(j, *errors), column / column.sum()));
  }
  *errors = std::move(mixed);
  mu_ = joint.colwise().sum().transpose();
}

double ModeMixture::Normalize(double t) {
  const double largest = log_mu_.maxCoeff();
  if (!std::isfinite(largest)) {
    throw EstimationError(
        "no model of the IMM explains the measurements at t = " +
        std::to_string(t) + " s");
  }
  mu_ = (log_mu_.array() - largest).exp();
  const double sum = mu_.sum();
  mu_ /= sum;
  return largest + std::log(sum);
}

Gaussian ModeMixture::Combined(const std::vector<Gaussian>& errors,
                               std::size_t over) const {
  return size() == 1 ? errors.front() : Merge(SeenBy(over, errors), mu_);
}

std::vector<ErrorVector> ModeMixture::Steps(const std::vector<Gaussian>& errors,
                                            const Gaussian& combined) const {
  std::vector<ErrorVector> steps = {combined.mean};
  for (std::size_t j = 1; j < size(); ++j) {
    ErrorVector& step = steps.emplace_back(Combined(errors, j).mean);
    const ComponentMap& in_first = shared_[j][0];
    for (std::size_t i = 0; i < in_first.size(); ++i) {
      if (in_first[i] < 0) continue;
      step(static_cast<Eigen::Index>(i)) = combined.mean(in_first[i]);
    }
  }
  return steps;
}

}  // namespace hindsight
