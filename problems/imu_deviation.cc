#include <algorithm>
#include <cmath>
#include <utility>

#include "earth/wgs84.h"
#include "problems/deviation_columns.h"

namespace hindsight {
namespace {

/// Of an interval between nodes, for the course of its rate of turn.
constexpr int kPieces = 4;

}  // namespace

Eigen::Vector3d ImuDeviation::Of(const Eigen::Vector3d& reading,
                                 const Eigen::Vector3d& rate) const {
  Eigen::Vector3d more = Eigen::Vector3d::Zero();
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  switch (kind) {
    case Kind::kScale:
      more(axis) = reading(axis);
      break;
    case Kind::kExchanged:
      more(next) = reading(next) - reading(last);
      more(last) = -more(next);
      break;
    case Kind::kTurned:
      more = Eigen::Vector3d::Unit(axis).cross(reading);
      break;
    case Kind::kLate:
      more = -rate;
      break;
  }
  return more;
}

std::span<const ImuDeviation> ImuDeviations() {
  using enum ImuDeviation::Kind;
  static constexpr ImuDeviation kAll[] = {
      {kScale, true, 0},      {kScale, true, 1},      {kScale, true, 2},
      {kScale, false, 0},     {kScale, false, 1},     {kScale, false, 2},
      {kExchanged, true, 0},  {kExchanged, true, 1},  {kExchanged, true, 2},
      {kExchanged, false, 0}, {kExchanged, false, 1}, {kExchanged, false, 2},
      {kTurned, false, 0},    {kTurned, false, 1},    {kTurned, false, 2},
      {kLate, true, 0},
  };
  return kAll;
}

void DeviationColumns::FollowTurns() {
  const Timeline& timeline = problem_.timeline;
  ImuIntegrator readings = timeline.Readings();
  bends_.resize(timeline.size());
  double near = 0.0, far = 0.0;
  for (std::size_t k = 1; k < timeline.size(); ++k) {
    const Node& from = timeline.node(k - 1);
    const Node& to = timeline.node(k);
    const double piece = (to.t - from.t) / kPieces;
    Eigen::Vector3d before = from.kinematics.w_ib_b;
    for (int i = 1; i < kPieces; ++i) {
      const Kinematics at = readings.ReadingAt(from.t + i * piece);
      const double part = static_cast<double>(i) / kPieces;
      const Eigen::Vector3d line =
          (1.0 - part) * from.kinematics.w_ib_b + part * to.kinematics.w_ib_b;
      const Eigen::Vector3d dv = piece * (at.w_ib_b - line).cross(at.f_b);
      bends_[k].v += dv;
      bends_[k].p += (to.t - from.t - i * piece) * dv;
      const double next = from.t + i * piece + timeline.sample_interval();
      near += (readings.ReadingAt(next).w_ib_b - at.w_ib_b).squaredNorm();
      far += (at.w_ib_b - before).squaredNorm();
      before = at.w_ib_b;
    }
  }
  if (far > near) noise_share_ = near / far;
}

void DeviationColumns::FollowNoise() {
  using Kind = ImuDeviation::Kind;
  const auto deviations = ImuDeviations();
  const Eigen::Index attitude =
      problem_.layout.Find(BlockKind::kAttitude)->offset;
  const Eigen::Index velocity =
      problem_.layout.Find(BlockKind::kVelocity)->offset;
  double of_gyros = 0.0, of_accels = 0.0;  // variances, summed
  std::vector<double> squares(deviations.size(), 0.0);
  for (std::size_t k = 1; k < tape_.size(); ++k) {
    const ErrorMatrix Q = tape_.Q(k);
    of_gyros += Q.diagonal().segment<3>(attitude).mean();
    of_accels += Q.diagonal().segment<3>(velocity).mean();
    const Readings readings = ReadingsOver(k);
    for (std::size_t i = 0; i < deviations.size(); ++i) {
      squares[i] +=
          (readings.duration * readings.MoreBy(deviations[i])).squaredNorm();
    }
  }
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    const ImuDeviation& one = deviations[i];
    if (one.kind == Kind::kLate) {
      untold_[i] = 0.5 * (1.0 + kPieces * noise_share_) *
                   problem_.timeline.sample_interval();
    } else if (one.kind != Kind::kTurned && squares[i] > 0.0) {
      const double axes = one.kind == Kind::kExchanged ? 2.0 : 1.0;
      untold_[i] = axes * (one.of_gyros ? of_gyros : of_accels) / squares[i];
    }
  }
}

double DeviationColumns::ZOf(const MeanShift& shift) const {
  if (shift.of_state || shift.group != kImu) return shift.z();
  const double untold = untold_[static_cast<std::size_t>(shift.column)];
  return std::copysign(std::max(0.0, std::abs(shift.size()) - untold),
                       shift.size()) /
         shift.sigma();
}

DeviationColumns::Readings DeviationColumns::ReadingsOver(std::size_t k) const {
  // Not their mean over the interval: what the noise of the mean does is in the
  // innovations too, and would look like a scale.
  const Node& from = problem_.timeline.node(k - 1);
  const Node& to = problem_.timeline.node(k);
  const auto mean_and_rate = [&](const Eigen::Vector3d& begin,
                                 const Eigen::Vector3d& end) {
    return std::pair<Eigen::Vector3d, Eigen::Vector3d>(
        0.5 * (begin + end), (end - begin) / (to.t - from.t));
  };
  return {mean_and_rate(from.kinematics.w_ib_b, to.kinematics.w_ib_b),
          mean_and_rate(from.kinematics.f_b, to.kinematics.f_b), to.t - from.t};
}

Eigen::Vector3d DeviationColumns::Readings::MoreBy(
    const ImuDeviation& one) const {
  const auto& [reading, rate] = one.of_gyros ? w : f;
  return one.Of(reading, rate);
}

ShiftColumns::Columns DeviationColumns::Driven(std::size_t k) const {
  const ErrorLayout& layout = problem_.layout;
  const auto deviations = ImuDeviations();
  Eigen::MatrixXd B =
      Eigen::MatrixXd::Zero(layout.dim(), std::ssize(deviations));
  const Readings readings = ReadingsOver(k);
  const auto Phi = tape_.Phi(k);
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    const ImuDeviation& one = deviations[i];
    const Block* bias = layout.Find(one.of_gyros ? BlockKind::kGyroBias
                                                 : BlockKind::kAccelBias);
    if (bias->dim != 3) continue;
    auto column = B.col(static_cast<Eigen::Index>(i));
    column = Phi.middleCols(bias->offset, 3) * readings.MoreBy(one);
    column.segment<3>(bias->offset).setZero();
    if (one.kind == ImuDeviation::Kind::kLate && !bends_.empty()) {
      const State& x = states_[k - 1];
      const Eigen::Matrix3d C_nb =
          NedAxes(x.p_e).transpose() * x.q_eb.toRotationMatrix();
      column.segment<3>(layout.Find(BlockKind::kVelocity)->offset) +=
          C_nb * bends_[k].v;
      column.segment<3>(layout.Find(BlockKind::kPosition)->offset) +=
          C_nb * bends_[k].p;
    }
  }
  return {.group = kImu, .B = std::move(B), .may_grow = false};
}

}  // namespace hindsight
