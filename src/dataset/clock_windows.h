#ifndef HINDSIGHT_DATASET_CLOCK_WINDOWS_H_
#define HINDSIGHT_DATASET_CLOCK_WINDOWS_H_

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace hindsight {

/// Windows of a record: pairs of rows, at the begin and at the end, or triples
/// with a row in the middle as well.
struct ClockWindows {
  struct Window {
    std::size_t begin = 0;
    std::size_t middle = 0;  ///< equal to `end` of a pair
    std::size_t end = 0;
    int piece = 0;  ///< windows of one piece share their free constants
  };
  double length = 0.0;  ///< [s]
  std::vector<Window> windows;

  /// The number of windows that do not overlap.
  double IndependentWindows(const std::vector<double>& t) const;
};

/// Windows of at least `length`, of rows at the times t: pairs, or triples with
/// a row in the middle, spread evenly if there are more than 2000.
ClockWindows MakeWindows(const std::vector<double>& t, double length,
                         bool triples, double piece);

/// Median interval of increasing times [s].
double MedianStep(const std::vector<double>& t);

/// What two series of vectors have in common, accumulated over a piece in which
/// their axes, or a constant between them, are free.
class CommonMotion {
 public:
  void Add(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    ++count_;
    sum_a_ += a;
    sum_b_ += b;
    square_a_ += a.squaredNorm();
    square_b_ += b.squaredNorm();
    cross_ += a * b.transpose();
  }
  int count() const { return count_; }

  /// How much there is to compare: sum |a - mean(a)|^2 and sum |b - mean(b)|^2,
  /// the mean of the two sums.
  double Motion() const;
  /// What the best rotation C leaves: min over C of sum |a - C b|^2.
  double LeftByRotation() const;
  /// What the best constant c leaves: min over c of sum |a - b - c|^2.
  double LeftByConstant() const;

 private:
  int count_ = 0;
  Eigen::Vector3d sum_a_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_b_ = Eigen::Vector3d::Zero();
  double square_a_ = 0.0;
  double square_b_ = 0.0;
  Eigen::Matrix3d cross_ = Eigen::Matrix3d::Zero();
};

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_CLOCK_WINDOWS_H_
