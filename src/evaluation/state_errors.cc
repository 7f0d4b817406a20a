#include "evaluation/state_errors.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "evaluation/statistics.h"
#include "evaluation/true_states.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

/// The first `kDim` components of a block.
template <int kDim>
void Append(const ErrorLayout& layout, BlockKind kind, const ErrorVector& e,
            const ErrorMatrix& P, PartErrors* part) {
  const Block* block = layout.Find(kind);
  if (block == nullptr ||
      !std::all_of(block->active.begin(), block->active.begin() + kDim,
                   [](bool active) { return active; })) {
    return;
  }
  const int at = block->offset;
  const Eigen::Vector<double, kDim> own = e.segment<kDim>(at);
  const Eigen::Matrix<double, kDim, kDim> P_own = P.block<kDim, kDim>(at, at);
  part->e.emplace_back(Eigen::Vector3d::Zero());
  part->e.back().head<kDim>() = own;
  part->sigma.emplace_back(Eigen::Vector3d::Zero());
  part->sigma.back().head<kDim>() = P_own.diagonal().cwiseSqrt();
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

std::vector<double> PartErrors::Level() const {
  std::vector<double> norms;
  for (const Eigen::Vector3d& one : e) norms.push_back(one.head<2>().norm());
  return norms;
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

double TotalRms(const PartErrors& part) { return Rms(part.Norms()); }
double LevelRms(const PartErrors& part) { return Rms(part.Level()); }
double DownRms(const PartErrors& part) { return Rms(part.Down()); }
double MeanNees(const PartErrors& part) { return Mean(part.nees); }

PartErrors StateErrors::Within(PartErrors StateErrors::*part,
                               const TimeRange& range) const {
  const PartErrors& all = this->*part;
  PartErrors within;
  for (std::size_t k = 0; k < all.e.size(); ++k) {
    if (!range.Contains(t[k])) continue;
    within.e.push_back(all.e[k]);
    within.sigma.push_back(all.sigma[k]);
    within.nees.push_back(all.nees[k]);
  }
  return within;
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

StateErrors ErrorsOf(const Dataset& dataset, const Solution& solution,
                     const std::vector<std::size_t>& numbers) {
  const ErrorLayout& layout = solution.layout;
  std::vector<State> asked;
  asked.reserve(numbers.size());
  for (const std::size_t k : numbers) asked.push_back(solution.states[k]);
  const std::vector<State> truth = TrueStates(dataset, layout, asked);
  const std::vector<int> known = ComponentsWithTruth(dataset, layout);
  StateErrors errors;
  errors.states = static_cast<int>(known.size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const ErrorVector e = Local(layout, asked[i], truth[i]);
    const ErrorMatrix P = solution.covariances.Get(numbers[i]);
    errors.t.push_back(truth[i].t);
    Append<3>(layout, BlockKind::kPosition, e, P, &errors.position);
    Append<3>(layout, BlockKind::kAttitude, e, P, &errors.attitude);
    Append<3>(layout, BlockKind::kGyroBias, e, P, &errors.gyro_bias);
    Append<2>(layout, BlockKind::kPosition, e, P, &errors.horizontal);
    Append<2>(layout, BlockKind::kVelocity, e, P, &errors.horizontal_velocity);
    errors.yaw.push_back(
        WrapAngle(truth[i].euler().z() - asked[i].euler().z()));
    const Eigen::VectorXd e_known = e(known);
    const Eigen::MatrixXd P_known = P(known, known);
    errors.nees.push_back(e_known.dot(P_known.llt().solve(e_known)));
  }
  return errors;
}

StateErrors ErrorsOf(const Dataset& dataset, const Solution& solution,
                     std::size_t every) {
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < solution.states.size(); k += every) {
    numbers.push_back(k);
  }
  return ErrorsOf(dataset, solution, numbers);
}

}  // namespace hindsight
