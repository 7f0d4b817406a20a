#ifndef HINDSIGHT_IMU_PAIR_H_
#define HINDSIGHT_IMU_PAIR_H_

#include <Eigen/Core>
#include <cmath>

namespace hindsight {

/// Two numbers with which a processor computes at once: a scalar for Eigen, so that
/// formulas written for one number do for two.
class Pair {
 public:
  Pair() = default;
  /// The same number twice. As any scalar's. NOLINTNEXTLINE(google-explicit-constructor)
  Pair(double both) : v_{both, both} {}
  Pair(double first, double second) : v_{first, second} {}

  double operator[](int i) const { return v_[i]; }

  Pair operator-() const { return Pair(-v_); }
  Pair& operator+=(const Pair& other) { return *this = Pair(v_ + other.v_); }
  Pair& operator-=(const Pair& other) { return *this = Pair(v_ - other.v_); }
  Pair& operator*=(const Pair& other) { return *this = Pair(v_ * other.v_); }
  Pair& operator/=(const Pair& other) { return *this = Pair(v_ / other.v_); }
  friend Pair operator+(Pair a, const Pair& b) { return a += b; }
  friend Pair operator-(Pair a, const Pair& b) { return a -= b; }
  friend Pair operator*(Pair a, const Pair& b) { return a *= b; }
  friend Pair operator/(Pair a, const Pair& b) { return a /= b; }
  friend Pair exp(const Pair& a) { return {std::exp(a[0]), std::exp(a[1])}; }

 private:
  // Of 16 bytes, as registers of all processors are.
  using Two = double __attribute__((vector_size(16)));
  explicit Pair(Two v) : v_(v) {}

  Two v_;
};

}  // namespace hindsight

template <>
struct Eigen::NumTraits<hindsight::Pair> : Eigen::NumTraits<double> {
  using Real = hindsight::Pair;
  using NonInteger = hindsight::Pair;
  using Nested = hindsight::Pair;
  using Literal = hindsight::Pair;
};

#endif  // HINDSIGHT_IMU_PAIR_H_
