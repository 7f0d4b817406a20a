#ifndef HINDSIGHT_STATE_COVARIANCE_SERIES_H_
#define HINDSIGHT_STATE_COVARIANCE_SERIES_H_

#include <algorithm>
#include <cstddef>

#include "base/paged_rows.h"
#include "state/error_layout.h"

namespace hindsight {

/// Covariances of many epochs, lower triangles in PagedRows: half the memory of
/// full matrices, little of which a long recording holds.
class CovarianceSeries {
 public:
  CovarianceSeries() = default;
  CovarianceSeries(int dim, std::size_t count)
      : dim_(dim), packed_(count, Stride(dim)) {}

  int dim() const { return dim_; }
  std::size_t size() const { return packed_.size(); }
  bool empty() const { return size() == 0; }

  template <typename Derived>
  void Set(std::size_t k, const Eigen::MatrixBase<Derived>& P) {
    double* out = packed_.Row(k);
    for (int j = 0; j < dim_; ++j) {
      for (int i = j; i < dim_; ++i) *out++ = P(i, j);
    }
  }

  ErrorMatrix Get(std::size_t k) const {
    const double* in = packed_.Row(k);
    ErrorMatrix P(dim_, dim_);
    for (int j = 0; j < dim_; ++j) {
      for (int i = j; i < dim_; ++i) P(i, j) = P(j, i) = *in++;
    }
    return P;
  }

  /// The diagonal of Get(k).
  ErrorVector Variances(std::size_t k) const {
    const double* in = packed_.Row(k);
    ErrorVector variances(dim_);
    for (int j = 0; j < dim_; ++j) {
      variances(j) = *in;
      in += dim_ - j;
    }
    return variances;
  }
  /// Element (i, j) of Get(k).
  double At(std::size_t k, int i, int j) const {
    const int row = std::max(i, j);
    const int column = std::min(i, j);
    return packed_.Row(
        k)[column * dim_ - column * (column - 1) / 2 + row - column];
  }
  /// Whether Get(k) is.
  bool IsFinite(std::size_t k) const {
    return Eigen::Map<const Eigen::VectorXd>(
               packed_.Row(k), static_cast<Eigen::Index>(Stride(dim_)))
        .allFinite();
  }

 private:
  static std::size_t Stride(int dim) {
    return static_cast<std::size_t>(dim) * static_cast<std::size_t>(dim + 1) /
           2;
  }
  int dim_ = 0;
  PagedRows packed_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_COVARIANCE_SERIES_H_
