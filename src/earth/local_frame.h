#ifndef HINDSIGHT_EARTH_LOCAL_FRAME_H_
#define HINDSIGHT_EARTH_LOCAL_FRAME_H_

#include <Eigen/Core>
#include <array>
#include <string_view>

namespace hindsight {

/// Cartesian axes in which a file states positions.
enum class FrameAxes { kEcef, kNed, kEnu, kNwu };

/// Their names in configurations, in the order of FrameAxes.
inline constexpr std::array<std::string_view, 4> kFrameNames = {"ecef", "ned",
                                                                "enu", "nwu"};

/// C_nl: NED axes from those of a frame that stands level; the identity of
/// kEcef, which does not.
Eigen::Matrix3d NedFromLevel(FrameAxes axes);

/// Axes l and where their zero is: p_e = origin_e + C_el p_l.
struct LocalFrame {
  Eigen::Vector3d origin_e = Eigen::Vector3d::Zero();  ///< ECEF [m]
  Eigen::Matrix3d C_el = Eigen::Matrix3d::Identity();
};

/// The frame whose axes stand level at `origin_e`; of kEcef that of the Earth,
/// whatever the origin.
LocalFrame FrameAt(FrameAxes axes, const Eigen::Vector3d& origin_e);

}  // namespace hindsight

#endif  // HINDSIGHT_EARTH_LOCAL_FRAME_H_
