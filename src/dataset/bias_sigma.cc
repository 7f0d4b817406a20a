#include "dataset/bias_sigma.h"

#include "base/units.h"

namespace hindsight {
namespace {

constexpr double kDefaultGyroBiasSigma = 0.2 * kDegree;
constexpr double kDefaultAccelBiasSigma = 0.2;

}  // namespace

Eigen::Vector3d GyroBiasSigma(const InitialState& given) {
  return given.gyro_bias_sigma.value_or(
      Eigen::Vector3d::Constant(kDefaultGyroBiasSigma));
}

Eigen::Vector3d AccelBiasSigma(const InitialState& given) {
  return given.accel_bias_sigma.value_or(
      Eigen::Vector3d::Constant(kDefaultAccelBiasSigma));
}

}  // namespace hindsight
