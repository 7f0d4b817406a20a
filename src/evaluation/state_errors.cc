#include "evaluation/state_errors.h"

#include <Eigen/Cholesky>

#include "evaluation/statistics.h"
#include "evaluation/true_states.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

void Append(const ErrorLayout& layout, BlockKind kind, const ErrorVector& e,
            const ErrorMatrix& P, PartErrors* part) {
  const Block* block = layout.Find(kind);
  if (block == nullptr || block->dim != 3) return;
  const Eigen::Vector3d own = e.segment<3>(block->offset);
  const Eigen::Matrix3d P_own = P.block<3, 3>(block->offset, block->offset);
  part->e.push_back(own);
  part->sigma.emplace_back(P_own.diagonal().cwiseSqrt());
  part->nees.push_back(own.dot(P_own.llt().solve(own)));
}

bool IsBeyond(const PartErrors& part, std::size_t k, double sigmas) {
  return k < part.e.size() &&
         (part.e[k].cwiseAbs() - sigmas * part.sigma[k]).maxCoeff() > 0.0;
}

}  // namespace

std::vector<double> PartErrors::Norms() const {
  std::vector<double> norms;
  for (const Eigen::Vector3d& one : e) norms.push_back(one.norm());
  return norms;
}

std::vector<double> PartErrors::Component(int axis) const {
  std::vector<double> values;
  for (const Eigen::Vector3d& one : e) values.push_back(one(axis));
  return values;
}

double PartErrors::ShareInside(double sigmas) const {
  std::vector<double> inside;
  for (std::size_t k = 0; k < e.size(); ++k) {
    const auto count =
        (e[k].cwiseAbs().array() <= sigmas * sigma[k].array()).count();
    inside.push_back(static_cast<double>(count) / 3.0);
  }
  return Mean(inside);
}

double StateErrors::ShareBeyond(double sigmas) const {
  std::vector<double> beyond;
  for (std::size_t k = 0; k < t.size(); ++k) {
    beyond.push_back(
        IsBeyond(position, k, sigmas) || IsBeyond(attitude, k, sigmas) ? 1.0
                                                                       : 0.0);
  }
  return Mean(beyond);
}

StateErrors ErrorsOf(const Dataset& dataset, const ErrorLayout& layout,
                     const std::vector<State>& states,
                     const CovarianceSeries& P,
                     const std::vector<std::size_t>& numbers) {
  std::vector<State> asked;
  asked.reserve(numbers.size());
  for (const std::size_t k : numbers) asked.push_back(states[k]);
  const std::vector<State> truth = TrueStates(dataset, layout, asked);
  const std::vector<int> known = ComponentsWithTruth(dataset, layout);
  StateErrors errors;
  errors.states = static_cast<int>(known.size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const ErrorVector e = Local(layout, asked[i], truth[i]);
    const ErrorMatrix P_i = P.Get(numbers[i]);
    errors.t.push_back(truth[i].t);
    Append(layout, BlockKind::kPosition, e, P_i, &errors.position);
    Append(layout, BlockKind::kVelocity, e, P_i, &errors.velocity);
    Append(layout, BlockKind::kAttitude, e, P_i, &errors.attitude);
    Append(layout, BlockKind::kGyroBias, e, P_i, &errors.gyro_bias);
    errors.yaw.push_back(
        WrapAngle(truth[i].euler().z() - asked[i].euler().z()));
    const Eigen::VectorXd e_known = e(known);
    const Eigen::MatrixXd P_known = P_i(known, known);
    errors.nees.push_back(e_known.dot(P_known.llt().solve(e_known)));
  }
  return errors;
}

StateErrors ErrorsOf(const Dataset& dataset, const ErrorLayout& layout,
                     const std::vector<State>& states,
                     const CovarianceSeries& P, std::size_t every) {
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < states.size(); k += every) numbers.push_back(k);
  return ErrorsOf(dataset, layout, states, P, numbers);
}

}  // namespace hindsight
