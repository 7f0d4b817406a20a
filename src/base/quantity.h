#ifndef HINDSIGHT_BASE_QUANTITY_H_
#define HINDSIGHT_BASE_QUANTITY_H_

namespace hindsight {

/// Kinds of physical value that files and configurations hold, with the SI unit
/// that the program uses inside.
enum class Quantity {
  kRatio,              ///< [1]
  kTime,               ///< [s]
  kFrequency,          ///< [Hz]
  kLength,             ///< [m]
  kSpeed,              ///< [m/s]
  kAcceleration,       ///< [m/s^2]
  kAngle,              ///< [rad]
  kAngularRate,        ///< [rad/s]
  kGyroNoiseDensity,   ///< [rad/sqrt(s)]
  kAccelNoiseDensity,  ///< [m/s/sqrt(s)]
  kGyroBiasWalk,       ///< [rad/s/sqrt(s)]
  kAccelBiasWalk,      ///< [m/s^2/sqrt(s)]
  kNoisePerRate,       ///< [sqrt(s)], gyro noise density per rad/s
  kMagneticField,      ///< [uT]
};

/// A quantity that a stream may hold, by its name in files and configurations.
struct FieldName {
  const char* name;
  Quantity quantity;
};

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_QUANTITY_H_
