#ifndef HINDSIGHT_BASE_UNITS_H_
#define HINDSIGHT_BASE_UNITS_H_

#include <numbers>

namespace hindsight {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180.0;              ///< [rad]
inline constexpr double kArcMinute = kDegree / 60.0;        ///< [rad]
inline constexpr double kHour = 3600.0;                     ///< [s]
inline constexpr double kStandardGravity = 9.80665;         ///< [m/s^2]
inline constexpr double kMilliG = 1e-3 * kStandardGravity;  ///< [m/s^2]
inline constexpr double kMicroG = 1e-6 * kStandardGravity;  ///< [m/s^2]
inline constexpr double kMilliGal = 1e-5;                   ///< [m/s^2]
inline constexpr double kKnot = 1852.0 / 3600.0;            ///< [m/s]
/// 1 deg/sqrt(h) in rad/sqrt(s).
inline constexpr double kDegreePerSqrtHour = kDegree / 60.0;

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_UNITS_H_
