#ifndef HINDSIGHT_STATE_COVARIANCE_SERIES_H_
#define HINDSIGHT_STATE_COVARIANCE_SERIES_H_

#include <cstddef>
#include <vector>

#include "state/error_layout.h"

namespace hindsight {

/// Covariances of many epochs, lower triangles packed in one array: half the
/// memory of full matrices and one allocation for a whole recording.
class CovarianceSeries {
 public:
  CovarianceSeries() = default;
  CovarianceSeries(int dim, std::size_t count)
      : dim_(dim), count_(count), packed_(count * Stride()) {}

  int dim() const { return dim_; }
  std::size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }

  template <typename Derived>
  void Set(std::size_t k, const Eigen::MatrixBase<Derived>& P) {
    double* out = packed_.data() + k * Stride();
    for (int j = 0; j < dim_; ++j) {
      for (int i = j; i < dim_; ++i) *out++ = P(i, j);
    }
  }

  ErrorMatrix Get(std::size_t k) const {
    const double* in = packed_.data() + k * Stride();
    ErrorMatrix P(dim_, dim_);
    for (int j = 0; j < dim_; ++j) {
      for (int i = j; i < dim_; ++i) P(i, j) = P(j, i) = *in++;
    }
    return P;
  }

 private:
  std::size_t Stride() const {
    return static_cast<std::size_t>(dim_) * static_cast<std::size_t>(dim_ + 1) /
           2;
  }
  int dim_ = 0;
  std::size_t count_ = 0;
  std::vector<double> packed_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_COVARIANCE_SERIES_H_
