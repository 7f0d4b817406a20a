#ifndef HINDSIGHT_BASE_RANDOM_H_
#define HINDSIGHT_BASE_RANDOM_H_

#include <Eigen/Core>
#include <cstdint>

namespace hindsight {

/// Normal deviates that are the same bits on every platform and standard
/// library (std::normal_distribution is not). Generator: xoshiro256++
/// (Blackman and Vigna 2021) seeded by splitmix64; deviates by the polar
/// method.
class Random {
 public:
  /// Streams of different `stream` numbers under one seed are independent.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

  std::uint64_t NextBits();
  /// Uniform in [0, 1).
  double Uniform();
  /// Standard normal.
  double Normal();
  Eigen::Vector3d NormalVector3();

 private:
  std::uint64_t state_[4];
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_RANDOM_H_
