#include "simulation/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr std::size_t kCheckpointEvery = 64;

/// Gauss-Legendre nodes and weights of three points on [0, 1].
constexpr std::array<double, 3> kNodes = {0.11270166537925831, 0.5,
                                          0.88729833462074169};
constexpr std::array<double, 3> kWeights = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

}  // namespace

Kinematics TrueKinematics(const Motion& m) {
  const Eigen::Quaterniond q_be = m.q_eb.conjugate();
  const Eigen::Vector3d w_ie = EarthRate_e();
  return {m.w_eb_b + q_be * w_ie,
          q_be * (m.a_e + 2.0 * w_ie.cross(m.v_e) - Gravity(m.p_e))};
}

SegmentTrajectory::SegmentTrajectory(const Geodetic& start,
                                     MotionProfile profile, double grid_hz)
    : profile_(std::move(profile)), grid_hz_(grid_hz) {
  place_.p_e = EcefFromGeodetic(start);
  // At a pole the longitude given decides where north is.
  place_.q_ew = Eigen::Quaterniond(NedAxes(start.latitude, start.longitude));
  Locate(&place_);
  checkpoints_.push_back(place_);
}

void SegmentTrajectory::Locate(Place* place) {
  const Geodetic g = GeodeticFromEcef(place->p_e);
  place->C_en = NedAxes(g.latitude, g.longitude);
  place->meridian_radius = MeridianRadius(g.latitude) + g.height;
  place->transverse_radius = TransverseRadius(g.latitude) + g.height;
}

Eigen::Vector3d SegmentTrajectory::LevelRotation(const Place& place,
                                                 const Eigen::Vector3d& d_e) {
  const double north = place.C_en.col(0).dot(d_e);
  const double east = place.C_en.col(1).dot(d_e);
  return (east / place.transverse_radius) * place.C_en.col(0) -
         (north / place.meridian_radius) * place.C_en.col(1);
}

void SegmentTrajectory::Step(double from, double to, Place* place) const {
  const double dt = to - from;
  Eigen::Vector3d d_w = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < kNodes.size(); ++k) {
    d_w += (dt * kWeights[k]) * profile_.At(from + kNodes[k] * dt).Velocity();
  }
  if (d_w.isZero(0.0)) return;
  const Eigen::Vector3d d_e = place->q_ew * d_w;
  // Mean of the level axes' turn over a step along the same direction.
  const Eigen::Vector3d turn_e = LevelRotation(*place, d_e);
  const Eigen::Vector3d sideways = turn_e.cross(d_e);
  const Eigen::Vector3d step =
      d_e + 0.5 * sideways + turn_e.cross(sideways) / 6.0 + place->p_e_rest;
  const Eigen::Vector3d p_e = place->p_e + step;
  place->p_e_rest = step - (p_e - place->p_e);
  place->p_e = p_e;
  const Eigen::Vector3d down_before = place->q_ew * Eigen::Vector3d::UnitZ();
  Locate(place);
  const Eigen::Vector3d tilt = down_before.cross(place->C_en.col(2));
  place->q_ew = (Exp(tilt) * place->q_ew).normalized();
}

void SegmentTrajectory::Advance(double from, double to, Place* place) const {
  const auto& knots = profile_.knots();
  auto knot = std::upper_bound(knots.begin(), knots.end(), from);
  for (; knot != knots.end() && *knot < to; ++knot) {
    Step(from, *knot, place);
    from = *knot;
  }
  Step(from, to, place);
}

void SegmentTrajectory::MoveTo(std::size_t grid_index) {
  const std::size_t nearest =
      std::min(grid_index / kCheckpointEvery, checkpoints_.size() - 1);
  const std::size_t checkpoint = nearest * kCheckpointEvery;
  if (grid_index < index_ || checkpoint > index_) {
    index_ = checkpoint;
    place_ = checkpoints_[nearest];
  }
  while (index_ < grid_index) {
    Advance(GridTime(index_), GridTime(index_ + 1), &place_);
    ++index_;
    if (index_ == checkpoints_.size() * kCheckpointEvery) {
      checkpoints_.push_back(place_);
    }
  }
}

Motion SegmentTrajectory::At(double t) {
  auto index = static_cast<std::size_t>(std::llround(t * grid_hz_));
  if (GridTime(index) > t) --index;
  MoveTo(index);
  Place place = place_;
  if (GridTime(index) < t) Advance(GridTime(index), t, &place);

  const BodyMotion body = profile_.At(t);
  const Eigen::Quaterniond q_wb = body.Attitude();
  Motion m;
  m.t = t;
  m.p_e = place.p_e;
  m.v_e = place.q_ew * body.Velocity();
  m.q_eb = (place.q_ew * q_wb).normalized();
  const Eigen::Vector3d w_ew_e = LevelRotation(place, m.v_e);
  m.a_e = place.q_ew * body.Acceleration() + w_ew_e.cross(m.v_e);
  m.w_eb_b = body.BodyRate() + m.q_eb.conjugate() * w_ew_e;
  return m;
}

}  // namespace hindsight
